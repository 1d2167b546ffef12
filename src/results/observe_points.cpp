#include "bough/motion/frame_chain.hpp"
#include "observe_parts.hpp"

namespace bough::results {

using elements::CarrierMotion;
using elements::Field;
using motion::Frame;
using motion::Vec3;
using motion::Vec6;

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

}  // namespace

PointMotion motion_of_port(const elements::Port& port, const Field& field) {
  const elements::PortMotion<double> p =
      elements::eval_port(port, field.nodes, motion::Vec3Pair::from(Vec3<double>::zero()), field.carriers);
  return {p.H, p.v, p.a};
}

void append_point(const plan::SensorPlan& s, const Field& field, const PointMotion& point,
                  std::vector<double>& values) {
  const PointMotion p = s.sensor.frame.empty() ? point : seen_from(motion_of_port(s.frame, field), point);
  switch (s.sensor.kind) {
    case scene::SensorKind::position:
      append(values, p.pose.x);
      break;
    case scene::SensorKind::rotation:
      append(values, motion::log_so3(p.pose.R));
      break;
    case scene::SensorKind::quaternion: {
      const auto q = motion::quaternion_of(p.pose.R);
      values.push_back(q.w);
      append(values, q.v);
      break;
    }
    case scene::SensorKind::velocity:
      append(values, resolve(p.pose.R, p.v, s.sensor.axes));
      break;
    default:
      append(values, resolve(p.pose.R, acceleration_of(p), s.sensor.axes));
  }
}

void append_split(const plan::SensorPlan& s, const Field& field, const PointMotion& point,
                  std::vector<double>& values) {
  using motion::FrameMotion;
  std::vector<FrameMotion> links;
  PointMotion last{Frame<double>::identity(), Vec6<double>::zero(), Vec6<double>::zero()};
  for (const elements::Port& port : s.chain) {
    const PointMotion next = in_inertial(field, motion_of_port(port, field));
    const PointMotion link = seen_from(last, next);
    links.push_back(motion::motion_from_twist(link.pose, link.v, link.a));
    last = next;
  }
  const PointMotion p = seen_from(last, in_inertial(field, point));
  const FrameMotion m = motion::motion_from_twist(p.pose, p.v, p.a);
  const motion::FrameChain chain(std::move(links));
  const motion::PointMotion watched{chain.last(), m.pose.x, m.velocity, m.acceleration};
  const motion::AccelerationParts parts = motion::acceleration_split(chain, watched, motion::From(0), motion::In(0));
  // Inertial components are transformed to the requested axes.
  const motion::Mat3<double> R = in_inertial(field, motion_of_port(s.frame, field)).pose.R;
  for (const motion::Resolved& part :
       {parts.local, parts.tangential, parts.coriolis, parts.centripetal, parts.razi, parts.origin, parts.total()})
    append(values, lanes::transpose_times(R, part.components(motion::In(0))));
}

bool shows_motion(scene::SensorKind kind) {
  switch (kind) {
    case scene::SensorKind::position:
    case scene::SensorKind::rotation:
    case scene::SensorKind::quaternion:
    case scene::SensorKind::velocity:
    case scene::SensorKind::joint_angle:
    case scene::SensorKind::joint_displacement:
    case scene::SensorKind::joint_rate:
      return true;
    default:
      return false;
  }
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
  add(sensor.frame);
}

}  // namespace bough::results
