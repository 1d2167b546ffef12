#include "bough/elements/momentum.hpp"

#include "tangent_blocks.hpp"

namespace bough::elements {

template <class E>
void evaluate_momentum(const E& e, const Field& field, double turns, double elastic_inertia, double* momentum,
                       double* force) {
  constexpr int P = E::num_ports;
  const motion::Vec3Pair anchor = anchor_of(e, field.nodes);
  PortMotion<double> p[P];
  for (int k = 0; k < P; ++k) p[k] = eval_port(e.ports[k], field.nodes, anchor);
  double P_ports[6 * P], F_ports[6 * P] = {};
  double* const F = force != nullptr ? F_ports : nullptr;
  if constexpr (E::num_multipliers > 0)
    eval_momentum(e, p, field.around, turns, P_ports, F);
  else
    eval_momentum(e, p, field.around, elastic_inertia, P_ports, F);
  int to = 0;
  for (int k = 0; k < P; ++k) {
    const Port& port = e.ports[k];
    if (port.node == ground) continue;
    Vec6<double> P_node, F_node;
    for (int i = 0; i < 6; ++i) {
      P_node[i] = P_ports[6 * k + i];
      F_node[i] = F_ports[6 * k + i];
    }
    if (port.has_offset) {
      P_node = motion::inverse_adjoint_transpose_times(port.offset, P_node);
      F_node = motion::inverse_adjoint_transpose_times(port.offset, F_node);
    }
    for (int i = 0; i < 6; ++i, ++to) {
      momentum[to] = P_node[i];
      if (force != nullptr) force[to] = F_node[i];
    }
  }
}

namespace {

/// B_i^T k B_j into the rows and columns of ports i, j, r, for d_i' = B_i v = U_i (v_i - Q_i v_r); ports on the ground are left out.
struct RelativeRates {
  Mat6<double> U, Q;  ///< T(d)^-1, Ad(H_ri)^-1
  int port = 0;
};

template <class E>
void add_block(const E& e, const Mat6<double>& block, int p, int q, double factor, int size, double* matrix) {
  if (e.ports[p].node == ground || e.ports[q].node == ground) return;
  const auto place = [&e](int port) {
    int at = 0;
    for (int k = 0; k < port; ++k) at += e.ports[k].node == ground ? 0 : 6;
    return at;
  };
  Mat6<double> b = block;
  if (e.ports[p].has_offset) b = transposed_product(motion::inverse_adjoint(e.ports[p].offset), b);
  if (e.ports[q].has_offset) b = product(b, motion::inverse_adjoint(e.ports[q].offset));
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) matrix[(place(p) + i) * size + place(q) + j] += factor * b(i, j);
}

template <class E>
void add_pair(const E& e, const RelativeRates& a, const RelativeRates& b, const Mat6<double>& k, int r, double factor,
              int size, double* matrix) {
  const Mat6<double> m = transposed_product(a.U, product(k, b.U)), mQ = product(m, b.Q);
  add_block(e, m, a.port, b.port, factor, size, matrix);
  add_block(e, mQ, a.port, r, -factor, size, matrix);
  add_block(e, transposed_product(a.Q, m), r, b.port, -factor, size, matrix);
  add_block(e, transposed_product(a.Q, mQ), r, r, factor, size, matrix);
}

}  // namespace

template <class E>
void add_elastic_mass(const E& e, const Field& field, double factor, double* matrix) {
  constexpr int P = E::num_ports;
  const int size = num_unknowns(e);
  const motion::Vec3Pair anchor = anchor_of(e, field.nodes);
  PortMotion<double> p[P];
  for (int k = 0; k < P; ++k) p[k] = eval_port(e.ports[k], field.nodes, anchor);
  if constexpr (std::is_same_v<E, Bushing>) {
    const Frame<double> relative = motion::relative(p[0].H, p[1].H);
    const RelativeRates rates{motion::inverse_tangent_operator(motion::log_se3(relative)).matrix(),
                              motion::inverse_adjoint(relative), 1};
    add_pair(e, rates, rates, e.stiffness, 0, factor, size, matrix);
  } else if constexpr (requires { e.reference_strain; }) {
    constexpr int r = Beam<P>::reference;
    const BeamShape<double, P> b = eval_shape<double, P>(p);
    RelativeRates rates[P];
    for (int i = 0; i < P; ++i)
      if (i != r) rates[i] = {b.inverse[i].matrix(), motion::inverse_adjoint(b.relative[i]), i};
    for (int j = 0; j < P; ++j) {
      if (j == r) continue;
      Mat6<double> column[P];  // K_ij, from unit rates
      for (int k = 0; k < 6; ++k) {
        Vec6<double> unit[P], q[P];
        for (int i = 0; i < P; ++i) unit[i] = q[i] = Vec6<double>::zero();
        unit[j][k] = 1.0;
        add_elastic_momentum<double, P>(e, b, unit, 1.0, q, nullptr);
        for (int i = 0; i < P; ++i)
          for (int l = 0; l < 6; ++l) column[i](l, k) = q[i][l];
      }
      for (int i = 0; i < P; ++i)
        if (i != r) add_pair(e, rates[i], rates[j], column[i], r, factor, size, matrix);
    }
  }
}

template <class E>
void add_gyroscopic(const E& e, const Field& field, double factor, double* matrix) {
  if constexpr (std::is_same_v<E, RigidBody> || requires { e.reference_strain; }) {
    const motion::Vec3Pair anchor = anchor_of(e, field.nodes);
    for (int k = 0; k < E::num_ports; ++k) {
      double share = 1.0;
      if constexpr (!std::is_same_v<E, RigidBody>) {
        const auto& rule = mass_rule<E::num_ports>();
        share = 0.0;
        for (int g = 0; g < E::num_mass_points; ++g) share += rule.weight[g] * e.length * rule.shape[g][k];
      }
      const PortMotion<double> p = eval_port(e.ports[k], field.nodes, anchor);
      add_block(e, transposed_product(motion::cross6(p.v), e.mass), k, k, factor * share, num_unknowns(e), matrix);
    }
  }
}

void evaluate_rows(const Joint& joint, const Field& field, double turns, double* rows, double* gradient) {
  const motion::Vec3Pair anchor = anchor_of(joint, field.nodes);
  PortMotion<double> p[2];
  for (int k = 0; k < 2; ++k) p[k] = eval_port(joint.ports[k], field.nodes, anchor);
  const Frame<double> H = motion::relative(p[0].H, p[1].H);
  const bool moves[2] = {joint.ports[0].node != ground, joint.ports[1].node != ground};
  double* to = gradient;
  for (int row = 0; row < joint.num_rows; ++row) {
    Vec6<double> by_port[2];
    rows[row] = eval_row(joint.rows[row], H, turns, field.around.laws, by_port[1]);
    by_port[0] = -motion::inverse_adjoint_transpose_times(H, by_port[1]);
    for (int k = 0; k < 2; ++k) {
      if (!moves[k]) continue;
      if (joint.ports[k].has_offset)
        by_port[k] = motion::inverse_adjoint_transpose_times(joint.ports[k].offset, by_port[k]);
      for (int i = 0; i < 6; ++i) *to++ = by_port[k][i];
    }
  }
}

#define BOUGH_INSTANTIATE_MOMENTUM(E)                                                        \
  template void evaluate_momentum(const E&, const Field&, double, double, double*, double*); \
  template void add_elastic_mass(const E&, const Field&, double, double*);                   \
  template void add_gyroscopic(const E&, const Field&, double, double*);
BOUGH_INSTANTIATE_MOMENTUM(Beam<2>)
BOUGH_INSTANTIATE_MOMENTUM(Beam<3>)
BOUGH_INSTANTIATE_MOMENTUM(Beam<4>)
BOUGH_INSTANTIATE_MOMENTUM(RigidBody)
BOUGH_INSTANTIATE_MOMENTUM(Joint)
BOUGH_INSTANTIATE_MOMENTUM(Spring)
BOUGH_INSTANTIATE_MOMENTUM(Bushing)
BOUGH_INSTANTIATE_MOMENTUM(PointLoad)
BOUGH_INSTANTIATE_MOMENTUM(LineLoad<2>)
BOUGH_INSTANTIATE_MOMENTUM(LineLoad<3>)
BOUGH_INSTANTIATE_MOMENTUM(LineLoad<4>)
#undef BOUGH_INSTANTIATE_MOMENTUM

}  // namespace bough::elements
