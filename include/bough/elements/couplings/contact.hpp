#pragma once
/// Contact of a sphere with a plane, without friction.
#include "bough/elements/coupling.hpp"

namespace bough::elements {

/// With n the normal of the plane, r from its origin to the centre of the sphere, and d = radius - n . r the depth:
///   force on the sphere  F n,  F = k d^(3/2) max(0, 1 + (3/2) a d') where d > 0, and 0 elsewhere,
/// with a dissipation a [s/m] that leaves the restitution 1 - a v at slow impacts of speed v. The strain energy is
/// (2/5) k d^(5/2). The force acts along the line of F n through the centre on both. Source: K. H. Hunt, F. R. E.
/// Crossley, Coefficient of restitution interpreted as damping in vibroimpact, J. Appl. Mech. 42 (1975) 440-445.
template <class G, class C = double>
struct ContactOn : CouplingOn<G, C> {
  typename G::template Translation<C> normal = G::template Translation<C>::zero();
  C radius = 0.0, stiffness = 0.0, dissipation = 0.0;

  static constexpr bool pulls_at_point = true;
  static constexpr CouplingWords words{
      "contacts", "contact",
      "Contact of a sphere with a plane, without friction: k d^1.5 (1 + 1.5 a d') at the depth d, never pulling.",
      "The side of the plane, at a point of it.", "The side of the sphere, at its centre."};
  static constexpr auto declared() {
    return std::tuple{direction("normal", &ContactOn::normal, "", "Normal of the plane, towards the sphere."),
                      number("radius", &ContactOn::radius, "m", 0.0, false, "0", "Radius of the sphere."),
                      number("stiffness", &ContactOn::stiffness, "N/m^1.5", 0.0, true, "", "k, as of Hertz."),
                      number("dissipation", &ContactOn::dissipation, "s/m", 0.0, false, "0",
                             "a of Hunt and Crossley: slow impacts at the speed v leave the restitution 1 - a v.")};
  }
};

template <class G, class C>
bool looks_at_rates(const ContactOn<G, C>& e) {
  return is_present(e.dissipation);
}

/// Where the parts are, and the force. n: the normal, r: from the plane's origin to the centre; in inertial axes.
template <class G, class S>
struct ContactForce {
  typename G::template Translation<S> n, r;
  S depth;  ///< 1 where they are apart
  S force;
};
template <class G, class S, class C>
BOUGH_INLINE ContactForce<G, S> eval_contact(const ContactOn<G, C>& e, const PortMotionOn<G, S>* p, bool damps) {
  using lanes::less, lanes::select, std::sqrt;
  using Translation = typename G::template Translation<S>;
  ContactForce<G, S> c;
  const auto normal = lanes::cast<S>(e.normal);
  c.n = G::turned(p[0].H, normal);
  c.r = p[1].H.x - p[0].H.x;
  const S depth = S(e.radius) - lanes::dot(c.n, c.r);
  const auto touches = less(S(0.0), depth);
  c.depth = select(touches, depth, S(1.0));
  c.force = e.stiffness * (c.depth * sqrt(c.depth));
  if (damps) {
    const Translation w = G::turned(p[1].H, G::linear(p[1].v)) - G::turned(p[0].H, G::linear(p[0].v));
    const Translation turning = G::turned(p[0].H, G::spin(p[0].v, normal));  // n'
    const S rate = -(lanes::dot(c.n, w) + lanes::dot(turning, c.r));
    const S factor = S(1.0) + (1.5 * e.dissipation) * rate;
    c.force = c.force * select(less(S(0.0), factor), factor, S(0.0));
  }
  c.force = select(touches, c.force, S(0.0));
  return c;
}

template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const ContactOn<G, C>& e, const PortMotionOn<G, S>* p,
                                const SurroundingsOn<G, S>& around, S* out) {
  const auto c = eval_contact<G, S, C>(e, p, around.has_inertia && is_present(e.dissipation));
  put_point_force<G, S>(p, c.r, typename G::template Translation<S>(c.force * c.n), out);
}

template <class G, class S, class C>
S eval_strain_energy(const ContactOn<G, C>& e, const PortMotionOn<G, S>* p) {
  using lanes::less, lanes::select;
  const auto c = eval_contact<G, S, C>(e, p, false);
  return 0.4 * c.force * select(less(S(0.0), c.force), c.depth, S(0.0));
}

}  // namespace bough::elements
