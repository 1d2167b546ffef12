#include "drift.hpp"

#include <algorithm>
#include <numeric>

#include "bough/step/system.hpp"

namespace bough::step {

namespace {

using motion::Vec3;

/// Mass and first moment of the bodies at each node, in its axes.
struct Heap {
  double mass = 0.0;
  Vec3<double> moment = Vec3<double>::zero();
};
std::vector<Heap> heaps_of(const plan::Plan& plan) {
  std::vector<Heap> heaps(plan.nodes.size());
  for (const elements::RigidBody& body : plan::array_of<elements::RigidBody>(plan.elements)) {
    const elements::Port& port = body.ports[0];
    if (port.node == elements::ground) continue;
    const double mass = body.mass(0, 0);
    Vec3<double> moment{{body.mass(1, 5), body.mass(2, 3), body.mass(0, 4)}};
    if (port.has_offset) moment = mass * port.offset.x + port.offset.R * moment;
    Heap& heap = heaps[static_cast<std::size_t>(port.node)];
    heap.mass += mass;
    heap.moment += moment;
  }
  return heaps;
}

/// Whether nothing ties a node to the ground, by node.
std::vector<bool> nodes_in_flight(const plan::Plan& plan) {
  const std::size_t n = plan.nodes.size();  // vertex n: the ground
  std::vector<std::size_t> set(n + 1);
  std::iota(set.begin(), set.end(), std::size_t{0});
  const auto root_of = [&set](std::size_t v) {
    while (set[v] != v) v = set[v] = set[set[v]];
    return v;
  };
  const auto vertex = [n](int node) { return node < 0 ? n : static_cast<std::size_t>(node); };
  for (const plan::ElementPlace& place : plan.directory)
    plan::with_element(plan.elements, place, [&](const auto& e) {
      for (const elements::Port& port : e.ports) set[root_of(vertex(port.node))] = root_of(vertex(e.ports[0].node));
    });
  std::vector<bool> flies(n);
  for (std::size_t v = 0; v < n; ++v) flies[v] = root_of(v) != root_of(n);
  return flies;
}

}  // namespace

template <class G>
DriftChoice<G> make_drift_choice(const plan::Plan& plan, const NodeOrder& order) {
  DriftChoice<G> choice;
  choice.fall = G::template Translation<double>::zero();
  if constexpr (G::turns) {
    const std::vector<bool> flies = nodes_in_flight(plan);
    const auto flying = std::count(flies.begin(), flies.end(), true);
    if (!plan.is_dynamic || flying == 0) return choice;
    const laws::Law& strength = plan.laws[static_cast<std::size_t>(plan.gravity_law)].law;
    choice.falls = plan.observer < 0 && strength.is_constant() && flying == static_cast<std::ptrdiff_t>(flies.size());
    if (choice.falls) {
      const Vec3<double> gravity = strength.at(0.0, laws::Side::right).value * plan.gravity;
      if constexpr (G::has_moving_frames)
        choice.fall = gravity;
      else
        choice.fall = plan::along_axes<G>(plan, gravity);
    }
    const std::vector<Heap> heaps = heaps_of(plan);
    choice.eights.resize(order.eights().size());
    for (std::size_t k = 0; k < choice.eights.size(); ++k)
      for (std::size_t l = 0; l < order.eights()[k].node.size(); ++l) {
        const auto node = static_cast<std::size_t>(order.eights()[k].node[l]);
        const Heap& heap = heaps[node];
        Vec3<double> center = Vec3<double>::zero();
        if (heap.mass > 0.0) center = (1.0 / heap.mass) * heap.moment;
        auto at = G::template Vector<double>::zero();
        plan.unknowns.project(lanes::join(center, Vec3<double>::zero()), node, &at[0]);
        for (int i = 0; i < G::translations; ++i) choice.eights[k].center[i].set(static_cast<int>(l), at[i]);
        choice.eights[k].flies.set(static_cast<int>(l), flies[node] ? 1.0 : 0.0);
      }
  }
  return choice;
}

#define BOUGH_INSTANTIATE(G) template DriftChoice<G> make_drift_choice<G>(const plan::Plan&, const NodeOrder&);
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE)

}  // namespace bough::step
