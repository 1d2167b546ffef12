#include "drift.hpp"

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

}  // namespace

template <class G>
DriftChoice<G> make_drift_choice(const plan::Plan& plan, const NodeOrder& order) {
  DriftChoice<G> choice;
  choice.fall = G::template Translation<double>::zero();
  if constexpr (G::turns) {
    if (!plan.is_dynamic) return choice;
    const laws::Law& strength = plan.laws[static_cast<std::size_t>(plan.gravity_law)].law;
    choice.falls = plan.observer < 0 && strength.is_constant();
    if (choice.falls) {
      const Vec3<double> gravity = strength.at(0.0, laws::Side::right).value * plan.gravity;
      if constexpr (G::has_moving_frames)
        choice.fall = gravity;
      else
        choice.fall = plan::along_axes<G>(plan, gravity);
    }
    const std::vector<Heap> heaps = heaps_of(plan);
    choice.centers.resize(order.eights().size());
    for (std::size_t k = 0; k < choice.centers.size(); ++k)
      for (std::size_t l = 0; l < order.eights()[k].node.size(); ++l) {
        const auto node = static_cast<std::size_t>(order.eights()[k].node[l]);
        const Heap& heap = heaps[node];
        Vec3<double> center = Vec3<double>::zero();
        if (heap.mass > 0.0) center = (1.0 / heap.mass) * heap.moment;
        auto at = G::template Vector<double>::zero();
        plan.unknowns.project(lanes::join(center, Vec3<double>::zero()), node, &at[0]);
        for (int i = 0; i < G::translations; ++i) choice.centers[k][i].set(static_cast<int>(l), at[i]);
      }
  }
  return choice;
}

#define BOUGH_INSTANTIATE(G) template DriftChoice<G> make_drift_choice<G>(const plan::Plan&, const NodeOrder&);
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE)

}  // namespace bough::step
