#include "bough/elements/momentum.hpp"

#include "emit.hpp"

namespace bough::elements {

template <class E>
void evaluate_momentum(const E& e, const FieldFor<E>& field, double turns, double elastic_inertia, double* momentum,
                       double* force) {
  using G = typename E::Group;
  constexpr int P = E::num_ports, dof = G::dof;
  const auto anchor = anchor_of(e, field.nodes);
  PortMotionOn<G, double> p[P];
  for (int k = 0; k < P; ++k) p[k] = eval_port(e.ports[k], field.nodes, anchor);
  double P_ports[dof * P], F_ports[dof * P] = {};
  double* const F = force != nullptr ? F_ports : nullptr;
  if constexpr (E::num_multipliers > 0)
    eval_momentum(e, p, field.around, turns, P_ports, F);
  else
    eval_momentum(e, p, field.around, elastic_inertia, P_ports, F);
  int to = 0;
  for (int k = 0; k < P; ++k) {
    const auto& port = e.ports[k];
    if (port.node == ground) continue;
    typename G::template Vector<double> P_node, F_node;
    for (int i = 0; i < dof; ++i) {
      P_node[i] = P_ports[dof * k + i];
      F_node[i] = F_ports[dof * k + i];
    }
    if (port.has_offset) {
      P_node = G::inverse_adjoint_transpose_times(port.offset, P_node);
      F_node = G::inverse_adjoint_transpose_times(port.offset, F_node);
    }
    for (int i = 0; i < dof; ++i, ++to) {
      momentum[to] = P_node[i];
      if (force != nullptr) force[to] = F_node[i];
    }
  }
}

namespace {

template <class G>
using Square = typename G::template Matrix<double>;
template <class G>
using Unit = typename G::template Vector<double>;

/// The matrix of a linear function of vectors, column by column.
template <class G, class F>
Square<G> matrix_of(F&& f) {
  Square<G> m;
  for (int j = 0; j < G::dof; ++j) {
    const Unit<G> column = f(Unit<G>::unit(j));
    for (int i = 0; i < G::dof; ++i) m(i, j) = column[i];
  }
  return m;
}

/// d_i' = U_i v_i + (ad(d_i) - U_i) v_r.
template <class G>
struct RelativeRates {
  Square<G> own, reference;
  int port = 0;
};
template <class G, int N>
RelativeRates<G> relative_rates(const BeamRates<G, double, N>& b, int i) {
  const Square<G> U =
      matrix_of<G>([&](const Unit<G>& v) { return G::vector_of_motion(times(b.inverse[i], G::motion(v))); });
  const Square<G> ad =
      matrix_of<G>([&](const Unit<G>& v) { return G::vector_of_motion(G::widened(G::bracket(b.d[i], G::motion(v)))); });
  return {U, ad - U, i};
}

/// Adds factor times a block to the rows and columns of ports p, q; ports on the ground are omitted.
template <class E, class G = typename E::Group>
void add_block(const E& e, const Square<G>& block, int p, int q, double factor, int size, double* matrix) {
  if (e.ports[p].node == ground || e.ports[q].node == ground) return;
  const auto place = [&e](int port) {
    int at = 0;
    for (int k = 0; k < port; ++k) at += e.ports[k].node == ground ? 0 : G::dof;
    return at;
  };
  const auto at_node = [&e](int port) {
    return matrix_of<G>([&](const Unit<G>& v) { return G::inverse_adjoint_times(e.ports[port].offset, v); });
  };
  Square<G> b = block;
  if (e.ports[p].has_offset) b = lanes::transpose_times(at_node(p), b);
  if (e.ports[q].has_offset) b = b * at_node(q);
  for (int i = 0; i < G::dof; ++i)
    for (int j = 0; j < G::dof; ++j) matrix[(place(p) + i) * size + place(q) + j] += factor * b(i, j);
}

/// Adds factor times the matrix of d_a'^T k d_b'.
template <class E, class G = typename E::Group>
void add_pair(const E& e, const RelativeRates<G>& a, const RelativeRates<G>& b, const Square<G>& k, int r,
              double factor, int size, double* matrix) {
  const Square<G> own = k * b.own, reference = k * b.reference;
  add_block(e, Square<G>(lanes::transpose_times(a.own, own)), a.port, b.port, factor, size, matrix);
  add_block(e, Square<G>(lanes::transpose_times(a.own, reference)), a.port, r, factor, size, matrix);
  add_block(e, Square<G>(lanes::transpose_times(a.reference, own)), r, b.port, factor, size, matrix);
  add_block(e, Square<G>(lanes::transpose_times(a.reference, reference)), r, r, factor, size, matrix);
}

}  // namespace

template <class E>
void add_elastic_mass(const E& e, const FieldFor<E>& field, double factor, double* matrix) {
  using G = typename E::Group;
  constexpr int P = E::num_ports;
  if constexpr (E::has_stiffness_matrix) {
    const int size = num_unknowns(e);
    const auto anchor = anchor_of(e, field.nodes);
    PortMotionOn<G, double> p[P];
    for (int k = 0; k < P; ++k) p[k] = eval_port(e.ports[k], field.nodes, anchor);
    BeamRates<G, double, P> b;
    eval_relative_motions<G, double, P>(p, b);
    if constexpr (E::role != Role::beam) {
      const RelativeRates<G> rates = relative_rates<G, P>(b, 1);
      add_pair(e, rates, rates, e.stiffness, 0, factor, size, matrix);
    } else {
      constexpr int r = E::reference;
      RelativeRates<G> rates[P];
      for (int i = 0; i < P; ++i)
        if (i != r) rates[i] = relative_rates<G, P>(b, i);
      for (int j = 0; j < P; ++j) {
        if (j == r) continue;
        Square<G> column[P];  // K_ij, from unit rates
        for (int k = 0; k < G::dof; ++k) {
          typename G::template Wrench<double> q[P];
          for (int i = 0; i < P; ++i) {
            b.rate[i] = G::motion(Unit<G>::zero());
            q[i] = G::wrench(Unit<G>::zero());
          }
          b.rate[j] = G::motion(Unit<G>::unit(k));
          add_elastic_momentum<G, double, P, double>(e, b, 1.0, q, nullptr);
          for (int i = 0; i < P; ++i) {
            const Unit<G> entries = G::vector_of_wrench(q[i]);
            for (int l = 0; l < G::dof; ++l) column[i](l, k) = entries[l];
          }
        }
        for (int i = 0; i < P; ++i)
          if (i != r) add_pair(e, rates[i], rates[j], column[i], r, factor, size, matrix);
      }
    }
  }
}

template <class E>
void add_gyroscopic(const E& e, const FieldFor<E>& field, double factor, double* matrix) {
  using G = typename E::Group;
  if constexpr (has_mass_matrix<E>) {
    const auto anchor = anchor_of(e, field.nodes);
    for (int k = 0; k < E::num_ports; ++k) {
      double share = 1.0;
      if constexpr (E::role == Role::beam) {
        const auto& rule = mass_rule<E::num_ports>();
        share = 0.0;
        for (int g = 0; g < E::num_mass_points; ++g) share += rule.weight[g] * e.length * rule.shape[g][k];
      }
      const Unit<G> v = eval_port(e.ports[k], field.nodes, anchor).v;
      const Square<G> block = matrix_of<G>([&](const Unit<G>& a) {
        return motion::VectorsOn<G>::template dual_bracket<double>(v, Unit<G>(e.mass * a));
      });
      add_block(e, block, k, k, factor * share, num_unknowns(e), matrix);
    }
  }
}

template <class G>
void evaluate_rows(const JointOn<G>& joint, const FieldOn<G, double>& field, double turns, double* rows,
                   double* gradient) {
  const auto anchor = anchor_of(joint, field.nodes);
  PortMotionOn<G, double> p[2];
  for (int k = 0; k < 2; ++k) p[k] = eval_port(joint.ports[k], field.nodes, anchor);
  const typename G::template Pose<double> H = G::relative(p[0].H, p[1].H);
  const bool moves[2] = {joint.ports[0].node != ground, joint.ports[1].node != ground};
  double* to = gradient;
  for (int row = 0; row < joint.num_rows; ++row) {
    typename G::template Wrench<double> g;
    rows[row] = eval_row<G, double, double>(joint.rows[row], H, turns, field.around.laws, g);
    Unit<G> by_port[2];
    by_port[1] = G::vector_of_wrench(g);
    by_port[0] = -G::inverse_adjoint_transpose_times(H, by_port[1]);
    for (int k = 0; k < 2; ++k) {
      if (!moves[k]) continue;
      if (joint.ports[k].has_offset) by_port[k] = G::inverse_adjoint_transpose_times(joint.ports[k].offset, by_port[k]);
      for (int i = 0; i < G::dof; ++i) *to++ = by_port[k][i];
    }
  }
}
#define BOUGH_INSTANTIATE_ROWS(G) \
  template void evaluate_rows<G>(const JointOn<G>&, const FieldOn<G, double>&, double, double*, double*);
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE_ROWS)

template <class E>
constexpr auto momenta_of_part = std::tuple{&evaluate_momentum<E>, &add_elastic_mass<E>, &add_gyroscopic<E>};
BOUGH_EMIT_ON_EVERY_GROUP(momenta_of_part, ElementsOn)

}  // namespace bough::elements
