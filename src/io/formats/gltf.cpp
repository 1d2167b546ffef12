/// The moving structure as glTF 2.0 (ISO/IEC 12113:2022), one binary file that viewers of other programs animate.
///
/// Bodies are meshes that a node carries. Of a beam every point of its axis is a node, and its surface is one mesh, each
/// ring of which follows the node of its point (a skin): so it bends as the beam does. Joints, springs and bushings with
/// two ends apart are segments. Places and rotations of all nodes are given at the times of the pictures, between which
/// viewers interpolate, rotations on the group. glTF has y upwards: the node at the root turns z of the scene to it.
/// Loads, frames and section forces are left out.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>

#include "bough/io/json_text.hpp"
#include "bough/motion/quaternion.hpp"
#include "bough/motion/types.hpp"
#include "bough/scene/outlines.hpp"
#include "gltf_arrays.hpp"
#include "result_format.hpp"

namespace bough::io {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class GltfKind : std::uint8_t { body, beam, link };

/// A part that is drawn, as it is at the start.
struct GltfPart {
  std::string name;
  GltfKind kind = GltfKind::body;
  std::uint32_t nodes = 1;               ///< that move it; of a beam one a point
  std::vector<float> points;             ///< in the axes of its node, three numbers each
  std::vector<std::uint32_t> node_of;    ///< of a beam: which of its nodes a point follows
  std::vector<std::uint32_t> triangles;  ///< three points each
  std::vector<std::uint32_t> lines;      ///< two points each
  void checkpoint(records::Archive& archive) { archive(name, kind, nodes, points, node_of, triangles, lines); }
};

/// Place, rotation as a quaternion (x, y, z, w), and length of a segment: of every node in every picture.
constexpr std::size_t numbers_per_node = 8;

struct GltfColour {
  GltfKind kind;
  const char* name;
  double rgb[3];
};
constexpr GltfColour colours[] = {{GltfKind::body, "body", {0.79, 0.45, 0.16}},
                                  {GltfKind::beam, "beam", {0.20, 0.42, 0.65}},
                                  {GltfKind::link, "joint or spring", {0.35, 0.35, 0.35}}};

motion::Mat3<double> matrix_of(const double* axes) {
  motion::Mat3<double> R;
  std::copy_n(axes, 9, R.m);
  return R;
}

/// Surface of a beam: a ring of the section's corners at each point of the axis, and both ends.
void add_surface(GltfPart& part, const scene::Outline& outline, std::uint32_t rings) {
  const scene::Triangulation section = scene::triangles_of(outline);
  const auto corners = static_cast<std::uint32_t>(section.points.size());
  for (std::uint32_t k = 0; k < rings; ++k)
    for (const auto& corner : section.points) {
      part.points.insert(part.points.end(), {0.0F, static_cast<float>(corner[0]), static_cast<float>(corner[1])});
      part.node_of.push_back(k);
    }
  std::uint32_t first = 0;
  for (const auto& loop : outline.loops) {
    const auto count = static_cast<std::uint32_t>(loop.size());
    for (std::uint32_t k = 0; k + 1 < rings; ++k)
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t a = k * corners + first + i, b = k * corners + first + (i + 1) % count;
        part.triangles.insert(part.triangles.end(), {a, b, b + corners, a, b + corners, a + corners});
      }
    first += count;
  }
  const std::uint32_t last = (rings - 1) * corners;
  for (const auto& t : section.triangles) {
    const std::uint32_t a = static_cast<std::uint32_t>(t[0]), b = static_cast<std::uint32_t>(t[1]),
                        c = static_cast<std::uint32_t>(t[2]);
    part.triangles.insert(part.triangles.end(), {a, c, b, last + a, last + b, last + c});
  }
}

void add_axis(GltfPart& part, std::uint32_t points) {
  for (std::uint32_t k = 0; k < points; ++k) {
    part.points.insert(part.points.end(), {0.0F, 0.0F, 0.0F});
    part.node_of.push_back(k);
    if (k > 0) part.lines.insert(part.lines.end(), {k - 1, k});
  }
}

class Gltf final : public ResultWriter {
 public:
  using ResultWriter::ResultWriter;

  void motion(const records::MotionFrame& frame, const records::MotionParts& parts) override {
    if (times_.empty()) take_parts(frame, parts);
    times_.push_back(frame.time);
    for (const records::BodyPose& b : frame.bodies) add_node(b.center, matrix_of(b.axes), 1.0);
    for (const records::Curve& c : frame.curves)
      for (const records::CurvePoint& p : c.points) add_node(p.position, matrix_of(p.axes), 1.0);
    for (const records::Link& l : frame.links) add_segment(l);
  }

  void checkpoint(records::Archive& archive, const records::HistoryHeader&) override {
    archive(parts_, times_, numbers_, origin_, size_);
  }

  std::vector<std::string> commit(const records::Summary& summary, const ListFile& list) override {
    if (times_.empty()) return {};
    return {put("motion.glb", file_text(summary), list)};
  }

 private:
  void take_parts(const records::MotionFrame& frame, const records::MotionParts& parts) {
    place_origin(frame);
    for (std::size_t k = 0; k < frame.bodies.size(); ++k) parts_.push_back(body_part(frame.bodies[k], k, parts));
    for (std::size_t k = 0; k < frame.curves.size(); ++k) {
      if (frame.curves[k].points.size() > std::numeric_limits<std::uint16_t>::max())
        throw std::runtime_error("motion.glb cannot hold beam '" + frame.curves[k].name +
                                 "': glTF has at most 65535 points of a skin; leave \"gltf\" out of /output/formats");
      GltfPart part{frame.curves[k].name,
                    GltfKind::beam,
                    static_cast<std::uint32_t>(frame.curves[k].points.size()),
                    {},
                    {},
                    {},
                    {}};
      const int outline = k < parts.curves.size() ? parts.curves[k].outline : -1;
      if (outline >= 0)
        add_surface(part, parts.outlines[static_cast<std::size_t>(outline)], part.nodes);
      else
        add_axis(part, part.nodes);
      parts_.push_back(std::move(part));
    }
    for (const records::Link& link : frame.links)
      parts_.push_back({link.name, GltfKind::link, 1, {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F}, {}, {}, {0, 1}});
  }

  /// Single precision knows 7 digits: where the structure stands too far from the origin for them, its first picture is
  /// drawn about its own middle, which the file names.
  void place_origin(const records::MotionFrame& frame) {
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    const auto see = [&](const double* x) {
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], x[c]);
        high[c] = std::max(high[c], x[c]);
      }
    };
    for (const records::BodyPose& b : frame.bodies) see(b.center);
    for (const records::Curve& c : frame.curves)
      for (const records::CurvePoint& p : c.points) see(p.position);
    double far = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(low[c] <= high[c])) return;
      size_ = std::max(size_, high[c] - low[c]);
      far = std::max({far, std::abs(low[c]), std::abs(high[c])});
    }
    constexpr double round_off = 6e-8, visible = 1e-4;
    if (round_off * far <= visible * size_ || size_ == 0.0) return;
    for (std::size_t c = 0; c < 3; ++c) origin_[c] = 0.5 * (low[c] + high[c]);
  }

  static GltfPart body_part(const records::BodyPose& body, std::size_t k, const records::MotionParts& parts) {
    GltfPart part{body.name, GltfKind::body, 1, {}, {}, {}, {}};
    const int shape = k < parts.bodies.size() ? parts.bodies[k] : -1;
    if (shape >= 0) {
      const scene::Mesh& mesh = parts.meshes[static_cast<std::size_t>(shape)];
      for (const auto& p : mesh.points)
        for (const double x : p) part.points.push_back(static_cast<float>(x));
      for (const auto& t : mesh.triangles)
        for (const int i : t) part.triangles.push_back(static_cast<std::uint32_t>(i));
      return part;
    }
    part.points = {0.0F, 0.0F, 0.0F};  // spokes to what it is attached to
    for (const auto& x : body.attachments) {
      const motion::Vec3<double> arm{{x[0] - body.center[0], x[1] - body.center[1], x[2] - body.center[2]}};
      const motion::Vec3<double> own = lanes::transpose_times(matrix_of(body.axes), arm);
      part.lines.insert(part.lines.end(), {0, static_cast<std::uint32_t>(part.points.size() / 3)});
      for (int c = 0; c < 3; ++c) part.points.push_back(static_cast<float>(own[c]));
    }
    return part;
  }

  void add_node(const double* x, const motion::Mat3<double>& R, double length) {
    motion::Quaternion<double> q = motion::quaternion_of(R);
    if (const auto before = rotation_before())  // of q and -q the one near that of the picture before
      if (lanes::dot(before->v, q.v) + before->w * q.w < 0.0) q = {-q.w, -q.v};
    for (std::size_t c = 0; c < 3; ++c) numbers_.push_back(static_cast<float>(x[c] - origin_[c]));
    for (const double v : {q.v[0], q.v[1], q.v[2], q.w, length}) numbers_.push_back(static_cast<float>(v));
  }

  /// Of the node that is added next, in the picture before; nothing in the first one.
  std::optional<motion::Quaternion<double>> rotation_before() const {
    const std::size_t per_picture = num_nodes() * numbers_per_node;
    if (numbers_.size() < per_picture) return std::nullopt;
    const float* n = numbers_.data() + (numbers_.size() - per_picture) + 3;
    return motion::Quaternion<double>{n[3], {{n[0], n[1], n[2]}}};
  }

  /// The segment of the x axis from 0 to 1 on that of a link, which does not turn about itself.
  void add_segment(const records::Link& link) {
    const motion::Vec3<double> d{
        {link.second[0] - link.first[0], link.second[1] - link.first[1], link.second[2] - link.first[2]}};
    constexpr double visible = 1e-6;  // of the structure's size; what joints leave open is far below it
    const double length = lanes::length_of(d) > visible * size_ ? lanes::length_of(d) : 0.0;
    motion::Mat3<double> R = motion::Mat3<double>::identity();
    if (length > 0.0) {
      const motion::Vec3<double> x = (1.0 / length) * d;
      motion::Vec3<double> y =
          std::abs(x[1]) < 0.9 ? motion::Vec3<double>{{0.0, 1.0, 0.0}} : motion::Vec3<double>{{0.0, 0.0, 1.0}};
      if (const auto before = rotation_before()) {
        const motion::Mat3<double> Q = motion::rotation_of(motion::normalise(*before));
        const motion::Vec3<double> second{{Q(0, 1), Q(1, 1), Q(2, 1)}};
        if (std::abs(lanes::dot(second, x)) < 0.99) y = second;
      }
      y = y - lanes::dot(y, x) * x;
      y = (1.0 / lanes::length_of(y)) * y;
      const motion::Vec3<double> z = lanes::cross(x, y);
      for (int r = 0; r < 3; ++r) {
        R(r, 0) = x[r];
        R(r, 1) = y[r];
        R(r, 2) = z[r];
      }
    }
    add_node(link.first, R, length);
  }

  std::size_t num_nodes() const {
    std::size_t count = 0;
    for (const GltfPart& part : parts_) count += part.nodes;
    return count;
  }
  const float* number(std::size_t picture, std::size_t node) const {
    return numbers_.data() + (picture * num_nodes() + node) * numbers_per_node;
  }

  /// The inverse pose of a node at the start, y upwards, as a matrix of glTF, column by column: points of a surface are
  /// given where they are at the start, and it takes them into the axes of their node.
  std::array<float, 16> inverse_at_start(std::size_t node) const {
    const motion::Mat3<double> R = rotation_at_start(node);
    const motion::Vec3<double> x = place_at_start(node), own = lanes::transpose_times(R, x);
    std::array<float, 16> m{};
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) m[static_cast<std::size_t>(4 * c + r)] = static_cast<float>(R(c, r));
      m[static_cast<std::size_t>(12 + r)] = static_cast<float>(-own[r]);
    }
    m[15] = 1.0F;
    return m;
  }
  /// With y upwards: (x, y, z) of the scene is (x, z, -y).
  static motion::Vec3<double> upright(const motion::Vec3<double>& x) { return {{x[0], x[2], -x[1]}}; }
  motion::Vec3<double> place_at_start(std::size_t node) const {
    const float* n = number(0, node);
    return upright({{n[0], n[1], n[2]}});
  }
  motion::Mat3<double> rotation_at_start(std::size_t node) const {
    const float* n = number(0, node);
    const motion::Mat3<double> R =
        motion::rotation_of(motion::normalise(motion::Quaternion<double>{n[6], {{n[3], n[4], n[5]}}}));
    motion::Mat3<double> turned;
    for (int c = 0; c < 3; ++c) {
      const motion::Vec3<double> column = upright({{R(0, c), R(1, c), R(2, c)}});
      for (int r = 0; r < 3; ++r) turned(r, c) = column[r];
    }
    return turned;
  }

  /// Links whose ends coincide at all times are not drawn.
  bool is_drawn(const GltfPart& part, std::size_t node) const {
    if (part.triangles.empty() && part.lines.empty()) return false;
    if (part.kind != GltfKind::link) return true;
    for (std::size_t k = 0; k < times_.size(); ++k)
      if (number(k, node)[7] > 0.0F) return true;
    return false;
  }

  std::string file_text(const records::Summary& summary) const;
  void write_meshes(JsonText& json, GltfArrays& arrays) const;
  void write_nodes(JsonText& json) const;
  void write_skins(JsonText& json, GltfArrays& arrays) const;
  void write_animation(JsonText& json, GltfArrays& arrays) const;

  std::vector<GltfPart> parts_;
  std::vector<double> times_;
  std::vector<float> numbers_;  ///< pictures x nodes x numbers_per_node
  std::array<double, 3> origin_{};
  double size_ = 0.0;  ///< of the structure at the start
};

void Gltf::write_meshes(JsonText& json, GltfArrays& arrays) const {
  constexpr int of_points = 34962, of_indices = 34963;
  begin_list(json, "meshes");
  std::size_t node = 0;
  for (const GltfPart& part : parts_) {
    if (is_drawn(part, node)) {
      std::vector<float> points = part.points;
      std::vector<std::uint16_t> joints;
      std::vector<float> weights;
      for (std::size_t k = 0; k < part.node_of.size(); ++k) {
        const std::size_t carrier = node + part.node_of[k];
        const motion::Vec3<double> x =
            place_at_start(carrier) +
            rotation_at_start(carrier) * motion::Vec3<double>{{points[3 * k], points[3 * k + 1], points[3 * k + 2]}};
        for (std::size_t c = 0; c < 3; ++c) points[3 * k + c] = static_cast<float>(x[static_cast<int>(c)]);
        joints.insert(joints.end(), {static_cast<std::uint16_t>(part.node_of[k]), 0, 0, 0});
        weights.insert(weights.end(), {1.0F, 0.0F, 0.0F, 0.0F});
      }
      const bool has_surface = !part.triangles.empty();
      const long long place = arrays.add(points, GltfArrays::float32, 3, true, of_points);
      const long long order =
          arrays.add(has_surface ? part.triangles : part.lines, GltfArrays::uint32, 1, false, of_indices);
      json.begin_object();
      json.member("name", std::string_view(part.name));
      begin_list(json, "primitives");
      json.begin_object();
      begin_member(json, "attributes");
      json.member("POSITION", place);
      if (!joints.empty()) {
        json.member("JOINTS_0", arrays.add(joints, GltfArrays::uint16, 4, false, of_points));
        json.member("WEIGHTS_0", arrays.add(weights, GltfArrays::float32, 4, false, of_points));
      }
      json.end_object();
      json.member("indices", order);
      json.member("mode", has_surface ? 4LL : 1LL);
      json.member("material", static_cast<long long>(part.kind));
      json.end_object();
      json.end_array();
      json.end_object();
    }
    node += part.nodes;
  }
  json.end_array();
}

/// Node 0 turns the scene, the next ones are those of the parts, the last ones carry the surfaces of beams.
void Gltf::write_nodes(JsonText& json) const {
  const auto count = static_cast<long long>(num_nodes());
  const double half = std::sqrt(0.5);
  begin_list(json, "nodes");
  json.begin_object();
  json.member("name", "scene, z upwards");
  write_numbers(json, "rotation", {-half, 0.0, 0.0, half});
  if (origin_ != std::array<double, 3>{}) {
    begin_member(json, "extras");
    write_numbers(json, "origin", origin_);
    json.end_object();
  }
  write_range(json, "children", 1, count);
  json.end_object();
  std::size_t node = 0;
  long long mesh = 0;
  std::vector<std::pair<std::string, long long>> surfaces;
  for (const GltfPart& part : parts_) {
    const bool drawn = is_drawn(part, node), is_beam = part.kind == GltfKind::beam;
    for (std::uint32_t k = 0; k < part.nodes; ++k) {
      const float* n = number(0, node + k);
      json.begin_object();
      json.member("name", std::string_view(is_beam ? part.name + " " + std::to_string(k) : part.name));
      write_numbers(json, "translation", {n[0], n[1], n[2]});
      write_numbers(json, "rotation", {n[3], n[4], n[5], n[6]});
      if (part.kind == GltfKind::link) write_numbers(json, "scale", {n[7], 1.0, 1.0});
      if (drawn && !is_beam) json.member("mesh", mesh);
      json.end_object();
    }
    if (drawn && is_beam) surfaces.emplace_back(part.name, mesh);
    if (drawn) ++mesh;
    node += part.nodes;
  }
  long long skin = 0;
  for (const auto& [name, of] : surfaces) {
    json.begin_object();
    json.member("name", std::string_view(name + ", surface"));
    json.member("mesh", of);
    json.member("skin", skin++);
    json.end_object();
  }
  json.end_array();
  begin_list(json, "scenes");
  json.begin_object();
  begin_list(json, "nodes");
  json.value(0LL);
  for (long long k = 0; k < skin; ++k) json.value(count + 1 + k);
  json.end_array();
  json.end_object();
  json.end_array();
  json.member("scene", 0LL);
}

void Gltf::write_skins(JsonText& json, GltfArrays& arrays) const {
  const bool has_beams = std::any_of(parts_.begin(), parts_.end(),
                                     [](const GltfPart& p) { return p.kind == GltfKind::beam && !p.points.empty(); });
  if (!has_beams) return;  // an empty list is not allowed
  begin_list(json, "skins");
  std::size_t node = 0;
  for (const GltfPart& part : parts_) {
    if (part.kind == GltfKind::beam && is_drawn(part, node)) {
      std::vector<float> inverse;
      for (std::uint32_t k = 0; k < part.nodes; ++k) {
        const std::array<float, 16> m = inverse_at_start(node + k);
        inverse.insert(inverse.end(), m.begin(), m.end());
      }
      json.begin_object();
      json.member("inverseBindMatrices", arrays.add(inverse, GltfArrays::float32, 16, false));
      write_range(json, "joints", static_cast<long long>(node) + 1, part.nodes);
      json.end_object();
    }
    node += part.nodes;
  }
  json.end_array();
}

/// Times have to grow: where they do not, as load factors along a path, the numbers of the pictures stand for them.
void Gltf::write_animation(JsonText& json, GltfArrays& arrays) const {
  if (times_.size() < 2) return;
  std::vector<float> times(times_.begin(), times_.end());
  const bool grows = times.front() >= 0.0F && std::adjacent_find(times.begin(), times.end(), [](float a, float b) {
                                                return !(a < b);
                                              }) == times.end();
  for (std::size_t k = 0; !grows && k < times.size(); ++k) times[k] = static_cast<float>(k);
  const long long input = arrays.add(times, GltfArrays::float32, 1, true);
  struct Channel {
    std::size_t node;
    const char* path;
    long long output;
  };
  std::vector<Channel> channels;
  std::size_t node = 0;
  const auto add = [&](std::size_t n, const char* path, std::size_t begin, std::size_t components) {
    std::vector<float> values;
    for (std::size_t k = 0; k < times_.size(); ++k)
      values.insert(values.end(), number(k, n) + begin, number(k, n) + begin + components);
    channels.push_back({n, path, arrays.add(values, GltfArrays::float32, components, false)});
  };
  for (const GltfPart& part : parts_) {
    const bool drawn = is_drawn(part, node);
    for (std::size_t n = node; drawn && n < node + part.nodes; ++n) {
      add(n, "translation", 0, 3);
      add(n, "rotation", 3, 4);
      if (part.kind != GltfKind::link) continue;
      std::vector<float> scale;
      for (std::size_t k = 0; k < times_.size(); ++k) scale.insert(scale.end(), {number(k, n)[7], 1.0F, 1.0F});
      channels.push_back({n, "scale", arrays.add(scale, GltfArrays::float32, 3, false)});
    }
    node += part.nodes;
  }
  if (channels.empty()) return;
  begin_list(json, "animations");
  json.begin_object();
  json.member("name", "motion");
  begin_list(json, "samplers");
  for (const Channel& c : channels) {
    json.begin_object();
    json.member("input", input);
    json.member("output", c.output);
    json.member("interpolation", "LINEAR");
    json.end_object();
  }
  json.end_array();
  begin_list(json, "channels");
  for (std::size_t k = 0; k < channels.size(); ++k) {
    json.begin_object();
    json.member("sampler", static_cast<long long>(k));
    begin_member(json, "target");
    json.member("node", static_cast<long long>(channels[k].node) + 1);
    json.member("path", channels[k].path);
    json.end_object();
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.end_array();
}

std::string Gltf::file_text(const records::Summary& summary) const {
  GltfArrays arrays;
  JsonText json;
  json.begin_object();
  begin_member(json, "asset");
  json.member("version", "2.0");
  json.member("generator", "bough");
  json.end_object();
  begin_member(json, "extras");
  json.member("scene", std::string_view(summary.scene));
  json.end_object();
  begin_list(json, "materials");
  for (const GltfColour& colour : colours) {
    json.begin_object();
    json.member("name", colour.name);
    begin_member(json, "pbrMetallicRoughness");
    write_numbers(json, "baseColorFactor", {colour.rgb[0], colour.rgb[1], colour.rgb[2], 1.0});
    json.member("metallicFactor", 0.1);
    json.member("roughnessFactor", 0.7);
    json.end_object();
    json.member("doubleSided", true);
    json.end_object();
  }
  json.end_array();
  write_meshes(json, arrays);
  write_nodes(json);
  write_skins(json, arrays);
  write_animation(json, arrays);
  arrays.write(json);
  json.end_object();
  std::string text = json.text();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t size = 12 + 8 + text.size() + 8 + arrays.bytes.size();
  if (size > std::numeric_limits<std::uint32_t>::max())
    throw std::runtime_error("motion.glb would be larger than the 4 GiB that glTF allows: record fewer pictures");
  std::string file;
  const auto word = [&file](std::uint32_t v) { file.append(reinterpret_cast<const char*>(&v), sizeof v); };
  word(0x46546C67);  // "glTF"
  word(2);
  word(static_cast<std::uint32_t>(size));
  word(static_cast<std::uint32_t>(text.size()));
  word(0x4E4F534A);  // "JSON"
  file += text;
  word(static_cast<std::uint32_t>(arrays.bytes.size()));
  word(0x004E4942);  // "BIN"
  return file + arrays.bytes;
}

}  // namespace

ResultFormat gltf() {
  return {"gltf",
          {"motion.glb"},
          make_writer<Gltf>,
          "the moving structure as glTF, for viewers, slides and web pages",
          true};
}

}  // namespace bough::io
