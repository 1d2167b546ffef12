#pragma once
/// Bodies of the drivers in evaluate.hpp; included once per element type, in the file that instantiates it.
#include "beam_tangent.hpp"
#include "body_tangent.hpp"
#include "bough/elements/evaluate.hpp"
#include "bough/lanes/taylor.hpp"
#include "relative_tangent.hpp"

namespace bough::elements {

/// The joint's kernel also wants the angle's last accepted value; all others ignore it.
template <class E, class S, class C>
void eval_kernel(const E& e, const PortMotion<S>* p, const S* multipliers, const Surroundings<S>& around, S* out,
                 const C& turns) {
  if constexpr (E::num_multipliers > 0)
    eval_residual(e, p, multipliers, around, out, turns);
  else
    eval_residual(e, p, multipliers, around, out);
}

/// Carries wrench rows and increment columns from port axes to node axes, drops ports on the ground: F_node = J^T F, K_node = J^T K J,
/// J = Ad(offset^-1). `in_tangent`: rows of forces, then of constraints, of 6 P columns.
template <class E, class S>
void gather(const E& e, const S* in_residual, const S* in_tangent, S* residual, S* tangent) {
  constexpr int P = E::num_ports, D = 6 * P;
  const int m = num_multipliers(e);
  int to[P], n = 0;
  DualMat<S> J[P];
  for (int p = 0; p < P; ++p) {
    to[p] = -1;
    if (e.ports[p].node == ground) continue;
    to[p] = n;
    n += 6;
    if (e.ports[p].has_offset) J[p] = inverse_adjoint_dual(e.ports[p].offset);
  }
  const int size = n + m;
  for (int p = 0; p < P; ++p) {
    if (to[p] < 0) continue;
    Vec6<S> f;
    for (int i = 0; i < 6; ++i) f[i] = in_residual[6 * p + i];
    if (e.ports[p].has_offset) f = motion::wrench_vector(transpose_times(J[p], motion::wrench_dual(f)));
    for (int i = 0; i < 6; ++i) residual[to[p] + i] = f[i];
  }
  for (int i = 0; i < m; ++i) residual[n + i] = in_residual[D + i];
  if (tangent == nullptr) return;
  for (int q = 0; q < P; ++q) {
    if (to[q] < 0) continue;
    for (int p = 0; p <= P; ++p) {  // p == P: the constraint rows
      if (p < P && to[p] < 0) continue;
      const int rows = p < P ? 6 : m, row0 = p < P ? to[p] : n;
      const bool left = p < P && e.ports[p].has_offset, right = e.ports[q].has_offset;
      if (p < P && !left && !right) {
        for (int i = 0; i < 6; ++i)
          for (int j = 0; j < 6; ++j) tangent[(row0 + i) * size + to[q] + j] = in_tangent[(6 * p + i) * D + 6 * q + j];
        continue;
      }
      Mat6<S> block;
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) block(i, j) = i < rows ? in_tangent[(6 * p + i) * D + 6 * q + j] : S(0.0);
      if (right) block = motion_product(block, J[q]);
      if (left) block = transposed_product(J[p], block);
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < 6; ++j) tangent[(row0 + i) * size + to[q] + j] = block(i, j);
      if (p == P)  // forces are G^T lambda: the columns of the multipliers
        for (int i = 0; i < rows; ++i)
          for (int j = 0; j < 6; ++j) tangent[(to[q] + j) * size + row0 + i] = block(i, j);
    }
  }
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) tangent[(n + i) * size + n + j] = S(0.0);
}

/// Whether an element's forces depend on velocities or accelerations.
template <int N, class C>
bool looks_at_rates(const Beam<N, C>& e) {
  return e.has_mass || e.has_damping;
}
template <int N, class C>
bool looks_at_rates(const LineLoad<N, C>&) {
  return false;
}
template <class C>
bool looks_at_rates(const RigidBodyOf<C>&) {
  return true;
}
template <class C>
bool looks_at_rates(const PointLoadOf<C>&) {
  return false;
}
template <class C>
bool looks_at_rates(const SpringOf<C>& e) {
  return is_present(e.damping);
}
template <class C>
bool looks_at_rates(const BushingOf<C>& e) {
  return e.has_damping;
}
template <class C>
bool looks_at_rates(const JointOf<C>& e) {
  return is_damped(e);
}

/// How the ports of an element follow the unknowns of their nodes.
template <class E, class S>
void eval_port_slopes(const E& e, const FieldOf<S>& field, PortSlopes<S>* ports) {
  const bool has_rates = field.around.has_inertia && looks_at_rates(e);
  for (int k = 0; k < E::num_ports; ++k) {
    const PortOf<S>& port = e.ports[k];
    ports[k].moves = !field.slopes.mass_only;
    if (port.node == ground || !has_rates || field.slopes.mass_only) {
      ports[k].velocity = ports[k].acceleration = DualMat<S>::zero();
      if (port.node != ground && has_rates) ports[k].acceleration.a = Mat3<S>::identity();
      continue;
    }
    Vec6<S> dq = field.nodes[port.node].dq;
    if (port.has_offset) dq = motion::inverse_adjoint_times(port.offset, dq);
    const DualVec<S> d = motion::motion_dual(dq);
    const S x = lanes::dot(d.a, d.a);
    const DualMat<S> inverse = matrix(motion::dual_inverse_tangent(d, x, motion::eval_inverse_coefficients(x)));
    ports[k].velocity = motion::scaled(field.slopes.velocity, inverse);
    ports[k].acceleration = motion::scaled(field.slopes.acceleration, inverse);
  }
}

/// Motions of an element with mass as seen from the inertial frame, where nodes are described in a frame that moves; and with
/// slopes how they follow the port's increment eta, since Ad((H exp(eta))^-1) V = c + ad(c) eta:
///   dv_s = dv + ad(c) eta,   da_s = da + ad(c) dv + (ad(Ad(H^-1) V') - ad(v) ad(c)) eta
/// All of these are operators on motions, as the kernels take them. Precondition: there is an observer.
template <class E, class S>
void see_from_inertial(const E&, const FieldOf<S>& field, const motion::PositionPair<S>& anchor, PortMotion<S>* p,
                       PortSlopes<S>* slopes) {
  if constexpr (has_mass_matrix<E>) {
    if (!field.around.has_inertia) return;
    const CarrierMotionOf<S>& o = *field.observer;
    const Vec3<S> from = anchor.hi + anchor.lo;
    for (int k = 0; k < E::num_ports; ++k) {
      if (slopes != nullptr && slopes[k].moves) {
        const Frame<S> H{p[k].H.R, p[k].H.x + from};
        const DualVec<S> carried = motion::motion_dual(motion::inverse_adjoint_times(H, o.twist));
        const DualVec<S> rate = motion::motion_dual(motion::inverse_adjoint_times(H, o.twist_rate));
        const DualMat<S> by_twist = motion::skew(carried);
        DualMat<S>& acceleration = slopes[k].acceleration;
        add_product(acceleration, by_twist, slopes[k].velocity);
        acceleration = acceleration + motion::skew(rate) -
                       motion::skew_product(motion::skew(motion::motion_dual(p[k].v)), carried);
        slopes[k].velocity = slopes[k].velocity + by_twist;
      }
      add_observer_motion(p[k], from, o.twist, o.twist_rate);
    }
  }
}

/// The driver of all elements, for doubles and for packs. S: scalar of the element's constants too.
template <class E, class S>
void evaluate_element(const E& e, const FieldOf<S>& field, const S* multipliers, const S& turns, S* residual,
                      S* tangent) {
  constexpr int P = E::num_ports, D = 6 * P, rows = D + E::num_multipliers;
  const motion::PositionPair<S> anchor = anchor_of(e, field.nodes);
  PortMotion<S> p[P];
  for (int k = 0; k < P; ++k) p[k] = eval_port(e.ports[k], field.nodes, anchor, field.carriers);
  S out[rows];
  if (tangent == nullptr) {
    if (field.observer != nullptr) see_from_inertial<E, S>(e, field, anchor, p, nullptr);
    eval_kernel<E, S>(e, p, multipliers, field.around, out, turns);
    gather<E, S>(e, out, nullptr, residual, nullptr);
    return;
  }
  PortSlopes<S> ports[P];
  eval_port_slopes(e, field, ports);
  if (field.observer != nullptr) see_from_inertial<E, S>(e, field, anchor, p, ports);
  bool in_place = E::num_multipliers == 0;  // nothing to carry from ports to nodes: the rows and columns as they are
  for (const auto& port : e.ports) in_place = in_place && port.node != ground && !port.has_offset;
  S own[rows * D];
  S* matrix = in_place ? tangent : own;
  if constexpr (E::num_multipliers > 0)
    eval_tangent(e, p, ports, multipliers, field.around, turns, out, matrix);
  else
    eval_tangent(e, p, ports, field.around, out, matrix);
  gather<E, S>(e, out, in_place ? nullptr : matrix, residual, in_place ? nullptr : tangent);
}

template <class E>
void evaluate(const E& e, const Field& field, const double* multipliers, double turns, double* residual,
              double* tangent) {
  evaluate_element<E, double>(e, field, multipliers, turns, residual, tangent);
}

/// Taylor series of a port's motion from pose, twist, acceleration and jerk of its node.
template <int K>
PortMotion<lanes::Taylor<double, K>> series_of(const PortMotion<double>& p, const Vec6<double>& jerk) {
  using T = lanes::Taylor<double, K>;
  PortMotion<T> r;
  r.H.R = lanes::cast<T>(p.H.R);
  r.H.x = lanes::cast<T>(p.H.x);
  r.v = lanes::cast<T>(p.v);
  r.a = lanes::cast<T>(p.a);
  for (int i = 0; i < 6; ++i) {
    r.v[i].c[1] = p.a[i];
    r.a[i].c[1] = jerk[i];
    if constexpr (K >= 2) r.v[i].c[2] = 0.5 * jerk[i];
  }
  for (int k = 0; k < K; ++k)  // R' = R ~w, x' = R v, coefficient by coefficient
    for (int i = 0; i < 3; ++i) {
      double dx = 0.0, dR[3] = {0.0, 0.0, 0.0};
      for (int j = 0; j <= k; ++j) {
        const double R0 = r.H.R(i, 0).c[j], R1 = r.H.R(i, 1).c[j], R2 = r.H.R(i, 2).c[j];
        const int l = k - j;
        dx += R0 * r.v[0].c[l] + R1 * r.v[1].c[l] + R2 * r.v[2].c[l];
        dR[0] += R1 * r.v[5].c[l] - R2 * r.v[4].c[l];
        dR[1] += R2 * r.v[3].c[l] - R0 * r.v[5].c[l];
        dR[2] += R0 * r.v[4].c[l] - R1 * r.v[3].c[l];
      }
      r.H.x[i].c[k + 1] = dx / (k + 1);
      for (int j = 0; j < 3; ++j) r.H.R(i, j).c[k + 1] = dR[j] / (k + 1);
    }
  return r;
}

template <class E>
void evaluate_rate(const E& e, const Field& field, const Surroundings<lanes::Taylor<double, 1>>& around,
                   const double* multipliers, double turns, double* residual_rate) {
  using T = lanes::Taylor<double, 1>;
  constexpr int P = E::num_ports, rows = 6 * P + E::num_multipliers;
  const motion::Vec3Pair anchor = anchor_of(e, field.nodes);
  PortMotion<T> p[P];
  for (int k = 0; k < P; ++k)
    p[k] = series_of<1>(eval_port(e.ports[k], field.nodes, anchor, field.carriers), Vec6<double>::zero());
  if constexpr (has_mass_matrix<E>) {
    if (field.observer != nullptr && around.has_inertia) {
      Vec6<T> twist = lanes::cast<T>(field.observer->twist), twist_rate = lanes::cast<T>(field.observer->twist_rate);
      for (int i = 0; i < 6; ++i) {
        twist[i].c[1] = field.observer->twist_rate[i];
        twist_rate[i].c[1] = field.observer->twist_second[i];
      }
      for (int k = 0; k < P; ++k)
        add_observer_motion(p[k], lanes::cast<T>(Vec3<double>(anchor.hi + anchor.lo)), twist, twist_rate);
    }
  }
  T lambda[E::num_multipliers + 1] = {}, out[rows];
  for (int k = 0; k < num_multipliers(e); ++k) lambda[k] = T(multipliers[k]);
  eval_kernel<E, T>(e, p, lambda, around, out, turns);
  double rate[rows];
  for (int i = 0; i < 6 * P + num_multipliers(e); ++i) rate[i] = out[i].c[1];
  gather<E, double>(e, rate, nullptr, residual_rate, nullptr);
}

}  // namespace bough::elements

/// Instantiates the drivers for one element type.
#define BOUGH_INSTANTIATE_ELEMENT(E)                                                                                \
  template void evaluate(const E&, const Field&, const double*, double, double*, double*);                          \
  template void evaluate_rate(const E&, const Field&, const Surroundings<lanes::Taylor<double, 1>>&, const double*, \
                              double, double*);
