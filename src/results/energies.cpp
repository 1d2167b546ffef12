#include "bough/results/energies.hpp"

#include <algorithm>

#include "bough/elements/evaluate.hpp"
#include "observe_parts.hpp"

namespace bough::results {

using elements::EnergiesOf;
using elements::LanePack;

namespace {

constexpr int least_lanes = 3;
constexpr std::int64_t chunk_groups = 32;

template <class E>
bool stores_energy(const E&) {
  return true;
}
bool stores_energy(const elements::Joint& e) {
  return std::any_of(e.efforts, e.efforts + e.num_efforts, [](const auto& effort) { return effort.stiffness != 0.0; });
}

void add(elements::Energies& sum, const elements::Energies& e) {
  sum.kinetic += e.kinetic;
  sum.strain += e.strain;
  sum.momentum += e.momentum;
  sum.mass += e.mass;
  sum.mass_moment += e.mass_moment;
}

elements::Energies lane_of(const EnergiesOf<LanePack>& all, int lane) {
  elements::Energies e;
  e.kinetic = all.kinetic[lane];
  e.strain = all.strain[lane];
  e.mass = all.mass[lane];
  for (int i = 0; i < 6; ++i) e.momentum[i] = all.momentum[i][lane];
  for (int i = 0; i < 3; ++i) e.mass_moment[i] = all.mass_moment[i][lane];
  return e;
}

}  // namespace

EnergyMeter::EnergyMeter(const plan::Plan& plan) : stores_(plan::energy_stores(plan)) {
  std::apply([&](auto&... kind) { (sort(plan, kind), ...); }, kinds_);
}

template <class E>
void EnergyMeter::sort(const plan::Plan& plan, Kind<E>& kind) {
  const std::vector<E>& array = plan::array_of<E>(plan.elements);
  const int size = static_cast<int>(array.size());
  const auto element = [&array](int i) -> const E& { return array[static_cast<std::size_t>(i)]; };
  for (int first = 0; first < size;) {
    if (!stores_energy(element(first))) {
      ++first;
      continue;
    }
    Group<E> group{first, 1};
    while (group.count < elements::num_lanes && first + group.count < size && plan.frames.empty() &&
           stiffness_law(element(first)) < 0 && stores_energy(element(first + group.count)) &&
           may_share_lanes(element(first), element(first + group.count)))
      ++group.count;
    kind.groups.push_back(group);
    first += group.count;
  }
  const auto takes_lanes = [](const Group<E>& group) { return group.count >= least_lanes; };
  // Reserves space: lanes have some ten kB each, and a growing array would copy them several times.
  kind.lanes.reserve(static_cast<std::size_t>(std::count_if(kind.groups.begin(), kind.groups.end(), takes_lanes)));
  int nodes[E::num_ports];
  for (int p = 0; p < E::num_ports; ++p) nodes[p] = p;
  for (Group<E>& group : kind.groups) {
    if (!takes_lanes(group)) continue;
    const E* list[elements::num_lanes];
    for (int i = 0; i < group.count; ++i) list[i] = &element(group.first + i);
    group.lanes = static_cast<int>(kind.lanes.size());
    kind.lanes.push_back(elements::make_lane_element<E>(list, group.count, nodes, 0));
  }
}

template <class E>
void EnergyMeter::add_group(const std::vector<E>& array, const Kind<E>& kind, const Group<E>& group,
                            const step::State& state, const elements::Field& field, elements::Energies& sum) const {
  const auto turns_of = [&turns_of_joints = state.turns](int i) {
    // Joints of a plan are in the order of their elements.
    return E::role == elements::Role::joint ? turns_of_joints[static_cast<std::size_t>(i)] : 0.0;
  };
  if (group.lanes < 0) {
    for (int i = group.first; i < group.first + group.count; ++i)
      results::add(sum, elements::eval_energies(array[static_cast<std::size_t>(i)], field, turns_of(i)));
    return;
  }
  const double* from[E::num_ports][elements::num_lanes] = {};
  LanePack turns(0.0);
  for (int l = 0; l < elements::num_lanes; ++l) {
    const int i = group.first + std::min(l, group.count - 1);
    const E& e = array[static_cast<std::size_t>(i)];
    for (int p = 0; p < E::num_ports; ++p)
      if (e.ports[p].node != elements::ground)
        from[p][l] = elements::numbers_of(field.nodes[static_cast<std::size_t>(e.ports[p].node)]);
    turns.set(l, turns_of(i));
  }
  elements::NodeLanes nodes[E::num_ports];
  for (int p = 0; p < E::num_ports; ++p)
    if (from[p][0] != nullptr) elements::set_lanes(nodes[p], from[p]);
  elements::FieldLanes around;
  around.nodes = nodes;
  around.around.has_inertia = field.around.has_inertia;
  EnergiesOf<LanePack> all;
  elements::eval_energies_lanes<E>(kind.lanes[static_cast<std::size_t>(group.lanes)], around, turns, all);
  for (int l = 0; l < group.count; ++l) results::add(sum, lane_of(all, l));
}

template <class E>
void EnergyMeter::add(const step::System& system, const step::State& state, const Kind<E>& kind,
                      elements::Energies& sum) {
  const auto count = static_cast<std::int64_t>(kind.groups.size());
  if (count == 0) return;
  const elements::Field field = system.instant().field(state);
  const std::vector<E>& array = plan::array_of<E>(system.plan().elements);
  parts_.assign(static_cast<std::size_t>((count + chunk_groups - 1) / chunk_groups), {});
  auto body = [&](std::int64_t begin, std::int64_t end) {
    elements::Energies& part = parts_[static_cast<std::size_t>(begin / chunk_groups)];
    for (std::int64_t g = begin; g < end; ++g)
      add_group(array, kind, kind.groups[static_cast<std::size_t>(g)], state, field, part);
  };
  system.walker().for_each_chunk(count, chunk_groups, tree::make_chunk(body));
  for (const elements::Energies& part : parts_) results::add(sum, part);
}

/// Energy of efforts that are laws of their coordinates.
double EnergyMeter::stored(const step::System& system, const step::State& state) const {
  double sum = 0.0;
  const elements::Field field = system.instant().field(state);
  for (const plan::EnergyStore& store : stores_) {
    const elements::Joint& joint = plan::joint_element(system.plan(), store.joint);
    const double turns = state.turns[static_cast<std::size_t>(store.joint)];
    sum -= store.supplied
               .at(elements::eval_joint_coordinate(joint, joint.efforts[store.effort].coordinate, field, turns).value)
               .value;
  }
  return sum;
}

Energies EnergyMeter::eval(const step::System& system, const step::State& state) {
  elements::Energies sum;
  std::apply([&](const auto&... kind) { (add(system, state, kind, sum), ...); }, kinds_);
  if (!stores_.empty()) sum.strain += stored(system, state);
  const elements::Field field = system.instant().field(state);
  Energies e;
  e.kinetic = sum.kinetic;
  e.strain = sum.strain;
  e.potential = -lanes::dot(field.around.gravity, sum.mass_moment);
  // Elements give momentum in the axes of the frame in which nodes are described.
  e.momentum = field.observer == nullptr ? sum.momentum : turned(field.observer->pose.R, sum.momentum);
  return e;
}

}  // namespace bough::results
