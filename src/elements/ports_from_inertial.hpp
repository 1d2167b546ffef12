#pragma once
/// Ports as the inertial frame sees them, and wrenches carried there. Internal to elements.
#include "evaluate_impl.hpp"

namespace bough::elements {

/// A wrench in the axes at H as (force; moment about the inertial origin) in inertial axes; momenta likewise.
template <class S>
Vec6<S> to_origin(const Frame<S>& H, const Vec3<S>& anchor, const Vec6<S>& wrench) {
  const Vec3<S> force = H.R * lanes::linear_part(wrench);
  const Vec3<S> moment = H.R * lanes::angular_part(wrench) + lanes::cross(Vec3<S>(H.x + anchor), force);
  return lanes::join(force, moment);
}
template <class S>
Vec3<S> to_origin(const motion::PlanePose<S>& H, const motion::Vec2<S>& anchor, const Vec3<S>& wrench) {
  const motion::Vec2<S> force = motion::Se2::turned(H, motion::Vec2<S>{{wrench[0], wrench[1]}}), x = H.x + anchor;
  return {{force[0], force[1], wrench[2] + (x[0] * force[1] - x[1] * force[0])}};
}
template <class S, int N>
const lanes::Vec<S, N>& to_origin(const motion::Place<S, N>&, const lanes::Vec<S, N>&, const lanes::Vec<S, N>& force) {
  return force;
}

/// Motions of the ports as seen from the inertial frame, in the axes of the frame in which nodes are described.
/// `anchor` is what positions are relative to, counted from the inertial origin.
template <class E, class G, class S>
void eval_ports_from_inertial(const E& e, const FieldOn<G, S>& field, PortMotionOn<G, S>* p,
                              typename G::template Translation<S>& anchor) {
  const motion::PositionPair<S, G::translations> a = anchor_of(e, field.nodes);
  for (int k = 0; k < E::num_ports; ++k) p[k] = eval_port(e.ports[k], field.nodes, a, field.carriers);
  anchor = a.hi + a.lo;
  if constexpr (G::has_moving_frames) {
    if (field.observer == nullptr) return;
    const CarrierMotionOf<S>& o = *field.observer;
    for (int k = 0; k < E::num_ports; ++k) add_observer_motion(p[k], anchor, o.twist, o.twist_rate);
    anchor += lanes::transpose_times(o.pose.R, o.pose.x);
  }
}

}  // namespace bough::elements
