#pragma once
/// Forces of beams of three and four nodes, and of line loads, on their nodes, from BeamRates. Derivation: beams.md,
/// "Beam".
#include "bough/elements/screw_beam.hpp"

namespace bough::elements {

/// Section at a mass point: the terms of its force f per length, times `weight`.
template <class G, class S>
struct MassPoint {
  Tangent<G, S> T;                             ///< T(d)
  typename G::template Motion<S> z, rate, zz;  ///< blends of the nodes'
  typename G::template Motion<S> v;            ///< twist
  typename G::template Wrench<S> f;            ///< weight (m b - ad(v)^T m v)
};

/// m b = m (a - (R^T g; 0)),  a = a_r + T z' + (D T(d)[d']) z.
template <class G, class S, int N, class C>
void eval_mass_point(const BeamOn<G, N, C>& beam, const BeamRates<G, S, N>& b, bool moves, const ShapeRule<N, N>& rule,
                     int point, MassPoint<G, S>& m) {
  const double* shape = rule.shape[point];
  const C weight = rule.weight[point] * beam.length;
  m.T = motion::eval_tangent_operator<G, S>(blend<G, S, N>(shape, b.d));
  m.zz = blend<G, S, N>(shape, b.zz);
  auto a = b.b + times(m.T, m.zz);
  if (moves) {
    m.z = blend<G, S, N>(shape, b.z);
    m.rate = blend<G, S, N>(shape, b.rate);
    m.v = b.v + times(m.T, m.z);
    a = G::add(a, 1.0, slope_times(m.T, m.rate, m.z));
    const auto f = G::subtract_dual_bracket(G::matrix_times(beam.mass, a), m.v, G::matrix_times(beam.mass, m.v));
    m.f = G::scaled(weight, f);
  } else {
    m.f = G::scaled(weight, G::matrix_times(beam.mass, a));
  }
}

/// Section at a strain point: strain, its derivative A = d(T d')/dd and the stress resultant n.
template <class G, class S>
struct StrainPoint {
  Tangent<G, S> T;
  typename G::template Motion<S> d1, y1;       ///< rates of d and of its slope
  typename G::template Motion<S> y;            ///< dd/ds
  typename G::template BracketMap<S> bending;  ///< A
  typename G::template Wrench<S> n;
};

/// n = C (e - e0) + D e',  e = T(d) d' / L.
template <class G, class S, int N, class C>
void eval_strain_point(const BeamOn<G, N, C>& beam, const BeamRates<G, S, N>& b, bool viscous,
                       const ShapeRule<N, N - 1>& rule, int point, StrainPoint<G, S>& s) {
  const double *shape = rule.shape[point], *slope = rule.slope[point];
  const C inverse = 1.0 / beam.length;
  s.T = motion::eval_tangent_operator<G, S>(blend<G, S, N>(shape, b.d));
  s.y = blend<G, S, N>(slope, b.d);
  s.bending = jacobian(s.T, s.y);
  s.n = G::matrix_times(beam.stiffness, G::strain(inverse, times(s.T, s.y), beam.reference_strain[point]));
  if (!viscous) return;
  s.d1 = blend<G, S, N>(shape, b.rate);
  s.y1 = blend<G, S, N>(slope, b.rate);
  const auto rate = G::add(times(s.T, s.y1), 1.0, G::times(s.bending, s.d1));
  s.n = G::add(s.n, inverse, G::matrix_times(beam.damping, rate));
}

/// Elastic and viscous forces conjugate to d_i:  p_i = w (N_i' T^T n + N_i A^T n).
template <class G, class S, int N, class C>
void eval_internal_forces(const BeamOn<G, N, C>& beam, const BeamRates<G, S, N>& b, bool viscous,
                          typename G::template Wrench<S>* p) {
  constexpr int r = beam_reference<N>;
  if constexpr (N == 2) {  // d' is parallel to d, and T(d) d = d
    const C inverse = 1.0 / beam.length;
    p[1] = G::matrix_times(beam.stiffness, G::strain(inverse, b.d[1], beam.reference_strain[0]));
    if (viscous) p[1] = G::add(p[1], inverse, G::matrix_times(beam.damping, b.rate[1]));
  } else {
    const auto& rule = strain_rule<N>();
    for (int i = 0; i < N; ++i) p[i] = G::wrench(G::template Vector<S>::zero());
    for (int g = 0; g < N - 1; ++g) {
      StrainPoint<G, S> s;
      eval_strain_point<G, S, N, C>(beam, b, viscous, rule, g, s);
      const auto by_slope = transpose_times(s.T, s.n), by_shape = G::transpose_times(s.bending, s.n);
      for (int i = 0; i < N; ++i) {
        if (i == r) continue;
        p[i] = G::add(p[i], rule.weight[g] * rule.slope[g][i], by_slope);
        p[i] = G::add(p[i], rule.weight[g] * rule.shape[g][i], by_shape);
      }
    }
  }
}

/// Sum over all nodes of the wrenches that follow from forces conjugate to d_i: sum_i ad(d_i)^T p_i, since ad(d_i)^T
/// p_i = F_i - Ad(H_ri^-1)^T F_i.
template <class G, class S, int N>
typename G::template Wrench<S> sum_relative_forces(const BeamRates<G, S, N>& b,
                                                   const typename G::template Wrench<S>* p) {
  constexpr int r = beam_reference<N>, first = r == 0 ? 1 : 0;
  auto sum = G::dual_bracket(b.d[first], p[first]);
  for (int i = first + 1; i < N; ++i)
    if (i != r) sum = G::add_dual_bracket(sum, b.d[i], p[i]);
  return sum;
}

/// Wrenches on the nodes in the ports' own axes: F_i = T(d_i)^-T p_i, F_r = sum - sum_i F_i, where `sum` is the total
/// over all nodes.
template <class G, class S, int N>
void eval_nodal_wrenches(const BeamRates<G, S, N>& b, const typename G::template Wrench<S>* p,
                         typename G::template Wrench<S> sum, S* out) {
  constexpr int r = beam_reference<N>;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const auto f = transpose_times(b.inverse[i], p[i]);
    G::put(f, out + G::dof * i);
    sum = sum - f;
  }
  G::put(sum, out + G::dof * r);
}

/// Adds a mass point's force to those conjugate to d_i and to their sum.
template <class G, class S, int N>
void add_mass_forces(const double* shape, const MassPoint<G, S>& m, typename G::template Wrench<S>* p,
                     typename G::template Wrench<S>& sum) {
  const auto q = transpose_times(m.T, m.f);
  for (int i = 0; i < N; ++i)
    if (i != beam_reference<N>) p[i] = G::add(p[i], shape[i], q);
  sum = sum + m.f;
}

/// Wrenches of elasticity, damping, inertia and gravity on the nodes, in the ports' own axes.
template <class G, class S, int N, class C>
requires(N > 2) void eval_residual(const BeamOn<G, N, C>& beam, const PortMotionOn<G, S>* ports,
                                   const SurroundingsOn<G, S>& around, S* out) {
  BeamRates<G, S, N> b;
  eval_beam_rates<G, S, N>(ports, around, beam.has_mass, beam.has_damping, b);
  typename G::template Wrench<S> p[N];
  eval_internal_forces<G, S, N, C>(beam, b, around.has_inertia && beam.has_damping, p);
  auto sum = sum_relative_forces<G, S, N>(b, p);
  if (beam.has_mass) {
    const auto& rule = mass_rule<N>();  // one call outside the loop: a call spills the vector registers
    for (int g = 0; g < N; ++g) {
      MassPoint<G, S> m;
      eval_mass_point<G, S, N, C>(beam, b, around.has_inertia, rule, g, m);
      add_mass_forces<G, S, N>(rule.shape[g], m, p, sum);
    }
  }
  eval_nodal_wrenches<G, S, N>(b, p, sum, out);
}

/// Load per reference length on a beam, integrated with the beam's own interpolation (same ports as the beam).
template <class G, int N, class C = double>
struct LineLoadOn {
  using Group = G;
  static constexpr int num_ports = N;
  static constexpr int num_multipliers = 0;
  PortOn<G, C> ports[N];
  C length = 0.0;
  typename G::template Vector<C> wrench;  ///< (force [N/m]; moment [N]) per reference length, times the law
  bool follows = false;                   ///< true: in section axes; false: in inertial axes
  int law = 0;

  static constexpr Role role = Role::load;
  static constexpr Cost cost{200e-9 * N, 800e-9 * N, 30e-9 * N, 250e-9 * N};
  static constexpr bool has_stiffness_matrix = false, acts_along_line = false;
  static constexpr DataAxes data_axes = DataAxes::section;
  template <class A, class B, class Visit>
  static void visit_data(A& a, B& b, Visit& visit) {
    visit.flag(a.follows, b.follows);
    visit.number(a.length, b.length);
    visit.wrench(a.wrench, b.wrench, a.follows);
    visit.law(a.law, b.law);
  }
};
template <class G, int N, class C>
inline constexpr bool exists<LineLoadOn<G, N, C>> = G::turns;
template <int N, class C = double>
using LineLoad = LineLoadOn<motion::Se3, N, C>;

template <class G, int N, class C>
bool looks_at_rates(const LineLoadOn<G, N, C>&) {
  return false;
}

/// The load at a mass point, times its weight, in section axes.
template <class G, class S, int N, class C>
typename G::template Wrench<S> eval_load(const LineLoadOn<G, N, C>& load, const PortMotionOn<G, S>& r,
                                         const Tangent<G, S>& T, const SurroundingsOn<G, S>& around,
                                         const ShapeRule<N, N>& rule, int point) {
  const Constant<S> factor = -(rule.weight[point] * load.length * around.laws[load.law]);
  typename G::template Vector<S> f;
  for (int k = 0; k < G::dof; ++k) f[k] = S(factor * load.wrench[k]);
  if (load.follows) return G::wrench(f);
  return G::turned_back(r.H, T.d, f);
}

template <class G, class S, int N, class C>
void eval_residual(const LineLoadOn<G, N, C>& load, const PortMotionOn<G, S>* ports, const SurroundingsOn<G, S>& around,
                   S* out) {
  constexpr int r = beam_reference<N>;
  BeamRates<G, S, N> b;
  eval_relative_motions<G, S, N>(ports, b);
  const auto zero = G::wrench(G::template Vector<S>::zero());
  typename G::template Wrench<S> p[N], sum = zero;
  for (int i = 0; i < N; ++i) p[i] = zero;
  const auto& rule = mass_rule<N>();
  for (int g = 0; g < N; ++g) {
    const auto T = motion::eval_tangent_operator<G, S>(blend<G, S, N>(rule.shape[g], b.d));
    const auto f = eval_load<G, S, N, C>(load, ports[r], T, around, rule, g);
    const auto q = transpose_times(T, f);
    for (int i = 0; i < N; ++i)
      if (i != r) p[i] = G::add(p[i], rule.shape[g][i], q);
    sum = sum + f;
  }
  eval_nodal_wrenches<G, S, N>(b, p, sum, out);
}

}  // namespace bough::elements
