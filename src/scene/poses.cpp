#include "bough/scene/poses.hpp"

#include <charconv>
#include <cmath>

#include "bough/motion/norm.hpp"

namespace bough::scene {
namespace {

using motion::norm;

template <class List>
void add_all(std::unordered_map<std::string_view, Thing>& things, const List& list, ThingKind kind) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (!list[i].name.empty()) things.try_emplace(list[i].name, Thing{kind, i});
}

}  // namespace

Frame resolve(const Scene& scene, const Placement& placement) {
  if (placement.frame.empty()) return placement.pose;
  return Poses(scene).of(placement).value_or(placement.pose);
}

std::optional<Frame> initial_pose(const Scene& scene, const std::string& name) {
  return Poses(scene).of(std::string_view(name));
}

Vec3 default_axis_2(const Vec3& axis_1) {
  const Vec3 side = cross(Vec3::unit(2), axis_1);
  return dot(side, side) < 1e-12 * dot(axis_1, axis_1) ? Vec3::unit(1) : side;
}

std::optional<Mat3> axes_from(int k, const Vec3& main, const Vec3& next) {
  const double length = norm(main);
  if (!(length > 0.0)) return std::nullopt;
  const Vec3 a = (1.0 / length) * main;
  const Vec3 side = next - dot(a, next) * a;
  if (!(norm(side) > 1e-9 * norm(next))) return std::nullopt;
  const Vec3 b = (1.0 / norm(side)) * side;
  const Vec3 axes[3] = {a, b, cross(a, b)};
  Mat3 R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R(i, (k - 1 + j) % 3) = axes[j][i];
  return R;
}

namespace {

std::unordered_map<std::string_view, Thing> things_of(const Scene& scene) {
  std::unordered_map<std::string_view, Thing> things;
  things.reserve(scene.nodes.size() + scene.bodies.size() + scene.beams.size() + scene.joints.size() +
                 scene.couplings.size());
  add_all(things, scene.frames, ThingKind::frame);
  add_all(things, scene.nodes, ThingKind::node);
  add_all(things, scene.bodies, ThingKind::body);
  add_all(things, scene.beams, ThingKind::beam);
  add_all(things, scene.joints, ThingKind::joint);
  add_all(things, scene.couplings, ThingKind::other);
  add_all(things, scene.point_loads, ThingKind::other);
  add_all(things, scene.line_loads, ThingKind::other);
  add_all(things, scene.motions, ThingKind::other);
  return things;
}

}  // namespace

Poses::Poses(const Scene& scene)
    : scene_(scene),
      things_(things_of(scene)),
      frames_(scene, [this](const std::string& name) { return frame(name); }) {}

std::optional<Thing> Poses::find(std::string_view name) const {
  const auto it = things_.find(name);
  if (it == things_.end()) return std::nullopt;
  return it->second;
}

std::optional<Frame> Poses::chain(const Placement& placement) const {
  if (placement.frame.empty() || placement.frame == "ground") return placement.pose;
  const auto index = frame(placement.frame);
  if (!index || !frames_.pose(*index)) return std::nullopt;
  return motion::compose(*frames_.pose(*index), placement.pose);
}

std::optional<std::size_t> Poses::frame(const std::string& name) const {
  const auto thing = find(name);
  if (!thing || thing->kind != ThingKind::frame) return std::nullopt;
  return thing->index;
}

bool Poses::is_moving(const std::string& frame_name) const {
  const auto index = frame(frame_name);
  return index && frames_.is_moving(*index);
}

std::optional<Frame> Poses::of(const Placement& placement) const { return chain(placement); }

std::optional<Frame> Poses::of(const Attachment& attachment) const {
  const auto parent = of(std::string_view(attachment.to));
  if (!parent) return std::nullopt;
  return motion::compose(*parent, attachment.offset);
}

std::optional<Frame> Poses::of(std::string_view name) const {
  if (name.empty() || name == "ground") return Frame::identity();
  if (const auto thing = find(name)) return of(*thing);
  const std::size_t dot_at = name.rfind('.');
  if (dot_at == std::string_view::npos) return std::nullopt;
  const auto thing = find(name.substr(0, dot_at));
  if (!thing || thing->kind != ThingKind::beam) return std::nullopt;
  const Beam& beam = scene_.beams[thing->index];
  const std::string_view digits = name.substr(dot_at + 1);
  int k = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), k);
  const long last = static_cast<long>(beam.elements) * beam.order;
  if (error != std::errc() || end != digits.data() + digits.size() || k < 0 || k > last) return std::nullopt;
  const auto axis = axis_of(beam);
  if (!axis) return std::nullopt;
  return axis->at(static_cast<double>(k) / static_cast<double>(last));
}

std::optional<Frame> Poses::of(const Thing& thing) const {
  switch (thing.kind) {
    case ThingKind::frame:
      return frames_.pose(thing.index);
    case ThingKind::node:
      return chain(scene_.nodes[thing.index].placement);
    case ThingKind::body:
      return chain(scene_.bodies[thing.index].placement);
    default:
      return std::nullopt;
  }
}

double Poses::length_of(const Beam& beam) const {
  if (beam.curve == BeamCurve::curvature) return beam.length;
  const auto start = of(std::string_view(beam.start)), end = of(std::string_view(beam.end));
  if (!start || !end) return 0.0;
  return norm(motion::transform(*end, beam.end_offset.value_or(Vec3::zero())) -
              motion::transform(*start, beam.start_offset.value_or(Vec3::zero())));
}

std::optional<BeamAxis> Poses::axis_of(const Beam& beam) const {
  if (beam.start.find('.') != std::string::npos || beam.end.find('.') != std::string::npos)
    return std::nullopt;  // no beam ends at an inner node
  const auto start = of(std::string_view(beam.start));
  const auto frame = chain(Placement{Frame::identity(), beam.frame});
  if (!start || !frame) return std::nullopt;
  BeamAxis axis;
  axis.is_straight = beam.curve == BeamCurve::straight;
  const Vec3 origin = motion::transform(*start, beam.start_offset.value_or(Vec3::zero()));
  axis.span = frame->R * beam.tangent;
  axis.length = beam.length;
  if (axis.is_straight) {
    const auto end = of(std::string_view(beam.end));
    if (!end) return std::nullopt;
    axis.span = motion::transform(*end, beam.end_offset.value_or(Vec3::zero())) - origin;
    axis.length = norm(axis.span);
  }
  const Vec3 side = norm(beam.axis_2) > 0.0 ? frame->R * beam.axis_2 : default_axis_2(axis.span);
  const auto axes = axes_from(1, axis.span, side);
  if (!axes) return std::nullopt;
  axis.start = {*axes, origin};
  axis.twist = beam.twist;
  axis.curvature = beam.curvature;
  return axis;
}

Frame BeamAxis::at(double fraction) const {
  if (is_straight) return {start.R * motion::exp_so3(Vec3{{fraction * twist, 0.0, 0.0}}), start.x + fraction * span};
  const double s = fraction * length;
  const Vec3& k = curvature;
  return motion::compose(start, motion::exp_se3(Vec6{{s, 0.0, 0.0, s * k[0], s * k[1], s * k[2]}}));
}

}  // namespace bough::scene
