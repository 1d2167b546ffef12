#include "bough/step/motion_tree.hpp"

#include <algorithm>

#include "bough/elements/strain_path.hpp"
#include "bough/plan/sets.hpp"
#include "bough/step/corrections.hpp"
#include "element_parts.hpp"

namespace bough::step {

namespace {

struct Edge {
  int rank;          ///< edges of lower rank are added to the tree first
  int a, b;          ///< nodes, or -1 for the inertial frame; a of a beam is its reference node
  int section = -1;  ///< index of the beam's section; -1: other elements
};

/// Edges of all elements that connect nodes, sorted by rank and, within a rank, in the order of the elements. The
/// sections of beams are numbered in the order of the elements, too. Nodes without unknowns come first: they belong to
/// the ground, and a beam between two of them closes a loop.
std::vector<Edge> edges_of(const plan::Plan& plan) {
  std::vector<Edge> edges;
  for (const plan::HeldNode& held : plan.held) edges.push_back({-1, -1, held.node});
  int section = 0;
  for (const plan::ElementPlace& place : plan.directory)
    plan::with_element(plan.elements, place, [&](const auto& e) {
      using E = std::decay_t<decltype(e)>;
      if constexpr (E::role == elements::Role::beam) {
        for (int i = 0; i < E::num_ports; ++i)
          if (i != E::reference) edges.push_back({0, e.ports[E::reference].node, e.ports[i].node, section++});
      } else if constexpr (E::role == elements::Role::joint) {
        edges.push_back({10 - e.num_rows, e.ports[0].node, e.ports[1].node});
      } else if constexpr (E::role == elements::Role::coupling) {
        edges.push_back({20, e.ports[0].node, e.ports[1].node});
      }
    });
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) { return x.rank < y.rank; });
  return edges;
}

/// Adds the groups of beams of N nodes. The directory lists one array after the other, so the sections of these beams
/// have consecutive numbers.
template <int N>
void add_groups(const plan::Plan& plan, MotionTree& tree, int& section) {
  const auto count = static_cast<int>(plan::array_of<elements::Beam<N>>(plan.elements).size());
  for (int first = 0; first < count; first += elements::num_lanes) {
    const int some = std::min(elements::num_lanes, count - first);
    tree.beams.push_back({N, first, some, section});
    section += some * (N - 1);
  }
}

}  // namespace

MotionTree make_motion_tree(const plan::Plan& plan) {
  const std::size_t n = plan.nodes.size();  // vertex n represents the inertial frame
  const auto vertex = [n](int node) { return node < 0 ? n : static_cast<std::size_t>(node); };
  plan::Sets sets(n);
  std::vector<std::vector<MotionTree::Link>> neighbours(n + 1);
  MotionTree tree;
  const auto is_point = [&plan](int node) { return node >= 0 && plan.nodes[static_cast<std::size_t>(node)].is_point; };
  for (const Edge& edge : edges_of(plan)) {
    // A point that hung from another part would turn with it.
    if (is_point(edge.a) || is_point(edge.b)) continue;
    const std::size_t a = vertex(edge.a), b = vertex(edge.b);
    if (sets.of(a) == sets.of(b)) continue;
    sets.join(a, b);
    const int section = edge.a < 0 || edge.b < 0 ? -1 : edge.section;
    neighbours[a].push_back({edge.a, edge.b, section, false});
    neighbours[b].push_back({edge.b, edge.a, section, true});
  }
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
  for (std::size_t v = 0; v < n; ++v)  // parts that are not connected to the inertial frame
    if (!reached[v]) {
      tree.links.push_back({-1, static_cast<int>(v)});
      spread(v);
    }
  int section = 0;
  add_groups<2>(plan, tree, section);
  add_groups<3>(plan, tree, section);
  add_groups<4>(plan, tree, section);
  tree.sections.resize(static_cast<std::size_t>(section));
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

/// The rigid motion exp(eta).
RigidMotion motion_of(const Vec6<double>& eta) {
  return {motion::exp_quaternion(lanes::angular_part(eta)), motion::Se3::exp(eta).x};
}

/// R(q) x - x without cancellation for small turns.
Vec3<double> turned_by(const Quaternion<double>& q, const Vec3<double>& x) {
  return 2.0 * lanes::cross(q.v, lanes::cross(q.v, x) + q.w * x);
}

/// The motion S of a port with offset O, as a motion of its node:  O S O^-1.
RigidMotion seen_from_node(const Frame<double>& O, const RigidMotion& S) {
  const Quaternion<double> turn{S.turn.w, O.R * S.turn.v};
  return {turn, O.R * S.shift - turned_by(turn, O.x)};
}

RigidMotion inverse(const RigidMotion& S) {
  const Quaternion<double> back = motion::conjugate(S.turn);
  return {back, -(S.shift + turned_by(back, S.shift))};
}

using elements::LanePack;
using elements::num_lanes;

/// Computes the motions of the sections of a group of beams. correction(node): Newton correction of a node, (linear;
/// angular) in its own axes.
template <int N, class Correction>
void move_sections(const plan::Plan& plan, const MotionTree::BeamGroup& group, const elements::Field& field,
                   Correction&& correction, double factor, MotionTree::Section* sections) {
  const auto* beams = plan::array_of<elements::Beam<N>>(plan.elements).data() + group.first_beam;
  elements::PortMotion<LanePack> ports[N];
  Vec6<LanePack> eta[N], strain_rates[N - 1];
  for (int lane = 0; lane < num_lanes; ++lane) {  // unused lanes repeat the last beam
    const elements::Beam<N>& e = beams[std::min(lane, group.count - 1)];
    const auto anchor = elements::anchor_of(e, field.nodes);
    for (int i = 0; i < N; ++i) {
      const elements::PortMotion<double> port = elements::eval_port(e.ports[i], field.nodes, anchor, field.carriers);
      lanes::set_lane(ports[i].H.R, lane, port.H.R);
      lanes::set_lane(ports[i].H.x, lane, port.H.x);
      const bool moves = e.ports[i].node != elements::ground;
      const Vec6<double> own = moves ? correction(e.ports[i].node) : Vec6<double>::zero();
      lanes::set_lane(eta[i], lane, motion::inverse_adjoint_times(e.ports[i].offset, own));
    }
  }
  elements::SectionWay<LanePack> ways[N - 1];
  elements::eval_strain_path<N>(ports, eta, LanePack(factor), ways, strain_rates);
  for (int lane = 0; lane < group.count; ++lane)
    for (int i = 0, k = 0; i < N; ++i) {
      if (i == elements::Beam<N>::reference) continue;
      const elements::SectionWay<LanePack>& way = ways[k];
      const RigidMotion S{{way.turn.w[lane], lanes::get_lane(way.turn.v, lane)}, lanes::get_lane(way.shift, lane)};
      MotionTree::Section& section = *sections++;
      section.motion = seen_from_node(beams[lane].ports[i].offset, S);
      section.end = lanes::get_lane(way.end, lane);
      section.strain_rate = lanes::get_lane(strain_rates[k++], lane);
    }
}

/// Computes the twists of the sections at the end of the path.
template <int N>
void turn_sections(const plan::Plan& plan, const MotionTree::BeamGroup& group, MotionTree::Section* sections) {
  const auto* beams = plan::array_of<elements::Beam<N>>(plan.elements).data() + group.first_beam;
  Vec6<LanePack> ends[N - 1], strain_rates[N - 1], twists[N - 1];
  for (int lane = 0; lane < num_lanes; ++lane)
    for (int k = 0; k < N - 1; ++k) {
      const MotionTree::Section& section = sections[std::min(lane, group.count - 1) * (N - 1) + k];
      lanes::set_lane(ends[k], lane, section.end);
      lanes::set_lane(strain_rates[k], lane, section.strain_rate);
    }
  elements::eval_strain_path_twists<N>(ends, strain_rates, twists);
  for (int lane = 0; lane < group.count; ++lane)
    for (int i = 0, k = 0; i < N; ++i)
      if (i != elements::Beam<N>::reference)
        (sections++)->twist = motion::adjoint_times(beams[lane].ports[i].offset, lanes::get_lane(twists[k++], lane));
}

/// Moves a node, H <- H S.
void carry(const plan::Plan&, const RigidMotion& S, SpatialNodes& nodes, std::size_t n) {
  elements::NodeMotion& node = nodes.motion[n];
  node.x.add(node.R * S.shift);
  nodes.rotation[n] = motion::normalise(motion::multiply(nodes.rotation[n], S.turn));
  node.R = motion::rotation_of(nodes.rotation[n]);
}
/// The same on another group: in a plane, S rotates about the plane's normal and translates along the plane.
template <class G>
void carry(const plan::Plan& plan, const RigidMotion& S, NodesOn<G>& nodes, std::size_t n) {
  const motion::Mat3<double>& B = std::get<plan::ModelOn<G>>(plan.model).nodes[n].basis;
  const Vec3<double> shift = lanes::transpose_times(B, S.shift);
  auto& node = nodes.motion[n];
  typename G::template Translation<double> along;
  for (int i = 0; i < G::translations; ++i) along[i] = shift[i];
  node.x.add(G::turned({node.R, {}}, along));
  if constexpr (G::turns) {
    const Vec3<double> half = lanes::transpose_times(B, S.turn.v);
    const motion::Vec2<double> turn{{S.turn.w * S.turn.w - half[2] * half[2], 2.0 * S.turn.w * half[2]}};
    node.R = motion::complex_times(node.R, turn);
    node.R = (1.5 - 0.5 * lanes::dot(node.R, node.R)) * node.R;  // normalised to first order
  }
}

/// Calls f with the number of nodes as a compile-time constant.
template <class F>
void with_num_nodes(int num_nodes, F&& f) {
  if (num_nodes == 2) return f(std::integral_constant<int, 2>{});
  if (num_nodes == 3) return f(std::integral_constant<int, 3>{});
  f(std::integral_constant<int, 4>{});
}

}  // namespace

void Corrections::apply_along_tree(State& state, const double* x, double factor) {
  PhaseTimer timer{clock_, counts_.update};
  MotionTree& tree = motion_tree_;
  const elements::Field before = instant_.field(state);
  auto by_group = [&](std::int64_t begin, std::int64_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      with_num_nodes(tree.beams[k].num_nodes, [&](auto n) {
        move_sections<n()>(
            plan_, tree.beams[k], before, [&](int node) { return places_.node_part(x, node); }, factor,
            tree.sections.data() + tree.beams[k].first_section);
      });
  };
  walker_.for_each_chunk(static_cast<std::int64_t>(tree.beams.size()), batch_grain, tree::make_chunk(by_group));
  for (const MotionTree::Link& link : tree.links) {
    const auto node = static_cast<std::size_t>(link.node);
    const Vec6<double> eta = places_.node_part(x, link.node);
    if (link.parent < 0) {
      tree.own_twists[node] = eta;
      tree.motions[node] = motion_of(factor * eta);
      continue;
    }
    const auto parent = static_cast<std::size_t>(link.parent);
    const elements::NodeMotion &a = before.nodes[parent], &b = before.nodes[node];
    const Frame<double> H{lanes::transpose_times(a.R, b.R), lanes::transpose_times(a.R, motion::difference(b.x, a.x))};
    RigidMotion own;
    if (link.section < 0) {  // joints take their relative increment exactly: hinges rotate, slides translate
      tree.own_twists[node] = eta - motion::inverse_adjoint_times(H, places_.node_part(x, link.parent));
      own = motion_of(factor * tree.own_twists[node]);
    } else {
      const MotionTree::Section& section = tree.sections[static_cast<std::size_t>(link.section)];
      own = link.to_reference ? seen_from_node(motion::inverse(H), inverse(section.motion)) : section.motion;
    }
    const RigidMotion& S = tree.motions[parent];
    const RigidMotion carried{{S.turn.w, lanes::transpose_times(H.R, S.turn.v)},
                              lanes::transpose_times(H.R, turned_by(S.turn, H.x) + S.shift)};
    tree.motions[node] = {motion::normalise(motion::multiply(carried.turn, own.turn)),
                          carried.shift + own.shift + turned_by(carried.turn, own.shift)};
    tree.relative[node] = motion::compose(H, Frame<double>{motion::rotation_of(own.turn), own.shift});
  }
  state.change_all([&](auto& nodes) {
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) carry(plan_, tree.motions[n], nodes, n);
  });
  add_multipliers(state, x, factor);
}

double Corrections::power_along_tree(const double* forces, const double* x) {
  MotionTree& tree = motion_tree_;
  auto by_group = [&](std::int64_t begin, std::int64_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      with_num_nodes(tree.beams[k].num_nodes, [&](auto n) {
        turn_sections<n()>(plan_, tree.beams[k], tree.sections.data() + tree.beams[k].first_section);
      });
  };
  walker_.for_each_chunk(static_cast<std::int64_t>(tree.beams.size()), batch_grain, tree::make_chunk(by_group));
  double power = 0.0;
  for (const MotionTree::Link& link : tree.links) {
    const auto node = static_cast<std::size_t>(link.node);
    tree.twists[node] = tree.own_twists[node];
    if (link.section >= 0) {  // the section's twist is relative to its reference node, which is the parent or this node
      const Vec6<double>& twist = tree.sections[static_cast<std::size_t>(link.section)].twist;
      tree.twists[node] = link.to_reference ? -motion::inverse_adjoint_times(tree.relative[node], twist) : twist;
    }
    if (link.parent >= 0)
      tree.twists[node] +=
          motion::inverse_adjoint_times(tree.relative[node], tree.twists[static_cast<std::size_t>(link.parent)]);
    power += lanes::dot(places_.node_part(forces, link.node), tree.twists[node]);
  }
  for (const UnknownPlaces::Multiplier& at : places_.multipliers()) power += forces[at.unknown] * x[at.unknown];
  for (const std::size_t unknown : places_.signals()) power += forces[unknown] * x[unknown];
  return power;
}

}  // namespace bough::step
