#include "bough/elements/momentum.hpp"

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

/// d_i' = U_i v_i + (ad(d_i) - U_i) v_r.
struct RelativeRates {
  motion::DualMat<double> own, reference;
  int port = 0;
};
template <int N>
RelativeRates relative_rates(const BeamRates<motion::Se3, double, N>& b, int i) {
  const motion::DualMat<double> U = matrix(b.inverse[i]);
  return {U, motion::skew(b.d[i]) - U, i};
}

/// Adds factor times a block in the rows and columns of ports p, q; ports on the ground are left out.
template <class E>
void add_block(const E& e, const Mat6<double>& block, int p, int q, double factor, int size, double* matrix) {
  if (e.ports[p].node == ground || e.ports[q].node == ground) return;
  const auto place = [&e](int port) {
    int at = 0;
    for (int k = 0; k < port; ++k) at += e.ports[k].node == ground ? 0 : 6;
    return at;
  };
  Mat6<double> b = block;
  if (e.ports[p].has_offset) b = lanes::transpose_times(motion::inverse_adjoint(e.ports[p].offset), b);
  if (e.ports[q].has_offset) b = b * motion::inverse_adjoint(e.ports[q].offset);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) matrix[(place(p) + i) * size + place(q) + j] += factor * b(i, j);
}

/// Adds factor times that of d_a'^T k d_b'.
template <class E>
void add_pair(const E& e, const RelativeRates& a, const RelativeRates& b, const Mat6<double>& k, int r, double factor,
              int size, double* matrix) {
  using G = motion::Se3;
  const Mat6<double> own = G::block_product(k, b.own), reference = G::block_product(k, b.reference);
  add_block(e, G::transposed_product(a.own, own), a.port, b.port, factor, size, matrix);
  add_block(e, G::transposed_product(a.own, reference), a.port, r, factor, size, matrix);
  add_block(e, G::transposed_product(a.reference, own), r, b.port, factor, size, matrix);
  add_block(e, G::transposed_product(a.reference, reference), r, r, factor, size, matrix);
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
    BeamRates<motion::Se3, double, 2> b;
    eval_relative_motions<motion::Se3, double, 2>(p, b);
    const RelativeRates rates = relative_rates<2>(b, 1);
    add_pair(e, rates, rates, e.stiffness, 0, factor, size, matrix);
  } else if constexpr (requires { e.reference_strain; }) {
    constexpr int r = Beam<P>::reference;
    BeamRates<motion::Se3, double, P> b;
    eval_relative_motions<motion::Se3, double, P>(p, b);
    RelativeRates rates[P];
    for (int i = 0; i < P; ++i)
      if (i != r) rates[i] = relative_rates<P>(b, i);
    for (int j = 0; j < P; ++j) {
      if (j == r) continue;
      Mat6<double> column[P];  // K_ij, from unit rates
      for (int k = 0; k < 6; ++k) {
        motion::DualVec<double> q[P];
        for (int i = 0; i < P; ++i) b.rate[i] = q[i] = motion::DualVec<double>::zero();
        b.rate[j] = motion::motion_dual(Vec6<double>::unit(k));
        add_elastic_momentum<motion::Se3, double, P, double>(e, b, 1.0, q, nullptr);
        for (int i = 0; i < P; ++i) {
          const Vec6<double> entries = motion::wrench_vector(q[i]);
          for (int l = 0; l < 6; ++l) column[i](l, k) = entries[l];
        }
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
      add_block(e, lanes::transpose_times(motion::cross6(p.v), e.mass), k, k, factor * share, num_unknowns(e), matrix);
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
