#pragma once
/// Spring and damper about an axis, with a moment that may harden.
#include "bough/elements/coupling.hpp"
#include "bough/elements/screw_beam.hpp"

namespace bough::elements {

/// With the rotation vector psi of the second frame as seen from the first, which are equal at the start, and the axis
/// n:  angle = n . psi,  moment on the second = -(k angle + k3 angle^3 + c angle') n, carried by T(psi)^-T. The strain
/// energy is k/2 angle^2 + k3/4 angle^4. Angles reach half a turn; they are not counted beyond.
template <class G, class C = double>
struct TorsionSpringOn : CouplingOn<G, C> {
  AxisOn<G, C> axis = AxisOn<G, C>::zero();
  C stiffness = 0.0, hardening = 0.0, damping = 0.0;

  static constexpr scene::CouplingStart start = scene::CouplingStart::axes;
  static constexpr CouplingWords words{
      "torsion_springs", "torsion_spring",
      "Spring and damper about an axis: k a + k3 a^3 + c a', with the angle a from the start, up to half a turn.",
      "One side, which carries the axis.", "The other side."};
  static constexpr auto declared() {
    return std::tuple{elements::axis("axis", &TorsionSpringOn::axis, "", "Axis of the rotation."),
                      strength("stiffness", &TorsionSpringOn::stiffness, "N m/rad", "k."),
                      strength("hardening", &TorsionSpringOn::hardening, "N m/rad^3", "k3."),
                      strength("damping", &TorsionSpringOn::damping, "N m s/rad", "c.")};
  }
};
template <class G, class C>
inline constexpr bool exists<TorsionSpringOn<G, C>> = G::turns;

template <class G, class C>
bool looks_at_rates(const TorsionSpringOn<G, C>& e) {
  return is_present(e.damping);
}

template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const TorsionSpringOn<G, C>& e, const PortMotionOn<G, S>* p,
                                const SurroundingsOn<G, S>& around, S* out) {
  const bool viscous = around.has_inertia && is_present(e.damping);
  ScrewRates<G, S> r;
  eval_screw_rates<G, S>(p, around, false, viscous, r);
  using Vector = typename G::template Vector<S>;
  const S angle = angle_about(e.axis, Vector(G::vector_of_motion(r.inverse.d)));
  S moment = angle * (S(e.stiffness) + e.hardening * (angle * angle));
  if (viscous) moment = moment + e.damping * angle_about(e.axis, Vector(G::vector_of_motion(r.rate)));
  put_screw_wrenches<G, S>(r, G::wrench(moment_about<G, S, C>(e.axis, moment)), out);
}

template <class G, class S, class C>
S eval_strain_energy(const TorsionSpringOn<G, C>& e, const PortMotionOn<G, S>* p) {
  const auto inverse = motion::eval_log<G, S>(G::relative(p[0].H, p[1].H));
  const S angle = angle_about(e.axis, typename G::template Vector<S>(G::vector_of_motion(inverse.d)));
  const S square = angle * angle;
  return square * (S(0.5 * e.stiffness) + (0.25 * e.hardening) * square);
}

}  // namespace bough::elements
