#pragma once
/// Ports as the inertial frame sees them, and wrenches carried there. Internal to elements.
#include "evaluate_impl.hpp"

namespace bough::elements {

/// Wrench (port axes) at a port as (force; moment about the inertial origin) in inertial axes.
template <class S>
Vec6<S> to_inertial(const PortMotion<S>& p, const Vec3<S>& anchor, const Vec6<S>& wrench) {
  const Vec3<S> force = p.H.R * lanes::linear_part(wrench);
  const Vec3<S> moment = p.H.R * lanes::angular_part(wrench) + lanes::cross(Vec3<S>(p.H.x + anchor), force);
  return lanes::join(force, moment);
}

/// Motions of the ports as seen from the inertial frame, in the axes of the frame in which nodes are described.
/// `anchor` is what positions are relative to, counted from the inertial origin.
template <class E, class S>
void eval_ports_from_inertial(const E& e, const FieldOf<S>& field, PortMotion<S>* p, Vec3<S>& anchor) {
  const motion::PositionPair<S> a = anchor_of(e, field.nodes);
  for (int k = 0; k < E::num_ports; ++k) p[k] = eval_port(e.ports[k], field.nodes, a, field.carriers);
  anchor = a.hi + a.lo;
  if (field.observer == nullptr) return;
  const CarrierMotionOf<S>& o = *field.observer;
  for (int k = 0; k < E::num_ports; ++k) add_observer_motion(p[k], anchor, o.twist, o.twist_rate);
  anchor += lanes::transpose_times(o.pose.R, o.pose.x);
}

}  // namespace bough::elements
