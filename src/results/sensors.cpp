/// Sensors: how each kind is evaluated, in one table.
#include <algorithm>
#include <optional>

#include "bough/motion/frame_chain.hpp"
#include "bough/results/interface_force.hpp"
#include "bough/scene/sensor_kinds.hpp"
#include "observe_parts.hpp"

namespace bough::results {

using elements::CarrierMotion;
using elements::Field;
using motion::Frame;
using motion::Vec3;
using motion::Vec6;
using plan::SensorPlan;

namespace {

/// Motion of b relative to a, both given in the same third frame:
///   H = H_a^-1 H_b,  v = v_b - c,  v' = v_b' - Ad(H^-1) v_a' + ad(v) c,  c = Ad(H^-1) v_a.
PointMotion seen_from(const PointMotion& a, const PointMotion& b) {
  PointMotion r;
  r.pose = motion::relative(a.pose, b.pose);
  const Vec6<double> carried = motion::inverse_adjoint_times(r.pose, a.v);
  r.v = b.v - carried;
  r.a = b.a - motion::inverse_adjoint_times(r.pose, a.a) + motion::cross6_times(r.v, carried);
  return r;
}

/// The same motion in the inertial frame.
PointMotion in_inertial(const Field& field, const PointMotion& p) {
  if (field.observer == nullptr) return p;
  const CarrierMotion& o = *field.observer;
  elements::PortMotion<double> r{p.pose, p.v, p.a};
  elements::add_observer_motion(r, Vec3<double>::zero(), o.twist, o.twist_rate);
  return {motion::compose(o.pose, p.pose), r.v, r.a};
}

/// Acceleration of the origin in own axes: v' + w x v, angular acceleration.
Vec6<double> acceleration_of(const PointMotion& p) {
  const Vec3<double> w = lanes::angular_part(p.v);
  return lanes::join(lanes::linear_part(p.a) + lanes::cross(w, lanes::linear_part(p.v)), lanes::angular_part(p.a));
}

/// A state that sensors look at; one pass over the elements serves all sensors of energies.
struct Look {
  const step::System& system;
  const step::State& state;
  EnergyMeter* meter;  ///< nullptr: no energies are wanted
  Field field = system.instant().field(state);
  std::optional<Energies> measured = {};

  const Energies& energies() {
    if (!measured) measured = meter->eval(system, state);
    return *measured;
  }
  /// Motion of the sensor's point relative to the sensor's frame.
  PointMotion point(const SensorPlan& s) const {
    const PointMotion p = motion_at(system, state, s);
    return s.sensor.frame.empty() ? p : seen_from(motion_of_port(s.frame, field), p);
  }
  double turns(const SensorPlan& s) const { return state.turns[static_cast<std::size_t>(s.joint)]; }
  /// The joint in space.
  const elements::Joint& joint(const SensorPlan& s) const {
    const plan::Plan& plan = system.plan();
    const auto id = static_cast<std::size_t>(plan.joints[static_cast<std::size_t>(s.joint)].element);
    return plan::array_of<elements::Joint>(plan.elements)[static_cast<std::size_t>(plan.directory[id].index)];
  }
  elements::CoordinateMotion coordinate(const SensorPlan& s) const {
    return elements::eval_joint_coordinate(joint(s), s.coordinate, field, turns(s));
  }
};

using Values = std::vector<double>;

void append_quaternion(const Frame<double>& pose, Values& to) {
  const auto q = motion::quaternion_of(pose.R);
  to.push_back(q.w);
  append(to, q.v);
}

void append_reaction(const Look& look, const SensorPlan& s, Values& to) {
  const plan::JointPlan& joint = look.system.plan().joints[static_cast<std::size_t>(s.joint)];
  const elements::Joint& e = look.joint(s);
  const Vec6<double> wrench =
      elements::eval_reaction(e, look.field, look.state.multipliers.data() + joint.multiplier_begin, look.turns(s));
  const motion::Mat3<double> R = motion_of_port(e.ports[1], look.field).pose.R;
  append(to, s.sensor.frame.empty()
                 ? resolve(R, wrench, s.sensor.axes)
                 : turned(lanes::transpose_times(motion_of_port(s.frame, look.field).pose.R, R), wrench));
}

/// Of one node about the sensor's point, or the resultant.
void append_interface_force(const Look& look, const SensorPlan& s, Values& to) {
  const std::vector<InterfaceForce> forces = eval_interface_forces(
      look.system, look.state, look.field, subdomain_at(look.system.linear().tree(), s.subdomain));
  const bool is_whole = s.sensor.at.to.empty();
  Vec6<double> wrench = is_whole ? resultant_of(forces, look.field) : Vec6<double>::zero();
  const Frame<double> at = is_whole ? Frame<double>::identity() : motion_of_port(s.port, look.field).pose;
  for (const InterfaceForce& f : forces) {
    if (is_whole || f.node != s.port.node) continue;
    const auto& x = look.field.nodes[f.node].x;
    const Vec3<double> force = lanes::linear_part(f.wrench);
    wrench = lanes::join(
        force, Vec3<double>(lanes::angular_part(f.wrench) + lanes::cross(Vec3<double>(x.hi + x.lo - at.x), force)));
  }
  const motion::Mat3<double> seen = s.sensor.axes == scene::LoadAxes::body ? at.R
                                    : s.sensor.frame.empty()               ? motion::Mat3<double>::identity()
                                                                           : motion_of_port(s.frame, look.field).pose.R;
  append(to, turned(lanes::transpose(seen), wrench));
}

/// What acts on the second along a coordinate of a joint.
double effort_of(const Look& look, const SensorPlan& s) {
  const plan::EffortPlan& read = s.effort;
  const elements::CoordinateMotion along = look.coordinate(s);
  const double rate = look.field.around.has_inertia ? along.rate : 0.0;
  double sum = read.elastic.stiffness * (along.value - read.elastic.rest) + read.elastic.damping * rate;
  for (const int law : read.laws) sum += look.field.around.laws[law];
  if (read.row < 0) return sum;
  const plan::JointPlan& joint = look.system.plan().joints[static_cast<std::size_t>(s.joint)];
  return sum - look.state.multipliers[static_cast<std::size_t>(joint.multiplier_begin + read.row)];
}

/// Parts of the inertial acceleration along the sensor's chain of frames, then their sum; 3 components each.
void append_split(const Look& look, const SensorPlan& s, Values& to) {
  using motion::FrameMotion;
  std::vector<FrameMotion> links;
  PointMotion last{Frame<double>::identity(), Vec6<double>::zero(), Vec6<double>::zero()};
  for (const elements::Port& port : s.chain) {
    const PointMotion next = in_inertial(look.field, motion_of_port(port, look.field));
    const PointMotion link = seen_from(last, next);
    links.push_back(motion::motion_from_twist(link.pose, link.v, link.a));
    last = next;
  }
  const PointMotion p = seen_from(last, in_inertial(look.field, motion_at(look.system, look.state, s)));
  const FrameMotion m = motion::motion_from_twist(p.pose, p.v, p.a);
  const motion::FrameChain chain(std::move(links));
  const motion::PointMotion watched{chain.last(), m.pose.x, m.velocity, m.acceleration};
  const motion::AccelerationParts parts = motion::acceleration_split(chain, watched, motion::From(0), motion::In(0));
  // Inertial components are transformed to the requested axes.
  const motion::Mat3<double> R = in_inertial(look.field, motion_of_port(s.frame, look.field)).pose.R;
  for (const motion::Resolved& part :
       {parts.local, parts.tangential, parts.coriolis, parts.centripetal, parts.razi, parts.origin, parts.total()})
    append(to, lanes::transpose_times(R, part.components(motion::In(0))));
}

struct Kernel {
  scene::SensorKind kind;
  void (*append)(Look&, const SensorPlan&, Values&);
};
using enum scene::SensorKind;
/// In the order of SensorKind.
constexpr Kernel kernels[] = {
    {position, [](Look& l, const SensorPlan& s, Values& to) { append(to, l.point(s).pose.x); }},
    {rotation, [](Look& l, const SensorPlan& s, Values& to) { append(to, motion::log_so3(l.point(s).pose.R)); }},
    {quaternion, [](Look& l, const SensorPlan& s, Values& to) { append_quaternion(l.point(s).pose, to); }},
    {velocity,
     [](Look& l, const SensorPlan& s, Values& to) {
       const PointMotion p = l.point(s);
       append(to, resolve(p.pose.R, p.v, s.sensor.axes));
     }},
    {acceleration,
     [](Look& l, const SensorPlan& s, Values& to) {
       const PointMotion p = l.point(s);
       append(to, resolve(p.pose.R, acceleration_of(p), s.sensor.axes));
     }},
    {section_force,
     [](Look& l, const SensorPlan& s, Values& to) { append(to, section_force_at(l.system, l.state, s)); }},
    {section_strain,
     [](Look& l, const SensorPlan& s, Values& to) { append(to, section_strain_at(l.system, l.state, s)); }},
    {joint_reaction, [](Look& l, const SensorPlan& s, Values& to) { append_reaction(l, s, to); }},
    {joint_angle, [](Look& l, const SensorPlan& s, Values& to) { to.push_back(l.coordinate(s).value); }},
    {joint_displacement, [](Look& l, const SensorPlan& s, Values& to) { to.push_back(l.coordinate(s).value); }},
    {joint_rate, [](Look& l, const SensorPlan& s, Values& to) { to.push_back(l.coordinate(s).rate); }},
    {kinetic_energy, [](Look& l, const SensorPlan&, Values& to) { to.push_back(l.energies().kinetic); }},
    {strain_energy, [](Look& l, const SensorPlan&, Values& to) { to.push_back(l.energies().strain); }},
    {potential_energy, [](Look& l, const SensorPlan&, Values& to) { to.push_back(l.energies().potential); }},
    {total_energy,
     [](Look& l, const SensorPlan&, Values& to) {
       to.push_back(l.energies().kinetic + l.energies().strain + l.energies().potential);
     }},
    {acceleration_split, [](Look& l, const SensorPlan& s, Values& to) { append_split(l, s, to); }},
    {relative_position, [](Look& l, const SensorPlan& s, Values& to) { append(to, l.point(s).pose.x); }},
    {signal, [](Look& l, const SensorPlan& s, Values& to) { to.push_back(l.field.around.laws[s.signal]); }},
    {interface_force, [](Look& l, const SensorPlan& s, Values& to) { append_interface_force(l, s, to); }},
    {scene::SensorKind::force,
     [](Look& l, const SensorPlan& s, Values& to) {
       const PartForce force = eval_part_force(l.system, l.state, l.field, s.elements);
       const motion::Mat3<double> seen = s.sensor.axes == scene::LoadAxes::body ? force.axes
                                         : s.sensor.frame.empty()               ? motion::Mat3<double>::identity()
                                                                  : motion_of_port(s.frame, l.field).pose.R;
       append(to, turned(lanes::transpose(seen), force.wrench));
     }},
    {joint_effort, [](Look& l, const SensorPlan& s, Values& to) { to.push_back(effort_of(l, s)); }},
    {section_force_extremes,
     [](Look& l, const SensorPlan& s, Values& to) {
       const SectionExtremes e = section_extremes(l.system, l.state, s);
       to.insert(to.end(), {e.least, e.largest, e.least_at, e.largest_at});
     }},
};
constexpr bool is_in_order() {
  for (std::size_t k = 0; k < std::size(kernels); ++k)
    if (kernels[k].kind != static_cast<scene::SensorKind>(k)) return false;
  return true;
}
static_assert(is_in_order());

void append_values(Look& look, const SensorPlan& s, Values& to) {
  kernels[static_cast<std::size_t>(s.sensor.kind)].append(look, s, to);
}

}  // namespace

PointMotion motion_of_port(const elements::Port& port, const Field& field) {
  const elements::PortMotion<double> p =
      elements::eval_port(port, field.nodes, motion::Vec3Pair::from(Vec3<double>::zero()), field.carriers);
  return {p.H, p.v, p.a};
}

void eval_sensors(const step::System& system, const step::State& state, EnergyMeter& meter, Values& values) {
  values.clear();
  Look look{system, state, &meter};
  for (const SensorPlan& s : system.plan().sensors) append_values(look, s, values);
}

void eval_sensors(const step::System& system, const step::State& state, EnergyMeter& meter,
                  std::span<const int> sensors, Values& values) {
  values.clear();
  Look look{system, state, &meter};
  for (const int k : sensors) append_values(look, system.plan().sensors[static_cast<std::size_t>(k)], values);
}

MotionSensors::MotionSensors(const plan::Plan& plan) {
  for (const SensorPlan& s : plan.sensors)
    if (shows_motion(s.sensor.kind)) append_nodes_of(plan, s, nodes_);
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  seen_.emplace<motion::Se3>().motion.resize(plan.nodes.size());
}

elements::NodeMotion& MotionSensors::motion(int node) {
  return seen_.change<motion::Se3>().motion[static_cast<std::size_t>(node)];
}

void MotionSensors::see(const plan::Plan& plan, const step::State& state) {
  seen_.time = state.time;
  seen_.turns = state.turns;
  seen_.signals.value = state.signals.value;
  step::copy_nodes_in_space(plan, state, nodes_, seen_.change<motion::Se3>().motion);
}

void MotionSensors::eval(const step::System& system, Values& values) const {
  values.clear();
  Look look{system, seen_, nullptr};
  for (const SensorPlan& s : system.plan().sensors)
    if (shows_motion(s.sensor.kind))
      append_values(look, s, values);
    else
      values.resize(values.size() + s.components.size());
}

bool shows_motion(scene::SensorKind kind) {
  const scene::SensorShows shows = scene::type_of(kind).shows;
  return shows == scene::SensorShows::pose || shows == scene::SensorShows::rate;
}

void append_nodes_of(const plan::Plan& plan, const plan::SensorPlan& sensor, std::vector<int>& nodes) {
  const auto add = [&nodes](const elements::Port& port) {
    if (port.node != elements::ground) nodes.push_back(port.node);
  };
  const auto add_element = [&](int id) {
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(id)], [&](const auto& e) {
      for (const elements::Port& port : e.ports) add(port);
    });
  };
  if (sensor.beam >= 0) {
    const plan::BeamPlan& beam = plan.beams[static_cast<std::size_t>(sensor.beam)];
    add_element(beam.elements[static_cast<std::size_t>(locate(beam, sensor.sensor.station).first)]);
  } else if (sensor.joint >= 0) {
    add_element(plan.joints[static_cast<std::size_t>(sensor.joint)].element);
  } else {
    add(sensor.port);
  }
  for (const int id : sensor.elements) add_element(id);
  add(sensor.frame);
}

}  // namespace bough::results
