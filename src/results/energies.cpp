#include "bough/results/energies.hpp"

#include <algorithm>
#include <tuple>
#include <type_traits>

#include "bough/elements/energies.hpp"
#include "bough/elements/evaluate.hpp"
#include "observe_parts.hpp"

namespace bough::results {

using elements::EnergiesOn;
using elements::LanePack;
using motion::Vec3;

namespace {

constexpr int least_lanes = 3;
constexpr std::int64_t chunk_groups = 32;

template <class E>
bool stores_energy(const E& e) {
  if constexpr (E::role == elements::Role::joint)
    return std::any_of(e.efforts, e.efforts + e.num_efforts,
                       [](const auto& effort) { return effort.stiffness != 0.0; });
  else
    return true;
}

template <class G>
void add(EnergiesOn<G, double>& sum, const EnergiesOn<G, double>& e) {
  sum.kinetic += e.kinetic;
  sum.strain += e.strain;
  sum.momentum += e.momentum;
  sum.mass += e.mass;
  sum.mass_moment += e.mass_moment;
}

template <class G>
EnergiesOn<G, double> lane_of(const EnergiesOn<G, LanePack>& all, int lane) {
  EnergiesOn<G, double> e;
  e.kinetic = all.kinetic[lane];
  e.strain = all.strain[lane];
  e.mass = all.mass[lane];
  for (int i = 0; i < G::dof; ++i) e.momentum[i] = all.momentum[i][lane];
  for (int i = 0; i < G::translations; ++i) e.mass_moment[i] = all.mass_moment[i][lane];
  return e;
}

/// A vector with these components along the axes of a reduced model.
template <int N>
Vec3<double> in_space(const motion::Mat3<double>& axes, const lanes::Vec<double, N>& u) {
  Vec3<double> v = u[0] * lanes::column(axes, 0);
  for (int i = 1; i < N; ++i) v += u[i] * lanes::column(axes, i);
  return v;
}

/// Elements of the plan's array, one after another.
struct Group {
  int first = 0, count = 0;
  int lanes = -1;  ///< in Kind::lanes; -1: they are evaluated one by one
};
template <class E>
struct Kind {
  std::vector<Group> groups;
  std::vector<elements::LaneElement<E>> lanes;
};
struct NoKind {};
/// Of all types of elements but loads, whose energy is not their own.
template <class E>
constexpr auto kind_of() {
  if constexpr (std::is_same_v<E, plan::NoElement>)
    return NoKind{};
  else if constexpr (E::role == elements::Role::load)
    return NoKind{};
  else
    return Kind<E>{};
}
template <class Arrays>
struct KindsOf;
template <class... E>
struct KindsOf<std::tuple<std::vector<E>...>> {
  using Type = std::tuple<decltype(kind_of<E>())...>;
};
template <class G>
using Kinds = typename KindsOf<plan::ArraysOn<G>>::Type;
/// Calls f(kind) for those that exist on the group.
template <class K, class F>
void for_each_kind(K& kinds, const F& f) {
  const auto visit = [&f](auto& kind) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(kind)>, NoKind>) f(kind);
  };
  std::apply([&](auto&... kind) { (visit(kind), ...); }, kinds);
}

}  // namespace

class EnergyMeter::Sorted {
 public:
  virtual ~Sorted() = default;
  virtual std::unique_ptr<Sorted> copy() const = 0;
  virtual Energies eval(const step::System& system, const step::State& state) = 0;
};

template <class G>
class EnergyMeter::SortedOn : public Sorted {
 public:
  explicit SortedOn(const plan::Plan& plan) {
    for_each_kind(kinds_, [&](auto& kind) { sort(plan, kind); });
  }
  std::unique_ptr<Sorted> copy() const override { return std::make_unique<SortedOn>(*this); }
  Energies eval(const step::System& system, const step::State& state) override {
    const plan::Plan& plan = system.plan();
    const elements::FieldOn<G, double> field = system.instant().template field_on<G>(state);
    EnergiesOn<G, double> sum;
    for_each_kind(kinds_, [&](const auto& kind) { add(system, state, field, kind, sum); });
    Energies e;
    e.kinetic = sum.kinetic;
    e.strain = sum.strain;
    if constexpr (std::is_same_v<G, motion::Se3>) {
      e.potential = -lanes::dot(field.around.gravity, sum.mass_moment);
      // Elements give momentum in the axes of the frame in which nodes are described.
      e.momentum = field.observer == nullptr ? sum.momentum : turned(field.observer->pose.R, sum.momentum);
    } else {
      // Gravity acts along the axes of a reduced model: the constant distances from them do not count.
      const auto origin = plan::along_axes<G>(plan, plan.origin);
      e.potential = -lanes::dot(field.around.gravity, sum.mass_moment + sum.mass * origin);
      const Vec3<double> linear = in_space(plan.axes, G::linear(sum.momentum));
      Vec3<double> angular = Vec3<double>::zero();
      if constexpr (G::turns)
        angular = sum.momentum[G::dof - 1] * lanes::column(plan.axes, 2) + lanes::cross(plan.origin, linear);
      e.momentum = lanes::join(linear, angular);
    }
    return e;
  }

 private:
  template <class E>
  void sort(const plan::Plan& plan, Kind<E>& kind);
  template <class E>
  void add(const step::System& system, const step::State& state, const elements::FieldOn<G, double>& field,
           const Kind<E>& kind, EnergiesOn<G, double>& sum);
  template <class E>
  void add_group(const std::vector<E>& array, const Kind<E>& kind, const Group& group, const step::State& state,
                 const elements::FieldOn<G, double>& field, EnergiesOn<G, double>& sum) const;

  Kinds<G> kinds_;
  std::vector<EnergiesOn<G, double>> parts_;  ///< of chunks
};

template <class G>
template <class E>
void EnergyMeter::SortedOn<G>::sort(const plan::Plan& plan, Kind<E>& kind) {
  const std::vector<E>& array = std::get<std::vector<E>>(plan::arrays_on<G>(plan));
  const int size = static_cast<int>(array.size());
  const auto element = [&array](int i) -> const E& { return array[static_cast<std::size_t>(i)]; };
  for (int first = 0; first < size;) {
    if (!stores_energy(element(first))) {
      ++first;
      continue;
    }
    Group group{first, 1};
    while (group.count < elements::num_lanes && first + group.count < size && plan.frames.empty() &&
           stiffness_law(element(first)) < 0 && stores_energy(element(first + group.count)) &&
           may_share_lanes(element(first), element(first + group.count)))
      ++group.count;
    kind.groups.push_back(group);
    first += group.count;
  }
  const auto takes_lanes = [](const Group& group) { return group.count >= least_lanes; };
  // Reserves space: lanes have some ten kB each, and a growing array would copy them several times.
  kind.lanes.reserve(static_cast<std::size_t>(std::count_if(kind.groups.begin(), kind.groups.end(), takes_lanes)));
  int nodes[E::num_ports];
  for (int p = 0; p < E::num_ports; ++p) nodes[p] = p;
  for (Group& group : kind.groups) {
    if (!takes_lanes(group)) continue;
    const E* list[elements::num_lanes];
    for (int i = 0; i < group.count; ++i) list[i] = &element(group.first + i);
    group.lanes = static_cast<int>(kind.lanes.size());
    kind.lanes.push_back(elements::make_lane_element<E>(list, group.count, nodes, 0));
  }
}

template <class G>
template <class E>
void EnergyMeter::SortedOn<G>::add_group(const std::vector<E>& array, const Kind<E>& kind, const Group& group,
                                         const step::State& state, const elements::FieldOn<G, double>& field,
                                         EnergiesOn<G, double>& sum) const {
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
        from[p][l] = reinterpret_cast<const double*>(&field.nodes[static_cast<std::size_t>(e.ports[p].node)]);
    turns.set(l, turns_of(i));
  }
  elements::NodeMotionOn<G, LanePack> nodes[E::num_ports];
  for (int p = 0; p < E::num_ports; ++p)
    if (from[p][0] != nullptr)
      lanes::gather_lanes(from[p], elements::numbers_of_node<G>, reinterpret_cast<LanePack*>(&nodes[p]));
  elements::FieldOn<G, LanePack> around;
  around.nodes = nodes;
  around.around.has_inertia = field.around.has_inertia;
  EnergiesOn<G, LanePack> all;
  elements::eval_energies_lanes<E>(kind.lanes[static_cast<std::size_t>(group.lanes)], around, turns, all);
  for (int l = 0; l < group.count; ++l) results::add(sum, lane_of(all, l));
}

template <class G>
template <class E>
void EnergyMeter::SortedOn<G>::add(const step::System& system, const step::State& state,
                                   const elements::FieldOn<G, double>& field, const Kind<E>& kind,
                                   EnergiesOn<G, double>& sum) {
  const auto count = static_cast<std::int64_t>(kind.groups.size());
  if (count == 0) return;
  const std::vector<E>& array = std::get<std::vector<E>>(plan::arrays_on<G>(system.plan()));
  parts_.assign(static_cast<std::size_t>((count + chunk_groups - 1) / chunk_groups), {});
  auto body = [&](std::int64_t begin, std::int64_t end) {
    EnergiesOn<G, double>& part = parts_[static_cast<std::size_t>(begin / chunk_groups)];
    for (std::int64_t g = begin; g < end; ++g)
      add_group(array, kind, kind.groups[static_cast<std::size_t>(g)], state, field, part);
  };
  system.walker().for_each_chunk(count, chunk_groups, tree::make_chunk(body));
  for (const EnergiesOn<G, double>& part : parts_) results::add(sum, part);
}

EnergyMeter::EnergyMeter(const plan::Plan& plan) {
  plan.with_group([&]<class G>() { sorted_ = std::make_unique<SortedOn<G>>(plan); });
}
EnergyMeter::~EnergyMeter() = default;
EnergyMeter::EnergyMeter(const EnergyMeter& other) : sorted_(other.sorted_->copy()) {}
EnergyMeter& EnergyMeter::operator=(const EnergyMeter& other) {
  sorted_ = other.sorted_->copy();
  return *this;
}

/// Energy of efforts that are laws of their coordinates.
double EnergyMeter::stored(const step::System& system, const step::State& state) const {
  double sum = 0.0;
  const elements::Field field = system.instant().field(state);
  for (const plan::EnergyStore& store : system.plan().energy_stores) {
    const elements::Joint& joint = plan::joint_element(system.plan(), store.joint);
    const double turns = state.turns[static_cast<std::size_t>(store.joint)];
    sum -= store.supplied
               .at(elements::eval_joint_coordinate(joint, joint.efforts[store.effort].coordinate, field, turns).value)
               .value;
  }
  return sum;
}

Energies EnergyMeter::eval(const step::System& system, const step::State& state) {
  Energies e = sorted_->eval(system, state);
  if (!system.plan().energy_stores.empty()) e.strain += stored(system, state);
  return e;
}

}  // namespace bough::results
