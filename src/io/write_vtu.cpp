#include "bough/io/write_vtu.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "bough/io/number_text.hpp"

namespace bough::io {
namespace {

static_assert(std::endian::native == std::endian::little, "VTU data are written as they stand in memory");

constexpr std::uint8_t vtk_line = 3, vtk_polyline = 4, vtk_hexahedron = 12;
enum class Kind : std::int32_t { beam = 0, body = 1, link = 2 };

struct Grid {
  std::vector<double> points, force, moment, axis_1, axis_2, axis_3;  // 3 per point
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  std::vector<std::int32_t> kind, part;

  std::int64_t num_points() const { return static_cast<std::int64_t>(points.size() / 3); }

  /// Adds the point `origin + a axis_2 + b axis_3 + c axis_1`; `axes` row-major with the axes as columns, or null.
  void add_point(const double* origin, const double* axes, const std::array<double, 3>& along,
                 const double* resultants) {
    for (std::size_t row = 0; row < 3; ++row) {
      double value = origin[row];
      if (axes != nullptr)
        for (std::size_t column = 0; column < 3; ++column) value += axes[3 * row + column] * along[column];
      points.push_back(value);
      axis_1.push_back(axes != nullptr ? axes[3 * row] : 0.0);
      axis_2.push_back(axes != nullptr ? axes[3 * row + 1] : 0.0);
      axis_3.push_back(axes != nullptr ? axes[3 * row + 2] : 0.0);
      force.push_back(resultants != nullptr ? resultants[row] : 0.0);
      moment.push_back(resultants != nullptr ? resultants[3 + row] : 0.0);
    }
  }

  void add_cell(std::uint8_t type, std::span<const std::int64_t> corners, Kind of, std::size_t index) {
    connectivity.insert(connectivity.end(), corners.begin(), corners.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(type);
    kind.push_back(static_cast<std::int32_t>(of));
    part.push_back(static_cast<std::int32_t>(index));
  }
};

// corners of a square of unit width in the plane of axes 2 and 3
constexpr double corner_2[4] = {-0.5, 0.5, 0.5, -0.5}, corner_3[4] = {-0.5, -0.5, 0.5, 0.5};

void add_curve(Grid& grid, const results::Curve& curve, std::size_t index, double width) {
  if (curve.points.size() < 2) return;
  const std::int64_t first = grid.num_points();
  for (const results::CurvePoint& point : curve.points) {
    grid.add_point(point.position, point.axes, {0.0, 0.0, 0.0}, point.force);
    for (std::size_t c = 0; c < 4; ++c)
      grid.add_point(point.position, point.axes, {0.0, width * corner_2[c], width * corner_3[c]}, point.force);
  }
  constexpr std::int64_t per_section = 5;
  std::vector<std::int64_t> axis;
  for (std::size_t k = 0; k < curve.points.size(); ++k)
    axis.push_back(first + per_section * static_cast<std::int64_t>(k));
  grid.add_cell(vtk_polyline, axis, Kind::beam, index);
  for (std::size_t k = 0; k + 1 < axis.size(); ++k) {
    std::array<std::int64_t, 8> corners{};
    for (std::size_t c = 0; c < 4; ++c) {
      corners[c] = axis[k] + 1 + static_cast<std::int64_t>(c);
      corners[4 + c] = axis[k + 1] + 1 + static_cast<std::int64_t>(c);
    }
    grid.add_cell(vtk_hexahedron, corners, Kind::beam, index);
  }
}

void add_body(Grid& grid, const results::BodyPose& body, std::size_t index, double width) {
  std::array<std::int64_t, 8> corners{};
  for (std::size_t k = 0; k < 8; ++k) {
    corners[k] = grid.num_points();
    const std::array<double, 3> along{k < 4 ? -0.5 * width : 0.5 * width, width * corner_2[k % 4],
                                      width * corner_3[k % 4]};
    grid.add_point(body.center, body.axes, along, nullptr);
  }
  grid.add_cell(vtk_hexahedron, corners, Kind::body, index);
}

void add_link(Grid& grid, const results::Link& link, std::size_t index) {
  const std::array<std::int64_t, 2> ends{grid.num_points(), grid.num_points() + 1};
  grid.add_point(link.first, nullptr, {0.0, 0.0, 0.0}, nullptr);
  grid.add_point(link.second, nullptr, {0.0, 0.0, 0.0}, nullptr);
  grid.add_cell(vtk_line, ends, Kind::link, index);
}

/// Collects the raw blocks: each a byte count (UInt64) and the bytes.
struct Appended {
  std::string xml, data;

  template <class T>
  void array(const char* type, const char* name, int components, const std::vector<T>& values) {
    xml += std::string("        <DataArray type=\"") + type + "\" Name=\"" + name + "\"";
    if (components > 1) xml += " NumberOfComponents=\"" + std::to_string(components) + "\"";
    xml += " format=\"appended\" offset=\"" + std::to_string(data.size()) + "\"/>\n";
    const std::uint64_t size = values.size() * sizeof(T);
    const std::size_t start = data.size();
    data.resize(start + sizeof size + size);
    std::memcpy(data.data() + start, &size, sizeof size);
    if (size > 0) std::memcpy(data.data() + start + sizeof size, values.data(), size);
  }
  void line(const char* text) { (xml += text) += '\n'; }
};

std::string xml_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  }
  return escaped;
}

}  // namespace

VtuOptions vtu_options_for(const results::MotionFrame& frame) {
  double low[3], high[3];
  std::fill_n(low, 3, std::numeric_limits<double>::infinity());
  std::fill_n(high, 3, -std::numeric_limits<double>::infinity());
  const auto take = [&](const double* x) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], x[k]);
      high[k] = std::max(high[k], x[k]);
    }
  };
  for (const results::Curve& curve : frame.curves)
    for (const results::CurvePoint& point : curve.points) take(point.position);
  for (const results::BodyPose& body : frame.bodies) {
    take(body.position);
    take(body.center);
  }
  for (const results::Link& link : frame.links) {
    take(link.first);
    take(link.second);
  }
  double diagonal = low[0] <= high[0] ? std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) : 0.0;
  if (!(diagonal > 0.0)) diagonal = 1.0;
  return {0.01 * diagonal, 0.04 * diagonal};
}

std::string vtu_text(const results::MotionFrame& frame, const VtuOptions& options) {
  Grid grid;
  for (std::size_t k = 0; k < frame.curves.size(); ++k) add_curve(grid, frame.curves[k], k, options.section_width);
  for (std::size_t k = 0; k < frame.bodies.size(); ++k) add_body(grid, frame.bodies[k], k, options.body_width);
  for (std::size_t k = 0; k < frame.links.size(); ++k) add_link(grid, frame.links[k], k);

  Appended file;
  file.line("<?xml version=\"1.0\"?>");
  file.line("<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">");
  file.line("  <UnstructuredGrid>");
  file.line("    <FieldData>");
  file.xml += "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">";
  append_number(file.xml, frame.time);
  file.line("</DataArray>");
  file.line("    </FieldData>");
  file.xml += "    <Piece NumberOfPoints=\"" + std::to_string(grid.num_points()) + "\" NumberOfCells=\"" +
              std::to_string(grid.types.size()) + "\">\n";
  file.line("      <Points>");
  file.array("Float64", "Points", 3, grid.points);
  file.line("      </Points>");
  file.line("      <Cells>");
  file.array("Int64", "connectivity", 1, grid.connectivity);
  file.array("Int64", "offsets", 1, grid.offsets);
  file.array("UInt8", "types", 1, grid.types);
  file.line("      </Cells>");
  file.line("      <PointData>");
  file.array("Float64", "force", 3, grid.force);
  file.array("Float64", "moment", 3, grid.moment);
  file.array("Float64", "axis_1", 3, grid.axis_1);
  file.array("Float64", "axis_2", 3, grid.axis_2);
  file.array("Float64", "axis_3", 3, grid.axis_3);
  file.line("      </PointData>");
  file.line("      <CellData>");
  file.array("Int32", "kind", 1, grid.kind);
  file.array("Int32", "part", 1, grid.part);
  file.line("      </CellData>");
  file.line("    </Piece>");
  file.line("  </UnstructuredGrid>");
  file.xml += "  <AppendedData encoding=\"raw\">\n   _";
  return file.xml + file.data + "\n  </AppendedData>\n</VTKFile>\n";
}

std::string pvd_text(const std::vector<PvdEntry>& entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  for (const PvdEntry& entry : entries) {
    text += "    <DataSet timestep=\"";
    append_number(text, entry.time);
    text += "\" group=\"\" part=\"0\" file=\"" + xml_escaped(entry.file) + "\"/>\n";
  }
  return text + "  </Collection>\n</VTKFile>\n";
}

}  // namespace bough::io
