#include "drift.hpp"

#include <algorithm>

#include "bough/plan/sets.hpp"
#include "bough/step/system.hpp"

namespace bough::step {

namespace {

using motion::Vec3;

/// Mass and first moment at each node, in its axes: of its bodies, and of its share in beams.
struct Heap {
  double mass = 0.0;
  Vec3<double> moment = Vec3<double>::zero();
};

/// Adds `share` of the mass of a section or body with this mass matrix to the node of a port.
void heap_up(const elements::Port& port, const motion::Mat6<double>& matrix, double share, std::vector<Heap>& heaps) {
  if (port.node == elements::ground) return;
  const double mass = share * matrix(0, 0);
  Vec3<double> moment{{share * matrix(1, 5), share * matrix(2, 3), share * matrix(0, 4)}};
  if (port.has_offset) moment = mass * port.offset.x + port.offset.R * moment;
  Heap& heap = heaps[static_cast<std::size_t>(port.node)];
  heap.mass += mass;
  heap.moment += moment;
}
/// A beam's velocity is interpolated between its nodes, whose shares are the integrals of the polynomials. That is exact
/// for the linear momentum of a straight beam in rigid motion.
template <int N>
void heap_up(const elements::Beam<N>& beam, std::vector<Heap>& heaps) {
  if (!beam.has_mass) return;
  const auto& rule = elements::mass_rule<N>();
  for (int i = 0; i < N; ++i) {
    double share = 0.0;
    for (int g = 0; g < N; ++g) share += rule.weight[g] * rule.shape[g][i];
    heap_up(beam.ports[i], beam.mass, share * beam.length, heaps);
  }
}
void heap_up(const elements::RigidBody& body, std::vector<Heap>& heaps) {
  heap_up(body.ports[0], body.mass, 1.0, heaps);
}
void heap_up(const auto&, std::vector<Heap>&) {}

std::vector<Heap> heaps_of(const plan::Plan& plan) {
  std::vector<Heap> heaps(plan.nodes.size());
  plan::for_each_array(plan.elements, [&](const auto& array) {
    for (const auto& e : array) heap_up(e, heaps);
  });
  return heaps;
}

/// Joins the ports of the elements for which joins(e) holds.
plan::Sets join_ports(const plan::Plan& plan, const auto& joins) {
  plan::Sets sets(plan.nodes.size());
  for (const plan::ElementPlace& place : plan.directory)
    plan::with_element(plan.elements, place, [&](const auto& e) {
      if (!joins(e)) return;
      for (const elements::Port& port : e.ports) sets.join(sets.index(port), sets.index(e.ports[0]));
    });
  return sets;
}

/// The assembly of each node, numbered in the order of nodes; -1 where something ties a node to the ground.
std::vector<int> assemblies_of(const plan::Plan& plan) {
  plan::Sets tied = join_ports(plan, [](const auto&) { return true; });
  plan::Sets joined = join_ports(plan, [](const auto& e) {
    constexpr auto role = std::decay_t<decltype(e)>::role;
    return role == elements::Role::beam || role == elements::Role::joint;
  });
  std::vector<int> number(plan.nodes.size() + 1, -1), assembly(plan.nodes.size(), -1);
  int count = 0;
  for (std::size_t n = 0; n < assembly.size(); ++n) {
    if (tied.of(n) == tied.of(tied.ground())) continue;
    int& of_set = number[joined.of(n)];
    if (of_set < 0) of_set = count++;
    assembly[n] = of_set;
  }
  return assembly;
}

}  // namespace

template <class G>
DriftChoice<G> make_drift_choice(const plan::Plan& plan, const NodeOrder& order) {
  DriftChoice<G> choice;
  choice.fall = G::template Translation<double>::zero();
  if constexpr (G::turns) {
    const std::vector<int> assembly = assemblies_of(plan);
    const auto flying = std::count_if(assembly.begin(), assembly.end(), [](int a) { return a >= 0; });
    if (!plan.is_dynamic || flying == 0) return choice;
    const laws::Law& strength = plan.laws[static_cast<std::size_t>(plan.gravity_law)].law;
    choice.falls =
        plan.observer < 0 && strength.is_constant() && flying == static_cast<std::ptrdiff_t>(assembly.size());
    if (choice.falls) {
      const Vec3<double> gravity = strength.at(0.0, laws::Side::right).value * plan.gravity;
      if constexpr (G::has_moving_frames)
        choice.fall = gravity;
      else
        choice.fall = plan::along_axes<G>(plan, gravity);
    }
    const std::vector<Heap> heaps = heaps_of(plan);
    choice.assembly_mass.assign(static_cast<std::size_t>(*std::max_element(assembly.begin(), assembly.end())) + 1, 0.0);
    choice.eights.resize(order.eights().size());
    for (std::size_t k = 0; k < choice.eights.size(); ++k) {
      auto& eight = choice.eights[k];
      eight.mass = elements::LanePack(0.0);
      eight.moment = G::template Translation<elements::LanePack>::zero();
      for (int l = 0; l < elements::num_lanes; ++l) {
        const auto node = static_cast<std::size_t>(order.eights()[k].node[static_cast<std::size_t>(l)]);
        const int of = eight.assembly[static_cast<std::size_t>(l)] = assembly[node];
        if (l >= order.eights()[k].count || of < 0) continue;
        const Heap& heap = heaps[node];
        choice.assembly_mass[static_cast<std::size_t>(of)] += heap.mass;
        auto at = G::template Vector<double>::zero();
        plan.unknowns.project(lanes::join(heap.moment, Vec3<double>::zero()), node, &at[0]);
        eight.mass.set(l, heap.mass);
        for (int i = 0; i < G::translations; ++i) eight.moment[i].set(l, at[i]);
      }
    }
  }
  return choice;
}

template <class G>
void find_frames(const DriftChoice<G>& choice, const NodesOn<G>& nodes, const NodeOrder& order,
                 std::vector<typename G::template Translation<double>>& frames) {
  using Translation = typename G::template Translation<double>;
  frames.assign(choice.assembly_mass.size(), Translation::zero());
  if constexpr (G::turns)
    for (std::size_t k = 0; k < choice.eights.size(); ++k) {
      const auto& eight = choice.eights[k];
      for (int l = 0; l < order.eights()[k].count; ++l) {
        const int of = eight.assembly[static_cast<std::size_t>(l)];
        if (of < 0) continue;
        const auto& node = nodes.motion[static_cast<std::size_t>(order.eights()[k].node[static_cast<std::size_t>(l)])];
        const Translation momentum =
            eight.mass[l] * G::linear(node.v) + G::spin(node.v, lanes::get_lane(eight.moment, l));
        Translation& sum = frames[static_cast<std::size_t>(of)];
        sum = sum + G::turned(typename G::template Pose<double>{node.R, Translation::zero()}, momentum);
      }
    }
  for (std::size_t a = 0; a < frames.size(); ++a)
    if (choice.assembly_mass[a] > 0.0) frames[a] = (1.0 / choice.assembly_mass[a]) * frames[a];
}

#define BOUGH_INSTANTIATE(G)                                                               \
  template DriftChoice<G> make_drift_choice<G>(const plan::Plan&, const NodeOrder&);       \
  template void find_frames<G>(const DriftChoice<G>&, const NodesOn<G>&, const NodeOrder&, \
                               std::vector<typename G::template Translation<double>>&);
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE)
#undef BOUGH_INSTANTIATE

}  // namespace bough::step
