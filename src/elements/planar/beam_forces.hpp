#pragma once
/// Forces of planar beams and line loads: README.md, "Beam", where the kernels of planar/kernels.hpp do the same for all other elements.
#include "bough/elements/planar/kernels.hpp"

namespace bough::elements::planar {

template <class S, int N>
Vec3<S> blend(const double* w, const Vec3<S>* x) {
  constexpr int r = elements::Beam<N>::reference, first = r == 0 ? 1 : 0;
  Vec3<S> sum = w[first] * x[first];
  for (int i = first + 1; i < N; ++i)
    if (i != r) sum += w[i] * x[i];
  return sum;
}

/// Motions of the nodes relative to the reference node, README.md (1) and (7).
template <class S, int N>
struct BeamRates {
  PlaneLog<S> log[N];
  Vec3<S> d[N], z[N], rate[N], zz[N];  ///< d_i, z_i, d_i', z_i'
  Vec3<S> v, b;                        ///< of the reference node: twist; acceleration less its weight
};

template <class S, int N>
void eval_logs(const PortMotion<S>* p, BeamRates<S, N>& b) {
  constexpr int r = elements::Beam<N>::reference;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const Relative<S> H = relative(p[r], p[i]);
    b.log[i] = PlaneLog<S>(H.turn, H.x);
    b.d[i] = b.log[i].d;
  }
}

/// Whether rates enter a beam's forces at all.
template <int N, class S, class C>
bool has_rates(const Beam<N, C>& e, const Surroundings<S>& around) {
  return around.has_inertia && (e.has_mass || e.has_damping);
}

template <class S, int N, class C>
void eval_beam_rates(const Beam<N, C>& e, const PortMotion<S>* p, const Surroundings<S>& around, BeamRates<S, N>& b) {
  constexpr int r = elements::Beam<N>::reference;
  const bool moves = has_rates(e, around);
  eval_logs(p, b);
  b.v = p[r].v;
  if (moves)
    for (int i = 0; i < N; ++i) {
      if (i == r) continue;
      b.z[i] = b.log[i].inverse_times(p[i].v - b.v);
      b.rate[i] = b.z[i] + motion::plane_bracket(b.d[i], b.v);
    }
  if (!e.has_mass) return;
  b.b = weighed_acceleration(p[r], around);
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    b.zz[i] = b.log[i].inverse_times(weighed_acceleration(p[i], around) - b.b);
    if (moves) b.zz[i] += b.log[i].inverse_slope_times(b.rate[i], p[i].v - b.v);
  }
}

/// At a point of integration of strains: n = C (T y / L - e0) + D (T y / L)', with y = d'(s).
template <class S>
struct StrainPoint {
  PlaneMotion<S> T;
  Vec3<S> y, d1, y1, n;  ///< y; rates of d and of y; sectional force
};
template <class S, int N, class C>
void eval_strain_point(const Beam<N, C>& e, const BeamRates<S, N>& b, bool viscous, const ShapeRule<N, N - 1>& rule,
                       int g, StrainPoint<S>& s) {
  const C inverse = 1.0 / e.length;
  s.T = PlaneMotion<S>(blend<S, N>(rule.shape[g], b.d));
  s.y = blend<S, N>(rule.slope[g], b.d);
  Vec3<S> strain = inverse * s.T.times(s.y);
  for (int k = 0; k < 3; ++k) strain[k] = strain[k] - e.reference_strain[g][k];
  s.n = e.stiffness * strain;
  if (!viscous) return;
  s.d1 = blend<S, N>(rule.shape[g], b.rate);
  s.y1 = blend<S, N>(rule.slope[g], b.rate);
  s.n += e.damping * Vec3<S>(inverse * (s.T.times(s.y1) + s.T.slope_times(s.d1, s.y)));
}

/// Elasticity and damping: forces conjugate to d_i.
template <class S, int N, class C>
void eval_internal_forces(const Beam<N, C>& e, const BeamRates<S, N>& b, bool viscous, Vec3<S>* p) {
  if constexpr (N == 2) {
    const C inverse = 1.0 / e.length;
    Vec3<S> strain = inverse * b.d[1];
    for (int k = 0; k < 3; ++k) strain[k] = strain[k] - e.reference_strain[0][k];
    p[1] = e.stiffness * strain;
    if (viscous) p[1] += e.damping * Vec3<S>(inverse * b.rate[1]);
  } else {
    constexpr int r = elements::Beam<N>::reference;
    const auto& rule = strain_rule<N>();
    for (int i = 0; i < N; ++i) p[i] = Vec3<S>::zero();
    for (int g = 0; g < N - 1; ++g) {
      StrainPoint<S> s;
      eval_strain_point(e, b, viscous, rule, g, s);
      const Vec3<S> by_slope = s.T.transpose_times(s.n), by_shape = s.T.slope_transpose_times(s.y, s.n);
      for (int i = 0; i < N; ++i)
        if (i != r)
          p[i] += (rule.weight[g] * rule.slope[g][i]) * by_slope + (rule.weight[g] * rule.shape[g][i]) * by_shape;
    }
  }
}

/// Force of inertia and gravity at a point of integration, its weight included.
template <class S>
struct MassPoint {
  PlaneMotion<S> T;
  Vec3<S> z, rate, zz, v, f;
};
template <class S, int N, class C>
void eval_mass_point(const Beam<N, C>& e, const BeamRates<S, N>& b, bool moves, const ShapeRule<N, N>& rule, int g,
                     MassPoint<S>& m) {
  const double* shape = rule.shape[g];
  m.T = PlaneMotion<S>(blend<S, N>(shape, b.d));
  m.zz = blend<S, N>(shape, b.zz);
  Vec3<S> a = b.b + m.T.times(m.zz);
  if (moves) {
    m.z = blend<S, N>(shape, b.z);
    m.rate = blend<S, N>(shape, b.rate);
    m.v = b.v + m.T.times(m.z);
    a += m.T.slope_times(m.rate, m.z);
    m.f = e.mass * a + gyroscopic(m.v, Vec3<S>(e.mass * m.v));
  } else {
    m.f = e.mass * a;
  }
  const C weight = rule.weight[g] * e.length;
  m.f = weight * m.f;
}

/// F_i = T(d_i)^-T p_i,  F_r = sum - sum_i F_i.
template <class S, int N>
void eval_nodal_wrenches(const BeamRates<S, N>& b, const Vec3<S>* p, Vec3<S> sum, Vec3<S>* out) {
  constexpr int r = elements::Beam<N>::reference;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    out[i] = b.log[i].inverse_transpose_times(p[i]);
    sum -= out[i];
  }
  out[r] = sum;
}

/// What the nodes bear together of forces conjugate to d_i: sum_i ad(d_i)^T p_i.
template <class S, int N>
Vec3<S> sum_of(const BeamRates<S, N>& b, const Vec3<S>* p) {
  constexpr int r = elements::Beam<N>::reference;
  Vec3<S> sum = Vec3<S>::zero();
  for (int i = 0; i < N; ++i)
    if (i != r) sum += motion::plane_bracket_transpose(b.d[i], p[i]);
  return sum;
}
/// Adds a point's force to them.
template <class S, int N>
void add_mass_point(const double* shape, const MassPoint<S>& m, Vec3<S>* p, Vec3<S>& sum) {
  const Vec3<S> q = m.T.transpose_times(m.f);
  for (int i = 0; i < N; ++i)
    if (i != elements::Beam<N>::reference) p[i] += shape[i] * q;
  sum += m.f;
}

template <class S, int N, class C>
void eval_residual(const Beam<N, C>& e, const PortMotion<S>* port, const Surroundings<S>& around, Vec3<S>* out) {
  BeamRates<S, N> b;
  Vec3<S> p[N];
  eval_beam_rates(e, port, around, b);
  eval_internal_forces(e, b, around.has_inertia && e.has_damping, p);
  Vec3<S> sum = sum_of(b, p);
  if (!e.has_mass) return eval_nodal_wrenches(b, p, sum, out);
  const ShapeRule<N, N>& rule = mass_rule<N>();  // a call, which empties the registers: once
  for (int g = 0; g < N; ++g) {
    MassPoint<S> m;
    eval_mass_point(e, b, has_rates(e, around), rule, g, m);
    add_mass_point<S, N>(rule.shape[g], m, p, sum);
  }
  eval_nodal_wrenches(b, p, sum, out);
}

template <class S, int N, class C>
void eval_residual(const LineLoad<N, C>& e, const PortMotion<S>* port, const Surroundings<S>& around, Vec3<S>* out) {
  constexpr int r = elements::Beam<N>::reference;
  BeamRates<S, N> b;
  Vec3<S> p[N], sum = Vec3<S>::zero();
  eval_logs(port, b);
  for (int i = 0; i < N; ++i) p[i] = Vec3<S>::zero();
  const ShapeRule<N, N>& rule = mass_rule<N>();
  for (int g = 0; g < N; ++g) {
    const double* shape = rule.shape[g];
    const PlaneMotion<S> T(blend<S, N>(shape, b.d));
    const Base<S> factor = -(rule.weight[g] * e.length * around.laws[e.law]);
    Vec3<S> f;
    for (int k = 0; k < 3; ++k) f[k] = S(factor * e.wrench[k]);
    if (!e.follows) {
      const S x = T.theta * T.theta;
      const lanes::Vec<S, 8> c = motion::eval_stumpff(x);
      const Vec2<S> turn = complex_times(port[r].turn, Vec2<S>{{c[0], T.theta * c[1]}});
      f = join(conjugate_times(turn, plane_part(f)), f[2]);
    }
    const Vec3<S> q = T.transpose_times(f);
    for (int i = 0; i < N; ++i)
      if (i != r) p[i] += shape[i] * q;
    sum += f;
  }
  eval_nodal_wrenches(b, p, sum, out);
}

}  // namespace bough::elements::planar
