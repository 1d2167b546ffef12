#include "bough/io/write_vtu.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>

#include "bough/io/number_text.hpp"
#include "bough/scene/outlines.hpp"

namespace bough::io {
namespace {

static_assert(std::endian::native == std::endian::little, "VTU data are written as they stand in memory");

constexpr std::uint8_t vtk_vertex = 1, vtk_line = 3, vtk_polyline = 4, vtk_triangle = 5, vtk_wedge = 13;
enum class Kind : std::int32_t { beam = 0, body = 1, link = 2, load = 3 };

/// Data of a point besides its position; zero where it has none.
struct PointValues {
  const double* force = nullptr;     ///< 6
  const double* strain = nullptr;    ///< 6
  const double* velocity = nullptr;  ///< 3
  const double* axes = nullptr;      ///< 9
};

struct Grid {
  std::vector<double> points;
  std::vector<float> force, moment, strain, curvature, velocity, axis_1, axis_2, axis_3;  // 3 per point
  std::vector<std::int32_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  std::vector<std::int32_t> kind, part, subdomain;

  std::int32_t num_points() const { return static_cast<std::int32_t>(points.size() / 3); }

  void add_point(const double* x, const PointValues& v) {
    points.insert(points.end(), x, x + 3);
    const auto put = [](std::vector<float>& to, const double* from, std::size_t stride) {
      for (std::size_t k = 0; k < 3; ++k) to.push_back(from != nullptr ? static_cast<float>(from[k * stride]) : 0.0f);
    };
    put(force, v.force, 1);
    put(moment, v.force != nullptr ? v.force + 3 : nullptr, 1);
    put(strain, v.strain, 1);
    put(curvature, v.strain != nullptr ? v.strain + 3 : nullptr, 1);
    put(velocity, v.velocity, 1);
    put(axis_1, v.axes, 3);
    put(axis_2, v.axes != nullptr ? v.axes + 1 : nullptr, 3);
    put(axis_3, v.axes != nullptr ? v.axes + 2 : nullptr, 3);
  }

  void add_cell(std::uint8_t type, std::span<const std::int32_t> corners, Kind of, std::size_t index, int leaf = -1) {
    connectivity.insert(connectivity.end(), corners.begin(), corners.end());
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
    types.push_back(type);
    kind.push_back(static_cast<std::int32_t>(of));
    part.push_back(static_cast<std::int32_t>(index));
    subdomain.push_back(leaf);
  }
};

/// Sub-domain of the interval after point k of a curve.
int leaf_of(const records::MotionParts::Curve& part, std::size_t k, std::size_t intervals) {
  if (part.subdomains.empty()) return -1;
  return part.subdomains[std::min(part.subdomains.size() - 1, k * part.subdomains.size() / intervals)];
}

void add_curve(Grid& grid, const records::Curve& curve, std::size_t index, const records::MotionParts& parts,
               const std::vector<scene::Triangulation>& sections) {
  if (curve.points.size() < 2) return;
  const std::size_t intervals = curve.points.size() - 1;
  const records::MotionParts::Curve part =
      index < parts.curves.size() ? parts.curves[index] : records::MotionParts::Curve{};
  std::vector<std::int32_t> axis;
  for (const records::CurvePoint& p : curve.points) {
    axis.push_back(grid.num_points());
    grid.add_point(p.position, {p.force, p.strain, p.velocity, p.axes});
  }
  grid.add_cell(vtk_polyline, axis, Kind::beam, index);
  if (part.outline < 0) return;
  const scene::Triangulation& section = sections[static_cast<std::size_t>(part.outline)];
  const auto corners = static_cast<std::int32_t>(section.points.size());
  const std::int32_t first = grid.num_points();
  for (const records::CurvePoint& p : curve.points)
    for (const auto& corner : section.points) {
      double x[3];
      for (std::size_t r = 0; r < 3; ++r)
        x[r] = p.position[r] + p.axes[3 * r + 1] * corner[0] + p.axes[3 * r + 2] * corner[1];
      grid.add_point(x, {p.force, p.strain, p.velocity, nullptr});
    }
  for (std::size_t k = 0; k < intervals; ++k) {
    const std::int32_t low = first + static_cast<std::int32_t>(k) * corners, high = low + corners;
    for (const auto& t : section.triangles)  // the first face of a wedge is seen counter-clockwise from outside
      grid.add_cell(vtk_wedge, std::array{low + t[0], low + t[2], low + t[1], high + t[0], high + t[2], high + t[1]},
                    Kind::beam, index, leaf_of(part, k, intervals));
  }
}

void add_body(Grid& grid, const records::BodyPose& body, std::size_t index, const records::MotionParts& parts) {
  const int shape = index < parts.bodies.size() ? parts.bodies[index] : -1;
  if (shape < 0) {
    grid.add_point(body.center, {nullptr, nullptr, body.velocity, nullptr});
    return grid.add_cell(vtk_vertex, std::array{grid.num_points() - 1}, Kind::body, index);
  }
  const scene::Mesh& mesh = parts.meshes[static_cast<std::size_t>(shape)];
  const std::int32_t first = grid.num_points();
  for (const auto& p : mesh.points) {
    double x[3];
    for (std::size_t r = 0; r < 3; ++r)
      x[r] = body.center[r] + body.axes[3 * r] * p[0] + body.axes[3 * r + 1] * p[1] + body.axes[3 * r + 2] * p[2];
    grid.add_point(x, {nullptr, nullptr, body.velocity, nullptr});
  }
  for (const auto& t : mesh.triangles)
    grid.add_cell(vtk_triangle, std::array{first + t[0], first + t[1], first + t[2]}, Kind::body, index);
}

void add_link(Grid& grid, const records::Link& link, std::size_t index) {
  const std::array ends{grid.num_points(), grid.num_points() + 1};
  grid.add_point(link.first, {});
  grid.add_point(link.second, {});
  grid.add_cell(vtk_line, ends, Kind::link, index);
}

void add_arrow(Grid& grid, const records::Arrow& arrow, std::size_t index) {
  double wrench[6];
  std::copy_n(arrow.force, 3, wrench);
  std::copy_n(arrow.moment, 3, wrench + 3);
  grid.add_point(arrow.position, {wrench, nullptr, nullptr, nullptr});
  grid.add_cell(vtk_vertex, std::array{grid.num_points() - 1}, Kind::load, index);
}

/// Whether rounding to single precision would change coordinates by more than a ten-thousandth of the structure's size.
bool needs_double(const std::vector<double>& points) {
  double most = 0.0, low[3], high[3];
  std::fill_n(low, 3, std::numeric_limits<double>::infinity());
  std::fill_n(high, 3, -std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < points.size(); ++k) {
    most = std::max(most, std::abs(points[k]));
    low[k % 3] = std::min(low[k % 3], points[k]);
    high[k % 3] = std::max(high[k % 3], points[k]);
  }
  double size = 0.0;
  for (int c = 0; c < 3; ++c) size = std::max(size, high[c] - low[c]);
  return !(6e-8 * most <= 1e-4 * size) || !(most < 1e38);
}

/// Collects the arrays: of each the number of blocks, their size, that of a last one that is not full, the compressed
/// sizes (UInt64), and the blocks.
struct Appended {
  std::string xml, data;

  template <class T>
  void array(const char* type, const char* name, int components, const std::vector<T>& values) {
    xml += std::string("        <DataArray type=\"") + type + "\" Name=\"" + name + "\"";
    if (components > 1) xml += " NumberOfComponents=\"" + std::to_string(components) + "\"";
    xml += " format=\"appended\" offset=\"" + std::to_string(data.size()) + "\"/>\n";
    constexpr std::size_t block = std::size_t{1} << 20;
    const auto* bytes = reinterpret_cast<const Bytef*>(values.data());
    const std::size_t size = values.size() * sizeof(T), count = (size + block - 1) / block;
    std::vector<std::uint64_t> head{count, block, size % block};
    std::string packed;
    for (std::size_t b = 0; b < count; ++b) {
      const std::size_t length = std::min(block, size - b * block);
      uLongf room = compressBound(static_cast<uLong>(length));
      std::string part(room, '\0');
      // Level 1: half the bytes of no compression, in a small part of a step's time.
      if (compress2(reinterpret_cast<Bytef*>(part.data()), &room, bytes + b * block, static_cast<uLong>(length), 1) !=
          Z_OK)
        throw std::runtime_error("zlib cannot compress a picture");
      head.push_back(room);
      packed.append(part, 0, room);
    }
    data.append(reinterpret_cast<const char*>(head.data()), head.size() * sizeof head[0]);
    data += packed;
  }
  void line(const char* text) { (xml += text) += '\n'; }
  /// Strings of a field: their bytes in decimal, each ended by a zero.
  template <class Part>
  void names(const char* name, const std::vector<Part>& list) {
    if (list.empty()) return;
    xml += std::string("      <DataArray type=\"String\" Name=\"") + name + "\" NumberOfTuples=\"" +
           std::to_string(list.size()) + "\" format=\"ascii\">\n";
    for (const Part& part : list) {
      for (const char c : part.name) xml += std::to_string(static_cast<int>(static_cast<unsigned char>(c))) + ' ';
      xml += "0\n";
    }
    line("      </DataArray>");
  }
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

std::string vtu_text(const records::MotionFrame& frame, const records::MotionParts& parts) {
  std::vector<scene::Triangulation> sections;
  for (const scene::Outline& outline : parts.outlines) sections.push_back(scene::triangles_of(outline));
  Grid grid;
  for (std::size_t k = 0; k < frame.curves.size(); ++k) add_curve(grid, frame.curves[k], k, parts, sections);
  for (std::size_t k = 0; k < frame.bodies.size(); ++k) add_body(grid, frame.bodies[k], k, parts);
  for (std::size_t k = 0; k < frame.links.size(); ++k) add_link(grid, frame.links[k], k);
  for (std::size_t k = 0; k < frame.arrows.size(); ++k) add_arrow(grid, frame.arrows[k], k);

  Appended file;
  file.line("<?xml version=\"1.0\"?>");
  file.line(
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
      "compressor=\"vtkZLibDataCompressor\">");
  file.line("  <UnstructuredGrid>");
  file.line("    <FieldData>");
  file.xml += "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">";
  append_number(file.xml, frame.time);
  file.line("</DataArray>");
  file.names("beam_names", frame.curves);
  file.names("body_names", frame.bodies);
  file.names("link_names", frame.links);
  file.names("load_names", frame.arrows);
  for (const records::SignalValue& signal : frame.signals) {
    file.xml += "      <DataArray type=\"Float64\" Name=\"signal " + xml_escaped(signal.name) +
                "\" NumberOfTuples=\"1\" format=\"ascii\">";
    append_number(file.xml, signal.value);
    file.line("</DataArray>");
  }
  file.line("    </FieldData>");
  file.xml += "    <Piece NumberOfPoints=\"" + std::to_string(grid.num_points()) + "\" NumberOfCells=\"" +
              std::to_string(grid.types.size()) + "\">\n";
  file.line("      <Points>");
  if (needs_double(grid.points))
    file.array("Float64", "Points", 3, grid.points);
  else
    file.array("Float32", "Points", 3, std::vector<float>(grid.points.begin(), grid.points.end()));
  file.line("      </Points>");
  file.line("      <Cells>");
  file.array("Int32", "connectivity", 1, grid.connectivity);
  file.array("Int32", "offsets", 1, grid.offsets);
  file.array("UInt8", "types", 1, grid.types);
  file.line("      </Cells>");
  file.line("      <PointData>");
  file.array("Float32", "force", 3, grid.force);
  file.array("Float32", "moment", 3, grid.moment);
  file.array("Float32", "strain", 3, grid.strain);
  file.array("Float32", "curvature", 3, grid.curvature);
  file.array("Float32", "velocity", 3, grid.velocity);
  file.array("Float32", "axis_1", 3, grid.axis_1);
  file.array("Float32", "axis_2", 3, grid.axis_2);
  file.array("Float32", "axis_3", 3, grid.axis_3);
  file.line("      </PointData>");
  file.line("      <CellData>");
  file.array("Int32", "kind", 1, grid.kind);
  file.array("Int32", "part", 1, grid.part);
  file.array("Int32", "subdomain", 1, grid.subdomain);
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
  const bool grows = std::adjacent_find(entries.begin(), entries.end(), [](const PvdEntry& a, const PvdEntry& b) {
                       return !(a.time < b.time);
                     }) == entries.end();
  int number = 0;
  for (const PvdEntry& entry : entries) {
    text += "    <DataSet timestep=\"";
    append_number(text, grows ? entry.time : number++);
    text += "\" group=\"\" part=\"0\" file=\"" + xml_escaped(entry.file) + "\"/>\n";
  }
  return text + "  </Collection>\n</VTKFile>\n";
}

}  // namespace bough::io
