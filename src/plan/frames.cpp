#include "bough/plan/frames.hpp"

#include <algorithm>

#include "bough/scene/frames.hpp"
#include "bough/scene/poses.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::CarrierMotion;
using elements::Port;
using motion::Frame;
using motion::Mat3;
using motion::Vec3;
using motion::Vec6;

namespace {

using Series = lanes::Taylor<double, 3>;

/// Pose and twist (own axes) as series in time.
struct Course {
  Frame<Series> pose;
  Vec6<Series> twist;
};

Course still() {
  Course c{motion::cast<Series>(Frame<double>::identity()), Vec6<Series>::zero()};
  return c;
}

Series derivative(const Series& x) {
  Series r(0.0);
  for (int k = 0; k < 3; ++k) r.c[k] = (k + 1) * x.c[k + 1];
  return r;
}

/// Motion of a frame in its parent. The angular velocity in the frame's axes grows turn by turn: w <- exp(-angle ~axis) w + angle' axis.
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

bool is_identity(const Frame<double>& H) {
  const Frame<double> one = Frame<double>::identity();
  for (int i = 0; i < 9; ++i)
    if (H.R.m[i] != one.R.m[i]) return false;
  return H.x[0] == 0.0 && H.x[1] == 0.0 && H.x[2] == 0.0;
}

/// The way up to a root is as deep as frames are nested: two or three, so each frame goes it anew instead of keeping series.
Course course_of(const Plan& plan, int frame, int root, const Series* laws) {
  Course c = still();
  for (int i = frame; i != root && i >= 0; i = plan.frames[static_cast<std::size_t>(i)].parent)
    c = compose(in_parent(plan.frames[static_cast<std::size_t>(i)], laws), c);
  return c;
}

}  // namespace

void eval_frames(const Plan& plan, const lanes::Taylor<double, 3>* laws, FrameMotions& motions) {
  motions.in_ground.resize(plan.frames.size());
  const Course observer = plan.observer < 0 ? still() : course_of(plan, plan.observer, -1, laws);
  motions.observer = motion_of(observer);
  for (std::size_t f = 0; f < plan.frames.size(); ++f) {
    const int i = static_cast<int>(f);
    if (i == plan.observer)
      motions.in_ground[f] = CarrierMotion{};
    else if (plan.observer < 0 || plan.frames[f].in_observer)
      motions.in_ground[f] = motion_of(course_of(plan, i, plan.observer, laws));
    else
      motions.in_ground[f] = motion_of(relative(observer, course_of(plan, i, -1, laws)));
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

/// Frames in the order parents, children. Nothing where no frame moves: then all are places in the ground.
void Builder::add_frames() {
  const auto find = [this](const std::string& name) { return poses.frame(name); };
  const bool any_moves = std::any_of(scene.frames.begin(), scene.frames.end(),
                                     [](const scene::FrameDef& f) { return f.motion.has_value(); });
  for (const scene::FrameDef& f : scene.frames)
    frame_start[f.name] = poses.of(std::string_view(f.name)).value_or(f.placement.pose);
  if (!any_moves && scene.analysis.frame.empty()) return;
  std::vector<std::size_t> order;
  const std::vector<std::size_t> ground = scene::frames_above(scene, scene.analysis.frame, find);
  const auto append_way = [&](const std::string& name) {
    std::vector<std::size_t> way = scene::frames_above(scene, name, find);
    for (auto i = way.rbegin(); i != way.rend(); ++i)
      if (std::find(order.begin(), order.end(), *i) == order.end()) order.push_back(*i);
  };
  append_way(scene.analysis.frame);
  for (const scene::FrameDef& f : scene.frames) append_way(f.name);
  std::map<std::string, int> plan_index;
  for (const std::size_t i : order) {
    const scene::FrameDef& given = scene.frames[i];
    const bool above_ground = std::find(ground.begin(), ground.end(), i) != ground.end();
    FramePlan f;
    f.name = given.name;
    f.pose = given.placement.pose;
    const std::string& parent = given.placement.frame;
    f.parent = parent.empty() || parent == "ground" ? (above_ground ? -1 : plan.observer) : plan_index.at(parent);
    f.in_observer = !above_ground && plan.observer >= 0 &&
                    (f.parent == plan.observer || plan.frames[static_cast<std::size_t>(f.parent)].in_observer);
    const auto add = [&](const laws::Law& law) {
      const int id = add_law(law, given.name);
      plan.laws.back().at_start = above_ground && !plan.is_dynamic;
      return id;
    };
    if (given.motion) {
      f.pose.R = given.motion->rotation;
      for (int k = 0; k < 3; ++k)
        if (!given.motion->position[k].is_constant()) f.position[k] = add(given.motion->position[k]);
      for (const scene::Turn& t : given.motion->turns) f.turns.push_back({t.axis, add(t.angle)});
    }
    plan_index[given.name] = static_cast<int>(plan.frames.size());
    plan.frames.push_back(f);
    if (given.name == scene.analysis.frame) plan.observer = plan_index[given.name];
  }
  for (const auto& [name, index] : plan_index)
    if (poses.is_moving(name)) carrier_of[name] = index;
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
