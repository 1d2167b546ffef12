#pragma once
/// Geometrically exact beam of N nodes on a motion group: relative motions of the nodes are interpolated about a reference node,
///   H(s) = H_r exp(d(s)),  d(s) = sum_i N_i(s) d_i,  d_i = log(H_r^-1 H_i),
/// so strains are frame-invariant and path-independent, and a helix is represented exactly.
/// Sources: Sonneville, Cardona, Bruls 2014 (two nodes); Sonneville, Bruls, Bauchau 2017; Crisfield, Jelenic 1999 (invariance).
#include "bough/elements/port.hpp"
#include "bough/elements/quadrature.hpp"

namespace bough::elements {

/// Constant data of one element. Section matrices are 6x6 about the reference axis, order (N, Q2, Q3, T, M2, M3).
template <int N>
struct Beam {
  static constexpr int num_ports = N;
  static constexpr int num_multipliers = 0;
  static constexpr int reference =
      N / 2 == 1 ? (N == 3 ? 1 : 0) : 1;           ///< 2 nodes: the first; 3: the middle; 4: the second
  static constexpr int num_strain_points = N - 1;  ///< reduced: no locking
  static constexpr int num_mass_points = N;
  Port ports[N];
  double length = 0.0;                    ///< of the reference axis [m]
  Mat6<double> stiffness, damping, mass;  ///< see scene::Section
  bool has_damping = false, has_mass = false;
  Vec6<double>
      reference_strain[N - 1];  ///< (1 + axial, shear; curvature) of the stress-free shape at the strain points
};

/// Motions of the nodes relative to the reference node: the only positions that a beam looks at.
template <class S, int N>
struct BeamShape {
  Frame<S> relative[N];                  ///< H_r^-1 H_i
  Vec6<S> d[N];                          ///< their logarithms
  motion::MotionOperator<S> inverse[N];  ///< T(d_i)^-1
};

template <class S, int N>
BeamShape<S, N> eval_shape(const PortMotion<S>* p) {
  constexpr int r = Beam<N>::reference;
  BeamShape<S, N> b;
  for (int i = 0; i < N; ++i) {
    if (i == r) {
      b.relative[i] = Frame<S>::identity();
      b.d[i] = Vec6<S>::zero();
    } else {
      b.relative[i] = motion::relative(p[r].H, p[i].H);
      b.d[i] = motion::Se3::log(b.relative[i]);
      b.inverse[i] = motion::inverse_tangent_operator(b.d[i]);
    }
  }
  return b;
}

/// sum_i w_i d_i over the nodes other than the reference.
template <class S, int N>
Vec6<S> blend(const double* w, const Vec6<S>* d) {
  Vec6<S> r = Vec6<S>::zero();
  for (int i = 0; i < N; ++i)
    if (i != Beam<N>::reference) r += w[i] * d[i];
  return r;
}

/// Sectional strain at a strain point, (T(d) d') / L, axial component 1 when unstrained.
template <class S, int N>
Vec6<S> eval_strain(const BeamShape<S, N>& b, double length, int point) {
  if constexpr (N == 2) {
    return (1.0 / length) * b.d[1];  // d' is parallel to d, and T(d) d = d
  } else {
    const auto& rule = strain_rule<N>();
    return (1.0 / length) *
           motion::Se3::tangent_times(blend<S, N>(rule.shape[point], b.d), blend<S, N>(rule.slope[point], b.d));
  }
}

/// Forces conjugate to d_i carried to wrenches on the nodes, in the nodes' own axes:
///   F_i += T(d_i)^-T p_i,  F_r -= Ad(H_ri^-1)^T F_i.
template <class S, int N>
void add_nodal_wrenches(const BeamShape<S, N>& b, const Vec6<S>* p, Vec6<S>* wrench) {
  constexpr int r = Beam<N>::reference;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const Vec6<S> f = b.inverse[i].transpose_times(p[i]);
    wrench[i] += f;
    wrench[r] -= motion::inverse_adjoint_transpose_times(b.relative[i], f);
  }
}

/// Velocities of the relative motions: d_i' = T(d_i)^-1 (v_i - Ad(H_ri)^-1 v_r).
template <class S, int N>
void eval_shape_rates(const BeamShape<S, N>& b, const PortMotion<S>* p, Vec6<S>* rate) {
  constexpr int r = Beam<N>::reference;
  for (int i = 0; i < N; ++i)
    rate[i] =
        i == r ? Vec6<S>::zero() : b.inverse[i].times(p[i].v - motion::inverse_adjoint_times(b.relative[i], p[r].v));
}

/// Elastic and viscous forces conjugate to d_i:  n = C (e - e0) + D e',  p_i += w (N_i' T^T n + N_i A^T n),  A = d(T d')/dd.
template <class S, int N>
void add_internal_forces(const Beam<N>& beam, const BeamShape<S, N>& b, const Vec6<S>* rate, Vec6<S>* p) {
  if constexpr (N == 2) {
    Vec6<S> e = eval_strain<S, N>(b, beam.length, 0);
    for (int k = 0; k < 6; ++k) e[k] = e[k] - beam.reference_strain[0][k];
    Vec6<S> n = beam.stiffness * e;
    if (rate != nullptr && beam.has_damping) n += beam.damping * ((1.0 / beam.length) * rate[1]);
    p[1] += n;
  } else {
    const auto& rule = strain_rule<N>();
    for (int g = 0; g < Beam<N>::num_strain_points; ++g) {
      const Vec6<S> d = blend<S, N>(rule.shape[g], b.d);
      const Vec6<S> slope = blend<S, N>(rule.slope[g], b.d);
      const auto T = motion::tangent_operator(d);
      Vec6<S> e = (1.0 / beam.length) * T.times(slope);
      for (int k = 0; k < 6; ++k) e[k] = e[k] - beam.reference_strain[g][k];
      Vec6<S> n = beam.stiffness * e;
      const Mat6<S> bending = T.derivative(slope);
      if (rate != nullptr && beam.has_damping) {
        const Vec6<S> e_rate = T.times(blend<S, N>(rule.slope[g], rate)) + bending * blend<S, N>(rule.shape[g], rate);
        n += beam.damping * ((1.0 / beam.length) * e_rate);
      }
      const Vec6<S> by_slope = T.transpose_times(n);
      const Vec6<S> by_shape = lanes::transpose_times(bending, n);
      for (int i = 0; i < N; ++i)
        if (i != Beam<N>::reference)
          p[i] += (rule.weight[g] * rule.slope[g][i]) * by_slope + (rule.weight[g] * rule.shape[g][i]) * by_shape;
    }
  }
}

/// Motion of the section at parameter weights `shape`: pose relative to the reference node, twist, acceleration.
template <class S>
struct SectionMotion {
  Vec6<S> d;
  motion::MotionOperator<S> T;  ///< T(d)
  Frame<S> relative;            ///< exp(d)
  Vec6<S> v, a;
};

template <class S, int N>
SectionMotion<S> eval_section(const double* shape, const BeamShape<S, N>& b, const Vec6<S>* rate, const Vec6<S>* rate2,
                              const PortMotion<S>& r) {
  SectionMotion<S> m;
  m.d = blend<S, N>(shape, b.d);
  m.T = motion::tangent_operator(m.d);
  m.relative = motion::exp_se3(m.T);
  if (rate == nullptr) return m;
  const Vec6<S> d1 = blend<S, N>(shape, rate);
  const Vec6<S> carried = motion::inverse_adjoint_times(m.relative, r.v);
  const Vec6<S> own = m.T.times(d1);
  m.v = carried + own;
  if (rate2 != nullptr)
    m.a = motion::inverse_adjoint_times(m.relative, r.a) - motion::cross6_times(own, carried) +
          m.T.times(blend<S, N>(shape, rate2)) + m.T.slope_times(d1, d1);
  return m;
}

/// Second derivatives of the relative motions from those of the nodes.
template <class S, int N>
void eval_shape_accelerations(const BeamShape<S, N>& b, const PortMotion<S>* p, const Vec6<S>* rate, Vec6<S>* rate2) {
  constexpr int r = Beam<N>::reference;
  for (int i = 0; i < N; ++i) {
    if (i == r) {
      rate2[i] = Vec6<S>::zero();
      continue;
    }
    const Vec6<S> carried = motion::inverse_adjoint_times(b.relative[i], p[r].v);
    const Vec6<S> own = p[i].v - carried;
    rate2[i] = b.inverse[i].times(p[i].a - motion::inverse_adjoint_times(b.relative[i], p[r].a) +
                                  motion::cross6_times(own, carried) -
                                  motion::tangent_operator(b.d[i]).slope_times(rate[i], rate[i]));
  }
}

/// A wrench per unit of s at a section (section axes), spread to the reference node and to the forces conjugate to d_i:
/// virtual motion of the section = Ad(exp d)^-1 eta_r + T(d) delta d.
template <class S, int N>
void add_section_wrench(const double* shape, const SectionMotion<S>& m, const Vec6<S>& f, Vec6<S>* p, Vec6<S>* wrench) {
  const Vec6<S> q = m.T.transpose_times(f);
  for (int i = 0; i < N; ++i)
    if (i != Beam<N>::reference) p[i] += shape[i] * q;
  wrench[Beam<N>::reference] += motion::inverse_adjoint_transpose_times(m.relative, f);
}

/// Motion of the reference node seen by masses: gravity is an acceleration (-g; 0) of the whole frame,
///   a_r - (R_r^T g; 0), and none of the motion is looked at in statics.
template <class S>
PortMotion<S> add_gravity(const PortMotion<S>& r, const Surroundings<S>& around) {
  const Vec6<S> weight = lanes::join<S>(lanes::transpose_times(r.H.R, around.gravity), Vec3<S>::zero());
  if (around.has_inertia) return {r.H, r.v, r.a - weight};
  return {r.H, Vec6<S>::zero(), -weight};
}

/// Inertia with the consistent velocity field, and gravity:  f = m (a - R^T g) - ad(v)^T m v  per length, at the mass points.
/// rate == nullptr: statics.
template <class S, int N>
void add_inertia_forces(const Beam<N>& beam, const BeamShape<S, N>& b, const PortMotion<S>* ports, const Vec6<S>* rate,
                        const Vec6<S>* rate2, const Surroundings<S>& around, Vec6<S>* p, Vec6<S>* wrench) {
  const auto& rule = mass_rule<N>();
  const PortMotion<S> r = add_gravity(ports[Beam<N>::reference], around);
  for (int g = 0; g < Beam<N>::num_mass_points; ++g) {
    const SectionMotion<S> m = eval_section<S, N>(rule.shape[g], b, rate, rate2, r);
    Vec6<S> f = beam.mass * (rate != nullptr ? m.a : motion::inverse_adjoint_times(m.relative, r.a));
    if (rate != nullptr) f -= motion::cross6_transpose_times(m.v, Vec6<S>(beam.mass * m.v));
    add_section_wrench<S, N>(rule.shape[g], m, (rule.weight[g] * beam.length) * f, p, wrench);
  }
}

/// Everything that a beam's forces look at; rates only if it `moves`.
template <class S, int N>
void eval_beam_motion(const PortMotion<S>* ports, bool moves, BeamShape<S, N>& b, Vec6<S>* rate, Vec6<S>* rate2) {
  b = eval_shape<S, N>(ports);
  if (!moves) return;
  eval_shape_rates<S, N>(b, ports, rate);
  eval_shape_accelerations<S, N>(b, ports, rate, rate2);
}

/// Wrenches of elasticity, damping, inertia and gravity on the nodes, in the ports' own axes; rate == nullptr: statics.
template <class S, int N>
void eval_wrenches(const Beam<N>& beam, const PortMotion<S>* ports, const BeamShape<S, N>& b, const Vec6<S>* rate,
                   const Vec6<S>* rate2, const Surroundings<S>& around, S* out) {
  Vec6<S> p[N], wrench[N];
  for (int i = 0; i < N; ++i) p[i] = wrench[i] = Vec6<S>::zero();
  add_internal_forces<S, N>(beam, b, rate, p);
  if (beam.has_mass) add_inertia_forces<S, N>(beam, b, ports, rate, rate2, around, p, wrench);
  add_nodal_wrenches<S, N>(b, p, wrench);
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 6; ++k) out[6 * i + k] = wrench[i][k];
}

template <class S, int N>
void eval_residual(const Beam<N>& beam, const PortMotion<S>* ports, const S*, const Surroundings<S>& around, S* out) {
  BeamShape<S, N> b;
  Vec6<S> rate[N], rate2[N];
  eval_beam_motion<S, N>(ports, around.has_inertia, b, rate, rate2);
  eval_wrenches<S, N>(beam, ports, b, around.has_inertia ? rate : nullptr, rate2, around, out);
}

/// Strain energy [J].
template <class S, int N>
S eval_strain_energy(const Beam<N>& beam, const PortMotion<S>* ports) {
  const BeamShape<S, N> b = eval_shape<S, N>(ports);
  S sum(0.0);
  for (int g = 0; g < Beam<N>::num_strain_points; ++g) {
    Vec6<S> e = eval_strain<S, N>(b, beam.length, g);
    for (int k = 0; k < 6; ++k) e[k] = e[k] - beam.reference_strain[g][k];
    sum = sum + (0.5 * strain_rule<N>().weight[g] * beam.length) * lanes::dot(e, Vec6<S>(beam.stiffness * e));
  }
  return sum;
}

/// Kinetic energy [J].
template <class S, int N>
S eval_kinetic_energy(const Beam<N>& beam, const PortMotion<S>* ports) {
  const BeamShape<S, N> b = eval_shape<S, N>(ports);
  Vec6<S> rate[N];
  eval_shape_rates<S, N>(b, ports, rate);
  const auto& rule = mass_rule<N>();
  S sum(0.0);
  for (int g = 0; g < Beam<N>::num_mass_points; ++g) {
    const SectionMotion<S> m = eval_section<S, N>(rule.shape[g], b, rate, nullptr, ports[Beam<N>::reference]);
    sum = sum + (0.5 * rule.weight[g] * beam.length) * lanes::dot(m.v, Vec6<S>(beam.mass * m.v));
  }
  return sum;
}

/// Fills length and stress-free strains from the reference poses of the ports (relative to any anchor).
template <int N>
void set_reference(Beam<N>& beam, const PortMotion<double>* ports) {
  const BeamShape<double, N> b = eval_shape<double, N>(ports);
  for (int g = 0; g < Beam<N>::num_strain_points; ++g)
    beam.reference_strain[g] = eval_strain<double, N>(b, beam.length, g);
}

/// Load per reference length on a beam, integrated with the beam's own interpolation (same ports as the beam).
template <int N>
struct LineLoad {
  static constexpr int num_ports = N;
  static constexpr int num_multipliers = 0;
  Port ports[N];
  double length = 0.0;
  Vec6<double> wrench;   ///< (force [N/m]; moment [N]) per reference length, times the law
  bool follows = false;  ///< true: in section axes; false: in inertial axes
  int law = 0;
};

template <class S, int N>
void eval_residual(const LineLoad<N>& load, const PortMotion<S>* ports, const S*, const Surroundings<S>& around,
                   S* out) {
  const BeamShape<S, N> b = eval_shape<S, N>(ports);
  const auto& rule = mass_rule<N>();
  const PortMotion<S>& r = ports[Beam<N>::reference];
  Vec6<S> p[N], wrench[N];
  for (int i = 0; i < N; ++i) p[i] = wrench[i] = Vec6<S>::zero();
  for (int g = 0; g < N; ++g) {
    const SectionMotion<S> m = eval_section<S, N>(rule.shape[g], b, nullptr, nullptr, r);
    Vec6<S> f = (-rule.weight[g] * load.length) * (around.laws[load.law] * lanes::cast<S>(load.wrench));
    if (!load.follows) {
      const Mat3<S> R = r.H.R * m.relative.R;
      f = lanes::join<S>(lanes::transpose_times(R, lanes::linear_part(f)),
                         lanes::transpose_times(R, lanes::angular_part(f)));
    }
    add_section_wrench<S, N>(rule.shape[g], m, f, p, wrench);
  }
  add_nodal_wrenches<S, N>(b, p, wrench);
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 6; ++k) out[6 * i + k] = wrench[i][k];
}

}  // namespace bough::elements
