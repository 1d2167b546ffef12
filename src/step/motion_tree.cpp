#include "bough/step/motion_tree.hpp"

#include <algorithm>
#include <numeric>

#include "bough/step/system.hpp"
#include "system_parts.hpp"

namespace bough::step {

namespace {

struct Edge {
  int rank;                                                   ///< lower ones are taken up first
  int a, b;                                                   ///< nodes, or -1: the inertial frame
  const elements::Port *port_a = nullptr, *port_b = nullptr;  ///< beams: where their sections are
};

/// Edges of all elements between nodes, in the order of the elements, sorted by rank.
std::vector<Edge> edges_of(const plan::Plan& plan) {
  std::vector<Edge> edges;
  for (const plan::ElementPlace& place : plan.directory)
    plan::with_element(plan.elements, place, [&](const auto& e) {
      using E = std::decay_t<decltype(e)>;
      if constexpr (requires { e.reference_strain; }) {
        const elements::Port& r = e.ports[E::reference];  // relative to which the element measures
        for (const elements::Port& p : e.ports)
          if (&p != &r) edges.push_back({0, r.node, p.node, &r, &p});
      } else if constexpr (std::is_same_v<E, elements::Joint>) {
        edges.push_back({10 - e.num_rows, e.ports[0].node, e.ports[1].node});
      } else if constexpr (std::is_same_v<E, elements::Spring> || std::is_same_v<E, elements::Bushing>) {
        edges.push_back({20, e.ports[0].node, e.ports[1].node});
      }
    });
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) { return x.rank < y.rank; });
  return edges;
}

}  // namespace

MotionTree make_motion_tree(const plan::Plan& plan) {
  const std::size_t n = plan.nodes.size();  // vertex n stands for the inertial frame
  const auto vertex = [n](int node) { return node < 0 ? n : static_cast<std::size_t>(node); };
  std::vector<std::size_t> set(n + 1);
  std::iota(set.begin(), set.end(), std::size_t{0});
  const auto root_of = [&set](std::size_t v) {
    while (set[v] != v) v = set[v] = set[set[v]];
    return v;
  };
  std::vector<std::vector<MotionTree::Link>> neighbours(n + 1);
  for (const Edge& edge : edges_of(plan)) {
    const std::size_t a = vertex(edge.a), b = vertex(edge.b);
    if (root_of(a) == root_of(b)) continue;
    set[root_of(a)] = root_of(b);
    neighbours[a].push_back({edge.a, edge.b, edge.port_a, edge.port_b});
    neighbours[b].push_back({edge.b, edge.a, edge.port_b, edge.port_a});
  }
  MotionTree tree;
  tree.links.reserve(n);
  std::vector<bool> reached(n + 1, false);
  std::vector<std::size_t> front;
  const auto spread = [&](std::size_t from) {
    reached[from] = true;
    front.assign(1, from);
    for (std::size_t k = 0; k < front.size(); ++k)
      for (const MotionTree::Link& link : neighbours[front[k]]) {
        const std::size_t next = vertex(link.node);
        if (reached[next]) continue;
        reached[next] = true;
        tree.links.push_back(link);
        front.push_back(next);
      }
  };
  spread(n);
  for (std::size_t v = 0; v < n; ++v)  // parts that nothing ties to the inertial frame
    if (!reached[v]) {
      tree.links.push_back({-1, static_cast<int>(v)});
      spread(v);
    }
  tree.motions.resize(n);
  tree.relative.assign(n, motion::Frame<double>::identity());
  tree.own_twists.assign(n, motion::Vec6<double>::zero());
  tree.twists = tree.own_twists;
  return tree;
}

namespace {

using motion::Frame;
using motion::Quaternion;
using motion::Vec3;
using motion::Vec6;

/// exp(eta).
RigidMotion motion_of(const Vec6<double>& eta) {
  return {motion::exp_quaternion(lanes::angular_part(eta)), motion::Se3::exp(eta).x};
}

/// R(q) x - x without cancellation for small turns.
Vec3<double> turned_by(const Quaternion<double>& q, const Vec3<double>& x) {
  return 2.0 * lanes::cross(q.v, lanes::cross(q.v, x) + q.w * x);
}

/// A port's motion S as one of the node that carries it at O:  O S O^-1.
RigidMotion seen_from_node(const Frame<double>& O, const RigidMotion& S) {
  const Quaternion<double> turn{S.turn.w, O.R * S.turn.v};
  return {turn, O.R * S.shift - turned_by(turn, O.x)};
}

constexpr double small_turn =
    1e-5;  ///< below, exp(eta) serves beams, too: it differs by eta^2 / 12, and keeps all digits

/// Motion of a node that its parent sees at H, for an increment of their relative motion; `twist` is its derivative in the factor.
/// A beam's strain is linear in the logarithm of the relative motion of its sections, which therefore takes the increment,
///   H^-1 exp(log(H) + factor T^-1 eta);
/// elsewhere exp(factor eta): hinges and slides turn and slide by it exactly.
RigidMotion relative_motion(const MotionTree::Link& link, const Frame<double>& H, const Vec6<double>& eta,
                            double factor, Vec6<double>& twist) {
  const Vec3<double> turn = lanes::angular_part(eta);
  if (link.port == nullptr || lanes::dot(turn, turn) < small_turn * small_turn) {
    twist = eta;
    return motion_of(factor * eta);
  }
  const Frame<double>&Oa = link.parent_port->offset, &Ob = link.port->offset;
  const Frame<double> section = motion::relative(Oa, motion::compose(H, Ob));
  const Vec6<double> d = motion::Se3::log(section);
  const Vec6<double> change = motion::Se3::inverse_tangent_times(d, motion::inverse_adjoint_times(Ob, eta));
  const Vec6<double> next = d + factor * change;
  twist = motion::adjoint_times(Ob, motion::Se3::tangent_times(next, change));
  const Frame<double> S = motion::relative(section, motion::Se3::exp(next));
  return seen_from_node(Ob, {motion::quaternion_of(S.R), S.x});
}

}  // namespace

void System::apply_along_tree(State& state, const double* x, double factor) {
  PhaseTimer timer{clock_, counts_.update};
  MotionTree& tree = motion_tree_;
  for (const MotionTree::Link& link : tree.links) {
    const auto node = static_cast<std::size_t>(link.node);
    const Vec6<double> eta = node_part(x, link.node);
    if (link.parent < 0) {
      tree.own_twists[node] = eta;
      tree.motions[node] = motion_of(factor * eta);
      continue;
    }
    const auto parent = static_cast<std::size_t>(link.parent);
    const elements::NodeMotion &a = state.nodes[parent], &b = state.nodes[node];
    const Frame<double> H{lanes::transpose_times(a.R, b.R), lanes::transpose_times(a.R, motion::difference(b.x, a.x))};
    const RigidMotion own = relative_motion(link, H, eta - motion::inverse_adjoint_times(H, node_part(x, link.parent)),
                                            factor, tree.own_twists[node]);
    const RigidMotion& S = tree.motions[parent];
    const RigidMotion carried{{S.turn.w, lanes::transpose_times(H.R, S.turn.v)},
                              lanes::transpose_times(H.R, turned_by(S.turn, H.x) + S.shift)};
    tree.motions[node] = {motion::normalise(motion::multiply(carried.turn, own.turn)),
                          carried.shift + own.shift + turned_by(carried.turn, own.shift)};
    tree.relative[node] = motion::compose(H, Frame<double>{motion::rotation_of(own.turn), own.shift});
  }
  for (std::size_t n = 0; n < state.nodes.size(); ++n) {
    elements::NodeMotion& node = state.nodes[n];
    const RigidMotion& S = tree.motions[n];
    node.x.add(node.R * S.shift);
    state.rotation[n] = motion::normalise(motion::multiply(state.rotation[n], S.turn));
    node.R = motion::rotation_of(state.rotation[n]);
  }
  add_multipliers(state, x, factor);
}

double System::power_along_tree(const double* x) {
  MotionTree& tree = motion_tree_;
  double power = 0.0;
  for (const MotionTree::Link& link : tree.links) {
    const auto node = static_cast<std::size_t>(link.node);
    tree.twists[node] = tree.own_twists[node];
    if (link.parent >= 0)
      tree.twists[node] +=
          motion::inverse_adjoint_times(tree.relative[node], tree.twists[static_cast<std::size_t>(link.parent)]);
    power += lanes::dot(node_part(residual_.data(), link.node), tree.twists[node]);
  }
  for_each_multiplier(
      *this, [&](int, std::size_t, std::size_t unknown, std::size_t) { power += residual_[unknown] * x[unknown]; });
  return power;
}

}  // namespace bough::step
