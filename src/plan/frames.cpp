#include "bough/plan/frames.hpp"

#include <algorithm>

#include "bough/scene/frames.hpp"
#include "bough/scene/poses.hpp"
#include "geometry.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::CarrierMotion;
using elements::Port;
using motion::Frame;
using motion::Mat3;
using motion::Vec3;
using motion::Vec6;

namespace {

using Series = FrameCourse::Series;

using Course = FrameCourse;

Course still() {
  Course c{motion::cast<Series>(Frame<double>::identity()), Vec6<Series>::zero()};
  return c;
}

Series derivative(const Series& x) {
  Series r(0.0);
  for (int k = 0; k < 3; ++k) r.c[k] = (k + 1) * x.c[k + 1];
  return r;
}

/// Motion of a frame in its parent. The angular velocity in the frame's axes grows turn by turn: w <- exp(-angle
/// ~axis) w + angle' axis.
Course in_parent(const FramePlan& f, const Series* laws) {
  Course c{motion::cast<Series>(f.pose), Vec6<Series>::zero()};
  Vec3<Series> velocity = Vec3<Series>::zero(), turning = Vec3<Series>::zero();
  for (int i = 0; i < 3; ++i)
    if (f.position[i] >= 0) {
      c.pose.x[i] = laws[f.position[i]];
      velocity[i] = derivative(laws[f.position[i]]);
    }
  for (const FramePlan::Turn& t : f.turns) {
    Series sine, cosine;
    sin_cos(laws[t.angle], sine, cosine);
    const Mat3<double> n = lanes::skew(t.axis), nn = n * n;
    Mat3<Series> turn = lanes::cast<Series>(Mat3<double>::identity());
    for (int i = 0; i < 9; ++i) turn.m[i] = turn.m[i] + n.m[i] * sine + nn.m[i] * (1.0 - cosine);
    c.pose.R = c.pose.R * turn;
    turning = lanes::transpose_times(turn, turning) + derivative(laws[t.angle]) * lanes::cast<Series>(t.axis);
  }
  c.twist = lanes::join(lanes::transpose_times(c.pose.R, velocity), turning);
  return c;
}

Course compose(const Course& parent, const Course& c) {
  return {motion::compose(parent.pose, c.pose), motion::inverse_adjoint_times(c.pose, parent.twist) + c.twist};
}

Course relative(const Course& observer, const Course& c) {
  Course r;
  r.pose = motion::relative(observer.pose, c.pose);
  r.twist = c.twist - motion::inverse_adjoint_times(r.pose, observer.twist);
  return r;
}

CarrierMotion motion_of(const Course& c) {
  CarrierMotion m;
  for (int i = 0; i < 9; ++i) m.pose.R.m[i] = c.pose.R.m[i].c[0];
  for (int i = 0; i < 3; ++i) m.pose.x[i] = c.pose.x[i].c[0];
  for (int i = 0; i < 6; ++i) {
    m.twist[i] = c.twist[i].c[0];
    m.twist_rate[i] = c.twist[i].c[1];
    m.twist_second[i] = 2.0 * c.twist[i].c[2];
  }
  return m;
}

}  // namespace

void eval_frames(const Plan& plan, const lanes::Taylor<double, 3>* laws, FrameMotions& motions) {
  motions.in_ground.resize(plan.frames.size());
  motions.courses.resize(plan.frames.size());
  for (std::size_t f = 0; f < plan.frames.size(); ++f) {  // parents first
    const FramePlan& frame = plan.frames[f];
    const bool starts = frame.parent < 0 || (frame.in_observer && frame.parent == plan.observer);
    const Course own = in_parent(frame, laws);
    motions.courses[f] = starts ? own : compose(motions.courses[static_cast<std::size_t>(frame.parent)], own);
  }
  const Course observer = plan.observer < 0 ? still() : motions.courses[static_cast<std::size_t>(plan.observer)];
  motions.observer = motion_of(observer);
  for (std::size_t f = 0; f < plan.frames.size(); ++f) {
    const Course& course = motions.courses[f];
    if (static_cast<int>(f) == plan.observer)
      motions.in_ground[f] = CarrierMotion{};
    else
      motions.in_ground[f] =
          motion_of(plan.observer < 0 || plan.frames[f].in_observer ? course : relative(observer, course));
  }
}

FrameMotions frames_at_start(const Plan& plan) {
  FrameMotions start;
  std::vector<Series> series;
  for (const LawPlan& l : plan.laws) {
    const laws::LawValue v = l.law.at(0.0, laws::Side::right);
    series.emplace_back(v.value);
    series.back().c[1] = v.rate;
    series.back().c[2] = 0.5 * v.acceleration;
  }
  eval_frames(plan, series.data(), start);
  return start;
}

namespace {

/// Order of the frames: parents before their children, and the frames above the ground first.
std::vector<std::size_t> from_the_top(const scene::FrameTree& frames, std::size_t count) {
  std::vector<std::size_t> order, way;
  std::vector<bool> is_placed(count, false);
  const auto append_way = [&](std::size_t from) {
    way.clear();
    for (std::size_t i = from; i != scene::FrameTree::none && !is_placed[i]; i = frames.parent(i)) {
      is_placed[i] = true;
      way.push_back(i);
    }
    order.insert(order.end(), way.rbegin(), way.rend());
  };
  if (!frames.above_ground().empty()) append_way(frames.above_ground().front());
  for (std::size_t i = 0; i < count; ++i) append_way(i);
  return order;
}

}  // namespace

/// Adds frames, parents before children. Adds none if no frame moves: all placements are then in the ground.
void Builder::add_frames() {
  const scene::FrameTree& frames = poses.frames();
  const bool any_moves = std::any_of(scene.frames.begin(), scene.frames.end(),
                                     [](const scene::FrameDef& f) { return f.motion.has_value(); });
  for (std::size_t i = 0; i < scene.frames.size(); ++i)
    frame_start[scene.frames[i].name] = frames.pose(i).value_or(scene.frames[i].placement.pose);
  if (!any_moves && scene.analysis.frame.empty()) return;
  std::vector<bool> is_above_ground(scene.frames.size(), false);
  for (const std::size_t i : frames.above_ground()) is_above_ground[i] = true;
  std::vector<int> plan_index(scene.frames.size(), -1);
  for (const std::size_t i : from_the_top(frames, scene.frames.size())) {
    const scene::FrameDef& given = scene.frames[i];
    FramePlan f;
    f.name = given.name;
    f.pose = given.placement.pose;
    const std::size_t parent = frames.parent(i);
    f.parent = parent != scene::FrameTree::none ? plan_index[parent] : is_above_ground[i] ? -1 : plan.observer;
    f.in_observer = !is_above_ground[i] && plan.observer >= 0 &&
                    (f.parent == plan.observer || plan.frames[static_cast<std::size_t>(f.parent)].in_observer);
    const auto add = [&](const laws::Law& law) {
      const int id = add_law(law, given.name);
      plan.laws.back().at_start = is_above_ground[i] && !plan.is_dynamic;
      return id;
    };
    if (given.motion) {
      f.pose.R = given.motion->rotation;
      for (int k = 0; k < 3; ++k)
        if (!given.motion->position[k].is_constant()) f.position[k] = add(given.motion->position[k]);
      for (const scene::Turn& t : given.motion->turns) f.turns.push_back({t.axis, add(t.angle)});
    }
    plan_index[i] = static_cast<int>(plan.frames.size());
    plan.frames.push_back(f);
    if (given.name == scene.analysis.frame) plan.observer = plan_index[i];
  }
  for (std::size_t i = 0; i < scene.frames.size(); ++i)
    if (frames.is_moving(i)) carrier_of[scene.frames[i].name] = plan_index[i];
  start_motions = frames_at_start(plan);
}

Port Builder::port_at(const std::string& to, const Frame<double>& offset) const {
  Port port;
  if (to.empty() || to == "ground") {
    port.offset = offset;
    port.has_offset = true;
    return port;
  }
  if (const auto frame = frame_start.find(to); frame != frame_start.end()) {
    const auto carrier = carrier_of.find(to);
    if (carrier != carrier_of.end()) port.carrier = carrier->second;
    port.offset = carrier != carrier_of.end() ? offset : motion::compose(frame->second, offset);
    port.has_offset = true;
    return port;
  }
  port.node = node_of.at(to);
  const auto part = part_offset.find(to);
  port.offset = part == part_offset.end() ? offset : motion::compose(part->second, offset);
  port.has_offset = !is_identity(port.offset);
  return port;
}
Port Builder::port_at(const scene::Attachment& a) const { return port_at(a.to, a.offset); }

Frame<double> Builder::initial_pose(const Port& port) const {
  if (port.carrier >= 0)
    return motion::compose(frame_start.at(plan.frames[static_cast<std::size_t>(port.carrier)].name), port.offset);
  if (port.node == elements::ground) return port.offset;
  const Frame<double>& node = plan.nodes[static_cast<std::size_t>(port.node)].pose;
  return port.has_offset ? motion::compose(node, port.offset) : node;
}

std::vector<SpaceLoad> Builder::space_loads(const Vec3<double>& force, const Vec3<double>& moment,
                                            const std::string& frame, bool follows, int law, const std::string& user) {
  if (frame.empty() || frame == "ground" || follows) return {{lanes::join(force, moment), follows, law}};
  const auto carrier = carrier_of.find(frame);
  if (carrier == carrier_of.end()) {
    const Mat3<double>& R = frame_start.at(frame).R;
    return {{lanes::join(R * force, R * moment), false, law}};
  }
  std::vector<SpaceLoad> r;
  const Vec3<double> none = Vec3<double>::zero();
  for (const bool is_force : {true, false}) {
    const Vec3<double>& given = is_force ? force : moment;
    if (lanes::dot(given, given) == 0.0) continue;
    for (int row = 0; row < 3; ++row) {
      const Vec3<double> unit = Vec3<double>::unit(row);
      r.push_back({is_force ? lanes::join(unit, none) : lanes::join(none, unit), false, add_law({}, user)});
      plan.turned_laws.push_back({r.back().law, law, carrier->second, row, given});
    }
  }
  return r;
}

/// Velocity of a point of a frame at the start, in the ground: (linear; angular) in the ground's axes.
Vec6<double> Builder::frame_velocity(const std::string& frame, const Vec3<double>& at) const {
  const auto carrier = carrier_of.find(frame);
  if (carrier == carrier_of.end()) return Vec6<double>::zero();
  const CarrierMotion& m = start_motions.in_ground[static_cast<std::size_t>(carrier->second)];
  const Vec3<double> w = m.pose.R * lanes::angular_part(m.twist);
  return lanes::join(m.pose.R * lanes::linear_part(m.twist) + lanes::cross(w, Vec3<double>(at - m.pose.x)), w);
}

}  // namespace bough::plan
