#pragma once
/// Forces of the two-node beam. With one relative motion d all operators on a section are functions of D = ad(d)
/// alone, so (7) of beams.md becomes (8), an interpolation of the nodes' own motions by P(s)
/// (motion/screw_blend.hpp):
///   v(s) = v_r + P (v_1 - v_r),   F_1 = T^-T n + sum_g w_g P^T f,   F_r + F_1 = ad(d)^T n + sum_g w_g f.
/// D is applied to each vector once, and polynomials of D are evaluated by Horner's rule.
#include "bough/elements/beam_rates.hpp"
#include "bough/motion/screw_blend.hpp"

namespace bough::elements {

using motion::ScrewBlend;

/// Relative motion d of the nodes and its rates. Members that the analysis does not need are left unset.
template <class G, class S>
struct ScrewRates {
  InverseTangent<G, S> inverse;                     ///< at d
  typename G::template Motion<S> v, w, b, c, rate;  ///< v_r, v_1 - v_r, b_r, b_1 - b_r, d'
  typename G::template Bracket<S> w1;               ///< D w
};
template <class G, class S>
BOUGH_INLINE void eval_screw_rates(const PortMotionOn<G, S>* p, const SurroundingsOn<G, S>& around, bool has_mass,
                                   bool moves, ScrewRates<G, S>& r) {
  r.inverse = motion::eval_log<G, S>(G::relative(p[0].H, p[1].H));
  const auto& d = r.inverse.d;
  if (moves) {
    r.v = G::motion(p[0].v);
    r.w = G::motion(p[1].v) - r.v;
    r.w1 = G::bracket(d, r.w);
    // T^-1 w + ad(d) v
    r.rate = G::add_bracket(G::add_bracket(G::add(r.w, 0.5, r.w1), d, G::times(r.inverse.q, r.w1)), d, r.v);
  }
  if (!has_mass) return;
  r.b = eval_weighed_acceleration(p[0], around);
  r.c = eval_weighed_acceleration(p[1], around) - r.b;
}

/// Wrenches F_b = T(d)^-T n and F_a = ad(d)^T n - F_b of a coupling with the force n conjugate to d; returns F_b.
template <class G, class S>
BOUGH_INLINE typename G::template Wrench<S> put_screw_wrenches(const ScrewRates<G, S>& r,
                                                               const typename G::template Wrench<S>& n, S* out) {
  const auto sum = G::dual_bracket(r.inverse.d, n);
  const auto second = G::add_dual_bracket(G::add(n, 0.5, sum), r.inverse.d, G::times(r.inverse.q, sum));
  G::put(second, out + G::dof);
  G::put(sum - second, out);
  return second;
}

/// Motion and forces at the two Gauss points; forces times their weight L/2.
template <class G, class S>
struct GaussPair {
  typename G::template Motion<S> v[2];
  typename G::template Wrench<S> sum, difference;  ///< of the forces; second point less first
};
/// Forces m b - ad(v)^T m v. mass: per length, times L/2.
template <class G, class S, class C>
BOUGH_INLINE void eval_gauss_forces(const typename G::template Matrix<C>& mass, const ScrewBlend<G, S>& f,
                                    const ScrewRates<G, S>& r, bool moves, GaussPair<G, S>& g) {
  constexpr double t = motion::gauss_offset;
  const auto& d = r.inverse.d;
  auto a1 = G::bracket(d, r.c);
  auto odd = G::add(r.b, 0.5, r.c), even = G::scaled(t, r.c);
  auto inner = a1;
  if (moves) {
    a1 = G::add_bracket(a1, r.rate, r.w);
    const auto s = G::twice(G::pairing(d, r.rate));
    odd = G::add(odd, s * f.dp, r.w1);
    even = G::add_bracket(even, r.rate, G::times(f.q, r.w1));
    inner = G::add(G::times(f.q, a1), s * f.dq, r.w1);
    const auto odd_v = G::add(G::add(r.v, 0.5, r.w), f.p, r.w1);
    const auto even_v = G::add_bracket(G::scaled(t, r.w), d, G::times(f.q, r.w1));
    g.v[0] = odd_v - even_v;
    g.v[1] = odd_v + even_v;
  } else {
    inner = G::times(f.q, a1);
  }
  odd = G::add(odd, f.p, a1);
  even = G::add_bracket(even, d, inner);
  auto first = G::matrix_times(mass, odd - even), second = G::matrix_times(mass, odd + even);
  if (moves) {
    first = G::subtract_dual_bracket(first, g.v[0], G::matrix_times(mass, g.v[0]));
    second = G::subtract_dual_bracket(second, g.v[1], G::matrix_times(mass, g.v[1]));
  }
  g.sum = first + second;
  g.difference = second - first;
}

/// Stress-free strain e0 and 1/L of an element that resists the relative motion d by n = K (d/L - e0) + D d'/L.
template <class G, class C>
BOUGH_INLINE const typename G::template Vector<C>& rest_of(const BeamOn<G, 2, C>& beam) {
  return beam.reference_strain[0];
}
template <class G, class C>
BOUGH_INLINE C inverse_length(const BeamOn<G, 2, C>& beam) {
  return 1.0 / beam.length;
}
/// The force n conjugate to d.
template <class G, class S, class C>
BOUGH_INLINE typename G::template Wrench<S> eval_screw_resultant(const BeamOn<G, 2, C>& e, const ScrewRates<G, S>& r,
                                                                 bool viscous) {
  const auto inverse = inverse_length(e);
  auto n = G::matrix_times(e.stiffness, G::strain(inverse, r.inverse.d, rest_of(e)));
  if (viscous) n = G::add(n, inverse, G::matrix_times(e.damping, r.rate));
  return n;
}

template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const BeamOn<G, 2, C>& beam, const PortMotionOn<G, S>* p,
                                const SurroundingsOn<G, S>& around, S* out) {
  const bool viscous = around.has_inertia && beam.has_damping,
             moves = around.has_inertia && (beam.has_mass || beam.has_damping);
  ScrewRates<G, S> r;
  eval_screw_rates<G, S>(p, around, beam.has_mass, moves, r);
  const auto& d = r.inverse.d;
  const auto n = eval_screw_resultant<G, S>(beam, r, viscous);
  auto sum = G::dual_bracket(d, n);
  auto inner = G::times(r.inverse.q, sum), first = G::add(n, 0.5, sum);
  if (beam.has_mass) {
    const ScrewBlend<G, S> f = motion::eval_screw_blend<G, S>(d);
    GaussPair<G, S> g;
    eval_gauss_forces<G, S, C>(C(0.5 * beam.length) * beam.mass, f, r, around.has_inertia, g);
    inner = G::add(G::add_dual_bracket(inner, d, G::times(f.q, g.difference)), f.p, g.sum);
    first = G::add(G::add(first, 0.5, g.sum), motion::gauss_offset, g.difference);
    sum = sum + g.sum;
  }
  first = G::add_dual_bracket(first, d, inner);
  G::put(first, out + G::dof);
  G::put(sum - first, out);
}

}  // namespace bough::elements
