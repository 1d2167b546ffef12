#pragma once
/// Spring and damper along the line between two points.
#include "bough/elements/coupling.hpp"

namespace bough::elements {

/// With the length l of the line between the two ports:  tension = k (l - l0) + c l'. The strain energy is
/// k/2 (l - l0)^2.
template <class G, class C = double>
struct SpringOn : CouplingOn<G, C> {
  C stiffness = 0.0, rest_length = 0.0, damping = 0.0;

  static constexpr DataAxes data_axes = DataAxes::none;
  static constexpr bool pulls_at_point = true, acts_along_line = true, has_closed_tangent = true;
  static constexpr CouplingWords words{
      "springs", "spring", "Spring and damper along the line between two points: the tension k (l - l0) + c l'.",
      "One end.", "The other end."};
  static constexpr auto declared() {
    return std::tuple{strength("stiffness", &SpringOn::stiffness, "N/m", "k."),
                      distance("rest_length", &SpringOn::rest_length, "l0, the length without tension."),
                      strength("damping", &SpringOn::damping, "N s/m", "c.")};
  }
};
using Spring = SpringOn<motion::Se3>;

template <class G, class C>
bool looks_at_rates(const SpringOn<G, C>& e) {
  return is_present(e.damping);
}

/// Kinematics and force of a spring: the unit vector n = (x_b - x_a) / l in inertial axes, the force along it, and the
/// derivative of the force by the length.
template <class G, class S>
struct SpringLine {
  typename G::template Translation<S> n;
  typename G::template Translation<S> w;  ///< relative velocity of the points; set if the spring has a damper
  S inverse;                              ///< 1/l
  S along;                                ///< l' = n . w; set if the spring has a damper
  S tension;
};
template <class G, class S, class C>
BOUGH_INLINE SpringLine<G, S> eval_spring_line(const SpringOn<G, C>& spring, const PortMotionOn<G, S>* p, bool damps) {
  SpringLine<G, S> line;
  const typename G::template Translation<S> r = p[1].H.x - p[0].H.x;
  const S length = lanes::length_of(r);
  line.inverse = S(1.0) / length;
  line.n = line.inverse * r;
  line.tension = spring.stiffness * (length - spring.rest_length);
  if (damps) {
    line.w = G::turned(p[1].H, G::linear(p[1].v)) - G::turned(p[0].H, G::linear(p[0].v));
    line.along = lanes::dot(line.n, line.w);
    line.tension = line.tension + spring.damping * line.along;
  }
  return line;
}

template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const SpringOn<G, C>& spring, const PortMotionOn<G, S>* p,
                                const SurroundingsOn<G, S>& around, S* out) {
  const auto line = eval_spring_line<G, S, C>(spring, p, around.has_inertia && is_present(spring.damping));
  const typename G::template Translation<S> f = line.tension * line.n;
  G::put_force(G::turned_back(p[0].H, -f), out);
  G::put_force(G::turned_back(p[1].H, f), out + G::dof);
}

template <class G, class S, class C>
S eval_strain_energy(const SpringOn<G, C>& spring, const PortMotionOn<G, S>* p) {
  const typename G::template Translation<S> r = p[1].H.x - p[0].H.x;
  const S stretch = lanes::length_of(r) - spring.rest_length;
  return 0.5 * spring.stiffness * stretch * stretch;
}

/// Force t n on the second port in inertial axes, t = k (l - l0) + c n . w:
///   d(t n) = (t/l) (1 - n n^T) dr + n dt,   dt = (k n + (c/l) (w - n n . w)) . dr + c n . dw,
///   dr = R_b eta_b - R_a eta_a (linear parts),   dw = R_b (dv_b + theta_b x v_b) - R_a (dv_a + theta_a x v_a).
/// So the block of ports k and q is, but for the sign, (t/l) R_k^T R_q + (R_k^T n) (what R_q^T (gradient - (t/l) n)
/// and the damping do)^T.
template <class G, class S, class C, class Put>
BOUGH_INLINE void eval_tangent(const SpringOn<G, C>& spring, const PortMotionOn<G, S>* p,
                               const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                               const Put& put) {
  using Vector = typename G::template Translation<S>;
  using Wrench = typename G::template Wrench<S>;
  const bool damps = around.has_inertia && is_present(spring.damping), moves = ports[0].moves;
  const auto line = eval_spring_line<G, S, C>(spring, p, damps);
  const Vector f = line.tension * line.n;
  const Vector force[2] = {G::turned_back(p[0].H, -f), G::turned_back(p[1].H, f)};
  const S lateral = line.tension * line.inverse;
  Vector gradient = spring.stiffness * line.n - lateral * line.n;
  if (damps) gradient += (spring.damping * line.inverse) * (line.w - line.along * line.n);
  Vector along[2];  // n in the axes of either port
  Wrench by[2];     // dt and the lateral part, by the increment of either port
  for (int q = 0; q < 2; ++q) {
    along[q] = G::turned_back(p[q].H, line.n);
    by[q] = G::force(Vector::zero());
    if (moves) by[q] = G::force(G::turned_back(p[q].H, gradient));
    if (damps) {
      const Wrench pull = G::force(spring.damping * along[q]);
      by[q] = by[q] + G::transpose_times(ports[q].velocity, pull);
      if (moves) by[q] = G::subtract_dual_bracket(by[q], G::translation(G::linear(p[q].v)), pull);
    }
  }
  for (int k = 0; k < 2; ++k) {
    G::put_force(force[k], residual + G::dof * k);
    for (int q = 0; q < 2; ++q) {
      const double sign = k == q ? 1.0 : -1.0;
      auto block = G::template Matrix<S>::zero();
      G::add_force_outer(block, Vector(sign * along[k]), by[q]);
      if (moves) G::add_rotation(block, S(sign * lateral), p[k].H, p[q].H);
      if (moves && k == q) G::add_turning(block, G::force(force[k]));
      put(k, q, block);
    }
  }
}

}  // namespace bough::elements
