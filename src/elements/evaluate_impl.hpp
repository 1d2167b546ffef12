#pragma once
/// Bodies of the drivers in evaluate.hpp; included once per element type, in the file that instantiates it.
#include "beam_tangent.hpp"
#include "bough/elements/evaluate.hpp"
#include "bough/lanes/jet.hpp"
#include "bough/lanes/taylor.hpp"
#include "relative_tangent.hpp"

namespace bough::elements {

/// The joint's kernel also wants the angle's last accepted value; all others ignore it.
template <class E, class S>
void eval_kernel(const E& e, const PortMotion<S>* p, const S* multipliers, const Surroundings<S>& around, S* out,
                 double turns) {
  if constexpr (E::num_multipliers > 0)
    eval_residual(e, p, multipliers, around, out, turns);
  else
    eval_residual(e, p, multipliers, around, out);
}

/// Port motion with derivative directions first .. first + 5 = the port's own increment eta:
///   R (1 + ~eta_w), x + R eta_u, v + A eta, a + B eta.
template <int D>
PortMotion<lanes::Jet<double, D>> seed_port(const PortMotion<double>& p, int first, const PortSlopes& slopes) {
  using J = lanes::Jet<double, D>;
  PortMotion<J> r;
  r.H.R = lanes::cast<J>(p.H.R);
  r.H.x = lanes::cast<J>(p.H.x);
  r.v = lanes::cast<J>(p.v);
  r.a = lanes::cast<J>(p.a);
  if (slopes.moves)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        r.H.x[i].d[first + k] = p.H.R(i, k);
        r.H.R(i, next).d[first + 3 + k] = p.H.R(i, last);   // e_k x e_next = e_last
        r.H.R(i, last).d[first + 3 + k] = -p.H.R(i, next);  // e_k x e_last = -e_next
      }
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) {
      r.v[i].d[first + k] = slopes.velocity(i, k);
      r.a[i].d[first + k] = slopes.acceleration(i, k);
    }
  return r;
}

template <class S>
Surroundings<S> cast_surroundings(const Surroundings<double>& a, const S* laws) {
  return {lanes::cast<S>(a.gravity), laws, a.has_inertia};
}

/// Largest number of laws one element looks at.
constexpr int max_element_laws = 1;

/// The laws an element looks at, as constants of scalar S behind the same indices.
template <class S>
struct LawView {
  S values[max_element_laws];
  int used = 0;
  int take(int& index, const double* laws) {
    if (index < 0) return -1;
    values[used] = S(laws[index]);
    return index = used++;
  }
};

template <class S>
void take_laws(PointLoad& e, LawView<S>& view, const double* laws) {
  view.take(e.law, laws);
}
template <class E>
constexpr bool looks_at_laws = requires(E e, LawView<double> view) {
  take_laws(e, view, nullptr);
};

/// Carries wrench rows and increment columns from port axes to node axes, drops ports on the ground: F_node = J^T F, K_node = J^T K J,
/// J = Ad(offset^-1).
template <class E>
void gather(const E& e, const double* in_residual, const double* in_tangent, int in_size, double* residual,
            double* tangent) {
  constexpr int P = E::num_ports;
  const int m = num_multipliers(e);
  int to[P], n = 0;
  Mat6<double> J[P];
  for (int p = 0; p < P; ++p) {
    to[p] = -1;
    if (e.ports[p].node == ground) continue;
    to[p] = n;
    n += 6;
    if (e.ports[p].has_offset) J[p] = motion::inverse_adjoint(e.ports[p].offset);
  }
  const int size = n + m;
  for (int p = 0; p < P; ++p) {
    if (to[p] < 0) continue;
    for (int i = 0; i < 6; ++i) {
      double s = in_residual[6 * p + i];
      if (e.ports[p].has_offset) {
        s = 0.0;
        for (int k = 0; k < 6; ++k) s += J[p](k, i) * in_residual[6 * p + k];
      }
      residual[to[p] + i] = s;
    }
  }
  for (int i = 0; i < m; ++i) residual[n + i] = in_residual[6 * P + i];
  if (tangent == nullptr) return;
  const auto in = [&](int i, int j) { return in_tangent[i * in_size + j]; };
  for (int q = 0; q < P; ++q) {
    if (to[q] < 0) continue;
    for (int p = 0; p <= P; ++p) {  // p == P: the constraint rows
      if (p < P && to[p] < 0) continue;
      const int rows = p < P ? 6 : m;
      double block[6][6];
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < 6; ++j) block[i][j] = in(6 * p + i, 6 * q + j);
      if (e.ports[q].has_offset) {
        for (int i = 0; i < rows; ++i) {
          double row[6];
          for (int j = 0; j < 6; ++j) {
            row[j] = 0.0;
            for (int k = 0; k < 6; ++k) row[j] += block[i][k] * J[q](k, j);
          }
          for (int j = 0; j < 6; ++j) block[i][j] = row[j];
        }
      }
      if (p < P && e.ports[p].has_offset) {
        for (int j = 0; j < 6; ++j) {
          double col[6];
          for (int i = 0; i < 6; ++i) {
            col[i] = 0.0;
            for (int k = 0; k < 6; ++k) col[i] += J[p](k, i) * block[k][j];
          }
          for (int i = 0; i < 6; ++i) block[i][j] = col[i];
        }
      }
      const int row0 = p < P ? to[p] : n;
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < 6; ++j) tangent[(row0 + i) * size + to[q] + j] = block[i][j];
      if (p == P)  // forces are G^T lambda: the columns of the multipliers
        for (int i = 0; i < rows; ++i)
          for (int j = 0; j < 6; ++j) tangent[(to[q] + j) * size + row0 + i] = block[i][j];
    }
  }
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) tangent[(n + i) * size + n + j] = 0.0;
}

/// How the ports of an element follow the unknowns of their nodes.
template <class E>
void eval_port_slopes(const E& e, const Field& field, PortSlopes* ports) {
  for (int k = 0; k < E::num_ports; ++k) {
    const Port& port = e.ports[k];
    ports[k] = {!field.slopes.mass_only, Mat6<double>::zero(), Mat6<double>::zero()};
    if (port.node == ground || !field.around.has_inertia) continue;
    if (field.slopes.mass_only) {
      ports[k].acceleration = Mat6<double>::identity();
      continue;
    }
    Vec6<double> dq = field.nodes[port.node].dq;
    if (port.has_offset) dq = motion::inverse_adjoint_times(port.offset, dq);
    const Mat6<double> inverse = motion::Se3::inverse_tangent(dq);
    ports[k].velocity = field.slopes.velocity * inverse;
    ports[k].acceleration = field.slopes.acceleration * inverse;
  }
}

/// Elements without a tangent of their own: the residual on jets.
template <class E>
void eval_tangent_by_jets(const E& e, const PortMotion<double>* p, const PortSlopes* ports,
                          const Surroundings<double>& around, double* residual, double* matrix) {
  eval_residual(e, p, static_cast<const double*>(nullptr), around, residual);
  constexpr int P = E::num_ports, D = 6 * P;
  using J = lanes::Jet<double, D>;
  PortMotion<J> jets[P];
  for (int k = 0; k < P; ++k) jets[k] = seed_port<D>(p[k], 6 * k, ports[k]);
  J out[D];
  if constexpr (looks_at_laws<E>) {
    E local = e;
    LawView<J> view;
    take_laws(local, view, around.laws);
    eval_residual(local, jets, static_cast<const J*>(nullptr), cast_surroundings<J>(around, view.values), out);
  } else {
    eval_residual(e, jets, static_cast<const J*>(nullptr), cast_surroundings<J>(around, nullptr), out);
  }
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) matrix[i * D + j] = out[i].d[j];
}

template <class E>
constexpr bool has_closed_tangent = requires(const E& e, const PortMotion<double>* p, const PortSlopes* ports,
                                             const Surroundings<double>& around, double* out) {
  eval_tangent(e, p, ports, around, out, out);
};

template <class E>
void evaluate(const E& e, const Field& field, const double* multipliers, double turns, double* residual,
              double* tangent) {
  constexpr int P = E::num_ports, D = 6 * P, rows = D + E::num_multipliers;
  const motion::Vec3Pair anchor = anchor_of(e, field.nodes);
  PortMotion<double> p[P];
  for (int k = 0; k < P; ++k) p[k] = eval_port(e.ports[k], field.nodes, anchor);
  double out[rows];
  if (tangent == nullptr) {
    eval_kernel<E, double>(e, p, multipliers, field.around, out, turns);
    gather(e, out, nullptr, 0, residual, nullptr);
    return;
  }
  PortSlopes ports[P];
  eval_port_slopes(e, field, ports);
  double matrix[rows * D];
  if constexpr (E::num_multipliers > 0)
    eval_tangent(e, p, ports, multipliers, field.around, turns, out, matrix);
  else if constexpr (has_closed_tangent<E>)
    eval_tangent(e, p, ports, field.around, out, matrix);
  else
    eval_tangent_by_jets(e, p, ports, field.around, out, matrix);
  gather(e, out, matrix, D, residual, tangent);
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
  for (int k = 0; k < P; ++k) p[k] = series_of<1>(eval_port(e.ports[k], field.nodes, anchor), Vec6<double>::zero());
  T lambda[E::num_multipliers + 1] = {}, out[rows];
  for (int k = 0; k < num_multipliers(e); ++k) lambda[k] = T(multipliers[k]);
  eval_kernel<E, T>(e, p, lambda, around, out, turns);
  double rate[rows];
  for (int i = 0; i < 6 * P + num_multipliers(e); ++i) rate[i] = out[i].c[1];
  gather(e, rate, nullptr, 0, residual_rate, nullptr);
}

}  // namespace bough::elements

/// Instantiates the drivers for one element type.
#define BOUGH_INSTANTIATE_ELEMENT(E)                                                                                \
  template void evaluate(const E&, const Field&, const double*, double, double*, double*);                          \
  template void evaluate_rate(const E&, const Field&, const Surroundings<lanes::Taylor<double, 1>>&, const double*, \
                              double, double*);
