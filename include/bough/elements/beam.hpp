#pragma once
/// Geometrically exact beam of N nodes on a motion group: relative motions of the nodes are interpolated about a
/// reference node,
///   H(s) = H_r exp(d(s)),  d(s) = sum_i N_i(s) d_i,  d_i = log(H_r^-1 H_i),
/// so strains are frame-invariant and path-independent, and a helix is represented exactly.
/// Sources: Sonneville, Cardona, Bruls 2014 (two nodes); Sonneville, Bruls, Bauchau 2017; Crisfield, Jelenic 1999
/// (invariance).
#include "bough/elements/port.hpp"
#include "bough/elements/quadrature.hpp"

namespace bough::elements {

/// Index of the reference node: 2 nodes: the first; 3: the middle; 4: the second.
template <int N>
inline constexpr int beam_reference = N / 2 == 1 ? (N == 3 ? 1 : 0) : 1;

/// Constant data of one element on the group G. Section matrices are those of the reference axis, in space of the order
/// (N, Q2, Q3, T, M2, M3), in a plane (N, Q, M).
template <class G, int N, class C = double>
struct BeamOn {
  using Group = G;
  static constexpr int num_ports = N;
  static constexpr int num_multipliers = 0;
  static constexpr int reference = beam_reference<N>;
  static constexpr int num_strain_points = N - 1;  ///< reduced: no locking
  static constexpr int num_mass_points = N;
  PortOn<G, C> ports[N];
  C length = 0.0;                                           ///< of the reference axis [m]
  typename G::template Matrix<C> stiffness, damping, mass;  ///< see scene::Section
  bool has_damping = false, has_mass = false;
  typename G::template Vector<C>
      reference_strain[N - 1];  ///< (1 + axial, shear; curvature) of the stress-free shape at the strain points

  static constexpr Role role = Role::beam;
  static constexpr Cost cost = N == 2   ? Cost{400e-9, 1790e-9, 67e-9, 520e-9}
                               : N == 3 ? Cost{1180e-9, 5430e-9, 161e-9, 1780e-9}
                                        : Cost{1800e-9, 8800e-9, 238e-9, 3070e-9};
  static constexpr bool has_stiffness_matrix = true, acts_along_line = false;
  static constexpr DataAxes data_axes = DataAxes::section;
  template <class A, class B, class Visit>
  static void visit_data(A& a, B& b, Visit& visit) {
    visit.flag(a.has_damping, b.has_damping);
    visit.flag(a.has_mass, b.has_mass);
    visit.number(a.length, b.length);
    visit.matrix(a.stiffness, b.stiffness);
    visit.matrix(a.damping, b.damping);
    visit.matrix(a.mass, b.mass);
    for (int g = 0; g < N - 1; ++g) visit.vector(a.reference_strain[g], b.reference_strain[g]);
  }
};
template <class G, int N, class C>
inline constexpr bool exists<BeamOn<G, N, C>> = G::turns;
template <int N, class C = double>
using Beam = BeamOn<motion::Se3, N, C>;

/// Whether an element's forces depend on velocities or accelerations.
template <class G, int N, class C>
bool looks_at_rates(const BeamOn<G, N, C>& e) {
  return e.has_mass || e.has_damping;
}

/// Whether the element has mass, its mass, whether it can take up energy, and whether it exchanges energy with the
/// outside.
template <class G, int N, class C>
bool has_mass(const BeamOn<G, N, C>& e) {
  return e.has_mass;
}
template <class G, int N, class C>
C total_mass(const BeamOn<G, N, C>& e) {
  return e.has_mass ? e.length * e.mass(0, 0) : C(0.0);
}
template <class G, int N, class C>
bool dissipates(const BeamOn<G, N, C>& e) {
  return e.has_damping;
}
template <class G, int N, class C>
bool exchanges_energy(const BeamOn<G, N, C>& e) {
  return dissipates(e);
}

/// Motions of the nodes relative to the reference node. The forces of a beam depend on no other positions.
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
template <class S, int N, class C>
Vec6<S> eval_strain(const BeamShape<S, N>& b, const C& length, int point) {
  if constexpr (N == 2) {
    return (1.0 / length) * b.d[1];  // d' is parallel to d, and T(d) d = d
  } else {
    const auto& rule = strain_rule<N>();
    return (1.0 / length) *
           motion::tangent_times(blend<S, N>(rule.shape[point], b.d), blend<S, N>(rule.slope[point], b.d));
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
  const Vec6<S> d1 = blend<S, N>(shape, rate);
  const Vec6<S> carried = motion::inverse_adjoint_times(m.relative, r.v);
  const Vec6<S> own = m.T.times(d1);
  m.v = carried + own;
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

/// Fills length and stress-free strains from the reference poses of the ports (relative to any anchor).
template <int N>
void set_reference(Beam<N>& beam, const PortMotion<double>* ports) {
  const BeamShape<double, N> b = eval_shape<double, N>(ports);
  for (int g = 0; g < Beam<N>::num_strain_points; ++g)
    beam.reference_strain[g] = eval_strain<double, N>(b, beam.length, g);
}

}  // namespace bough::elements
