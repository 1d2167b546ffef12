#pragma once
/// Forces of beams and line loads on their nodes, from BeamRates. Derivation: README.md, "Beam".
#include "bough/elements/screw_blend.hpp"

namespace bough::elements {

/// Section of a beam at a mass point: what its force f per length times `weight` is made of.
template <class S>
struct MassPoint {
  DualSeries<S> T;            ///< T(d)
  DualVec<S> z, rate, zz, v;  ///< blends of the nodes', and the twist
  DualVec<S> f;               ///< weight (m b - ad(v)^T m v)
  S weight;                   ///< of the point times the length
};

/// m b = m (a - (R^T g; 0)),  a = a_r + T z' + (D T(d)[d']) z.
template <class S, int N, class C>
void eval_mass_point(const Beam<N, C>& beam, const BeamRates<S, N>& b, bool moves, int point, MassPoint<S>& m) {
  const auto& rule = mass_rule<N>();
  const double* shape = rule.shape[point];
  m.weight = S(rule.weight[point] * beam.length);
  m.T = motion::dual_tangent(blend<S, N>(shape, b.d));
  m.zz = blend<S, N>(shape, b.zz);
  DualVec<S> a = b.b + times(m.T, m.zz);
  Vec6<S> momentum;
  if (moves) {
    m.z = blend<S, N>(shape, b.z);
    m.rate = blend<S, N>(shape, b.rate);
    m.v = b.v + times(m.T, m.z);
    a = a + slope_times(m.T, m.rate, m.z);
    momentum = beam.mass * motion::motion_vector(m.v);
  }
  DualVec<S> f = motion::wrench_dual(Vec6<S>(beam.mass * motion::motion_vector(a)));
  if (moves) f = add_cross(f, m.v, motion::wrench_dual(momentum));
  m.f = motion::scaled(m.weight, f);
}

/// Section at a strain point: strain, its derivative A = d(T d')/dd and the stress resultant n.
template <class S>
struct StrainPoint {
  DualSeries<S> T;
  DualVec<S> d1, y1;   ///< rates of d and of its slope
  DualVec<S> y;        ///< dd/ds
  DualMat<S> bending;  ///< A
  DualVec<S> n;
};

/// n = C (e - e0) + D e',  e = T(d) d' / L.
template <class S, int N, class C>
void eval_strain_point(const Beam<N, C>& beam, const BeamRates<S, N>& b, bool viscous, int point, StrainPoint<S>& s) {
  const auto& rule = strain_rule<N>();
  const double *shape = rule.shape[point], *slope = rule.slope[point];
  const C inverse = 1.0 / beam.length;
  s.T = motion::dual_tangent(blend<S, N>(shape, b.d));
  s.y = blend<S, N>(slope, b.d);
  s.bending = jacobian(s.T, s.y);
  Vec6<S> e = inverse * motion::motion_vector(times(s.T, s.y));
  for (int k = 0; k < 6; ++k) e[k] = e[k] - beam.reference_strain[point][k];
  Vec6<S> n = beam.stiffness * e;
  if (viscous) {
    s.d1 = blend<S, N>(shape, b.rate);
    s.y1 = blend<S, N>(slope, b.rate);
    n += beam.damping * (inverse * motion::motion_vector(times(s.T, s.y1) + times(s.bending, s.d1)));
  }
  s.n = motion::wrench_dual(n);
}

/// Elastic and viscous forces conjugate to d_i:  p_i = w (N_i' T^T n + N_i A^T n).
template <class S, int N, class C>
void eval_internal_forces(const Beam<N, C>& beam, const BeamRates<S, N>& b, bool viscous, DualVec<S>* p) {
  constexpr int r = Beam<N>::reference;
  if constexpr (N == 2) {  // d' is parallel to d, and T(d) d = d
    const C inverse = 1.0 / beam.length;
    Vec6<S> e = inverse * motion::motion_vector(b.d[1]);
    for (int k = 0; k < 6; ++k) e[k] = e[k] - beam.reference_strain[0][k];
    Vec6<S> n = beam.stiffness * e;
    if (viscous) n += beam.damping * (inverse * motion::motion_vector(b.rate[1]));
    p[1] = motion::wrench_dual(n);
  } else {
    const auto& rule = strain_rule<N>();
    for (int i = 0; i < N; ++i) p[i] = DualVec<S>::zero();
    for (int g = 0; g < Beam<N>::num_strain_points; ++g) {
      StrainPoint<S> s;
      eval_strain_point<S, N>(beam, b, viscous, g, s);
      const DualVec<S> by_slope = transpose_times(s.T, s.n), by_shape = transpose_times(s.bending, s.n);
      for (int i = 0; i < N; ++i)
        if (i != r)
          p[i] = add_scaled(add_scaled(p[i], rule.weight[g] * rule.slope[g][i], by_slope),
                            rule.weight[g] * rule.shape[g][i], by_shape);
    }
  }
}

/// Wrenches on the nodes in the ports' own axes:  F_i = T(d_i)^-T p_i (+ direct, if given),  F_r = sum - sum_i F_i, where `sum` is what all
/// nodes bear together.
template <class S, int N>
void eval_nodal_wrenches(const BeamRates<S, N>& b, const DualVec<S>* p, DualVec<S> sum, S* out,
                         const DualVec<S>* direct = nullptr) {
  constexpr int r = Beam<N>::reference;
  const auto put = [out](int node, const DualVec<S>& f) {
    for (int k = 0; k < 3; ++k) {
      out[6 * node + k] = f.a[k];
      out[6 * node + 3 + k] = f.b[k];
    }
  };
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    DualVec<S> f = transpose_times(b.inverse[i], p[i]);
    if (direct != nullptr) f = f + *direct;
    put(i, f);
    sum = sum - f;
  }
  put(r, sum);
}

/// Wrenches of elasticity, damping, inertia and gravity on the nodes, in the ports' own axes.
template <class S, int N, class C>
void eval_residual(const Beam<N, C>& beam, const PortMotion<S>* ports, const S*, const Surroundings<S>& around,
                   S* out) {
  constexpr int r = Beam<N>::reference;
  BeamRates<S, N> b;
  eval_beam_rates<S, N>(ports, around, beam.has_mass, beam.has_damping, b);
  DualVec<S> p[N], sum = DualVec<S>::zero();
  eval_internal_forces<S, N>(beam, b, around.has_inertia && beam.has_damping, p);
  for (int i = 0; i < N; ++i)
    if (i != r) sum = add_cross(sum, p[i], b.d[i]);  // ad(d_i)^T p_i = F_i - Ad(H_ri^-1)^T F_i
  if constexpr (N == 2) {
    if (beam.has_mass) {
      const ScrewBlend<S> f = eval_screw_blend(b.d[1]);
      GaussPair<S> g;
      eval_gauss_forces(point_mass(beam), f, b, around.has_inertia, g);
      const DualVec<S> direct = eval_gauss_wrench(f, g);
      return eval_nodal_wrenches<S, N>(b, p, sum + g.sum, out, &direct);
    }
  } else if (beam.has_mass) {
    for (int g = 0; g < Beam<N>::num_mass_points; ++g) {
      MassPoint<S> m;
      eval_mass_point<S, N>(beam, b, around.has_inertia, g, m);
      const DualVec<S> q = transpose_times(m.T, m.f);
      for (int i = 0; i < N; ++i)
        if (i != r) p[i] = add_scaled(p[i], mass_rule<N>().shape[g][i], q);
      sum = sum + m.f;
    }
  }
  eval_nodal_wrenches<S, N>(b, p, sum, out);
}

/// Load per reference length on a beam, integrated with the beam's own interpolation (same ports as the beam).
template <int N, class C = double>
struct LineLoad {
  static constexpr int num_ports = N;
  static constexpr int num_multipliers = 0;
  PortOf<C> ports[N];
  C length = 0.0;
  Vec6<C> wrench;        ///< (force [N/m]; moment [N]) per reference length, times the law
  bool follows = false;  ///< true: in section axes; false: in inertial axes
  int law = 0;
};

/// The load at a mass point, times its weight, in section axes.
template <class S, int N, class C>
DualVec<S> eval_load(const LineLoad<N, C>& load, const PortMotion<S>& r, const DualSeries<S>& T,
                     const Surroundings<S>& around, int point) {
  const S factor = -mass_rule<N>().weight[point] * load.length * around.laws[load.law];
  Vec3<S> force, moment;
  for (int k = 0; k < 3; ++k) {
    force[k] = factor * load.wrench[k];
    moment[k] = factor * load.wrench[3 + k];
  }
  if (load.follows) return {force, moment};
  const Mat3<S> R = r.H.R * motion::exp_so3(T.psi.a);
  return {lanes::transpose_times(R, force), lanes::transpose_times(R, moment)};
}

template <class S, int N, class C>
void eval_residual(const LineLoad<N, C>& load, const PortMotion<S>* ports, const S*, const Surroundings<S>& around,
                   S* out) {
  constexpr int r = Beam<N>::reference;
  BeamRates<S, N> b;
  eval_relative_motions<S, N>(ports, b);
  DualVec<S> p[N], sum = DualVec<S>::zero();
  for (int i = 0; i < N; ++i) p[i] = DualVec<S>::zero();
  for (int g = 0; g < N; ++g) {
    const double* shape = mass_rule<N>().shape[g];
    const DualSeries<S> T = motion::dual_tangent(blend<S, N>(shape, b.d));
    const DualVec<S> f = eval_load(load, ports[r], T, around, g), q = transpose_times(T, f);
    for (int i = 0; i < N; ++i)
      if (i != r) p[i] = add_scaled(p[i], shape[i], q);
    sum = sum + f;
  }
  eval_nodal_wrenches<S, N>(b, p, sum, out);
}

}  // namespace bough::elements
