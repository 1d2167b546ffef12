#include "lane_batches.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "element_parts.hpp"

namespace bough::step {

namespace {

/// Loads what an element reads of eight nodes: poses; v and dv/dt if it reads rates, which are zero otherwise; dq and
/// the drift if it also needs their slopes, which are left as they were otherwise.
template <class G>
void gather_motions(const elements::NodeMotionOn<G, double>* nodes, const int* at, bool has_rates, bool has_slopes,
                    elements::NodeMotionOn<G, elements::LanePack>& to) {
  const double* from[elements::num_lanes];
  for (int l = 0; l < elements::num_lanes; ++l) from[l] = reinterpret_cast<const double*>(nodes + at[l]);
  auto* const numbers = reinterpret_cast<elements::LanePack*>(&to);
  if (has_rates && has_slopes) return lanes::gather_lanes(from, elements::numbers_of_node<G>, numbers);
  if (has_rates) return lanes::gather_lanes(from, elements::numbers_of_rates<G>, numbers);
  lanes::gather_lanes(from, elements::numbers_of_pose<G>, numbers);
  to.v = to.a = decltype(to.v)::zero();
}

}  // namespace

template <class G>
template <std::size_t I>
void LaneBatches<G>::add(const solve::ElementBatch& batch, Slot& slot) {
  using E = typename std::tuple_element_t<I, Arrays>::value_type;
  const auto& array = std::get<I>(plan::arrays_on<G>(*plan_));
  const E* list[elements::num_lanes];
  for (int l = 0; l < elements::num_lanes; ++l) {  // an empty lane repeats the first element
    const int own = batch.element[static_cast<std::size_t>(l)];
    const int id = own >= 0 ? own : batch.element[static_cast<std::size_t>(slot.first)];
    const plan::ElementPlace place = plan_->directory[static_cast<std::size_t>(id)];
    if (place.array != I) return;
    list[l] = &array[static_cast<std::size_t>(place.index)];
    if (!may_share_lanes(*list[0], *list[l])) return;
  }
  slot.places = places_.size();
  for (int p = 0; p < E::num_ports; ++p)
    for (const E* e : list) places_.push_back(e->ports[p].node);
  int laws[elements::num_lanes][elements::max_laws];
  for (int l = 0; l < elements::num_lanes; ++l) slot.num_laws = list_laws(*list[l], laws[l]);
  for (int k = 0; k < slot.num_laws; ++k)
    for (const auto& of_lane : laws) places_.push_back(of_lane[k]);
  slot.num_unknowns = num_unknowns(*list[0]);
  if constexpr (E::num_multipliers > 0) place_rows(batch, num_multipliers(*list[0]), slot);
  slot.array = static_cast<int>(I);
  auto& lanes = std::get<I>(lanes_);
  const bool is_uniform =
      std::all_of(std::begin(list), std::end(list), [&](const E* e) { return has_same_numbers(*list[0], *e); });
  if (is_uniform)
    for (auto u = uniform_.rbegin(); u != uniform_.rend(); ++u)
      if (u->array == slot.array && has_same_numbers(array[u->element], *list[0])) {
        slot.index = u->index;
        return;
      }
  int nodes[E::num_ports];
  for (int p = 0; p < E::num_ports; ++p) nodes[p] = p;
  slot.index = static_cast<int>(lanes.size());
  lanes.push_back(make_lane_element<E>(list, elements::num_lanes, nodes, 0));
  if (is_uniform && uniform_.size() < most_uniform)
    uniform_.push_back({slot.array, slot.index, static_cast<std::size_t>(list[0] - array.data())});
}

template <class G>
void LaneBatches<G>::place_rows(const solve::ElementBatch& batch, int num_rows, Slot& slot) {
  int joints[elements::num_lanes];
  for (std::size_t l = 0; l < elements::num_lanes; ++l) {
    const int id = batch.element[l] >= 0 ? batch.element[l] : batch.element[static_cast<std::size_t>(slot.first)];
    joints[l] = plan_->joint_of_element[static_cast<std::size_t>(id)];
  }
  slot.num_rows = num_rows;
  for (int r = 0; r < slot.num_rows; ++r)
    for (const int j : joints) {
      const plan::JointPlan& joint = plan_->joints[static_cast<std::size_t>(j)];
      places_.push_back(joint.multiplier_begin + joint.rows[static_cast<std::size_t>(r)]);
    }
  places_.insert(places_.end(), std::begin(joints), std::end(joints));
}

template <class G>
bool LaneBatches<G>::may_share(int a, int b) const {
  if (a == b) return true;
  const plan::ElementPlace one = plan_->directory[static_cast<std::size_t>(a)],
                           other = plan_->directory[static_cast<std::size_t>(b)];
  if (one.array != other.array || reads_signals(a) || reads_signals(b)) return false;
  bool may = false;
  plan::with_element(plan::arrays_on<G>(*plan_), one, [&](const auto& x) {
    plan::with_element(plan::arrays_on<G>(*plan_), other, [&](const auto& y) {
      if constexpr (std::is_same_v<decltype(x), decltype(y)>) may = may_share_lanes(x, y);
    });
  });
  return may;
}

template <class G>
void LaneBatches<G>::split_by_kind(std::vector<int>& visit_of_batch) {
  std::vector<solve::ElementBatch> pieces;
  std::vector<int> of_piece;
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    solve::ElementBatch rest = batches_[b];
    for (bool is_whole = true;; is_whole = false) {
      const auto first = std::find_if(rest.element.begin(), rest.element.end(), [](int id) { return id >= 0; });
      if (first == rest.element.end()) break;
      solve::ElementBatch piece = rest;
      const int kind = *first;
      bool leaves_some = false;
      for (std::size_t l = 0; l < solve::lanes_wide; ++l) {
        if (rest.element[l] < 0) continue;
        const bool takes = may_share(kind, rest.element[l]);
        (takes ? rest : piece).element[l] = -1;
        leaves_some |= !takes;
      }
      if (leaves_some || !is_whole) piece.stride = 1;  // its lanes are not those of the solver
      pieces.push_back(piece);
      of_piece.push_back(visit_of_batch[b]);
    }
  }
  batches_ = std::move(pieces);
  visit_of_batch = std::move(of_piece);
}

template <class G>
void LaneBatches<G>::fill_batches(const std::vector<int>& visit_of_batch, const solve::SolverVisits& visits) {
  constexpr std::size_t near_by = 256;  ///< distance in batches within which elements share the cache
  struct Open {
    std::size_t batch = 0;
    int first = 0;
    std::size_t count = 0;
  };
  std::vector<Open> open;
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    solve::ElementBatch& batch = batches_[b];
    std::array<int, solve::lanes_wide> loose = batch.element;
    const auto end = std::remove_if(loose.begin(), loose.end(), [](int id) { return id < 0; });
    if (end - loose.begin() == solve::lanes_wide) continue;
    batch.element.fill(-1);
    batch.stride = 1;  // its lanes no longer match those of the solver
    const auto is_below = [&](int lower, int upper) {
      while (lower >= 0 && lower < upper) lower = visits.parent[static_cast<std::size_t>(lower)];
      return lower == upper;
    };
    std::erase_if(open, [&](const Open& o) {
      return b - o.batch > near_by || !is_below(visit_of_batch[o.batch], visit_of_batch[b]);
    });
    for (const int* id = loose.data(); id != end; ++id) {
      auto group = std::find_if(open.begin(), open.end(), [&](const Open& o) { return may_share(o.first, *id); });
      if (group == open.end()) group = open.insert(open.end(), {b, *id});
      batches_[group->batch].element[group->count++] = *id;
      if (group->count == solve::lanes_wide) open.erase(group);
    }
  }
}

template <class G>
bool LaneBatches<G>::leaves_out(int element) const {
  const auto id = static_cast<std::size_t>(element);
  if (id >= plan_->directory.size()) return true;  // the equation of a signal
  return (trimmed_ != nullptr && trimmed_->leaves_out(id)) || is_idle_joint(*plan_, plan_->joint_of_element[id]);
}

template <class G>
bool LaneBatches<G>::reads_signals(int element) const {
  return element >= 0 && !plan::signals_of(*plan_, static_cast<std::size_t>(element)).empty();
}

template <class G>
void LaneBatches<G>::make(const plan::Plan& plan, std::span<const solve::ElementBatch> batches,
                          const solve::SolverVisits& visits, const TrimmedElements* trimmed) {
  plan_ = &plan;
  trimmed_ = trimmed;
  batches_.assign(batches.begin(), batches.end());
  for (solve::ElementBatch& batch : batches_)
    for (int& id : batch.element)
      if (id >= 0 && leaves_out(id)) id = -1;
  std::vector<int> visit_of_batch(batches_.size()), of_kept;
  for (int v = 0; v < visits.count(); ++v)
    for (int b = visits.batch_begin[static_cast<std::size_t>(v)];
         b < visits.batch_begin[static_cast<std::size_t>(v) + 1]; ++b)
      visit_of_batch[static_cast<std::size_t>(b)] = v;
  split_by_kind(visit_of_batch);
  fill_batches(visit_of_batch, visits);
  std::vector<solve::ElementBatch> kept;
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    if (std::all_of(batches_[b].element.begin(), batches_[b].element.end(), [](int id) { return id < 0; })) continue;
    kept.push_back(batches_[b]);
    of_kept.push_back(visit_of_batch[b]);
  }
  batches_ = std::move(kept);
  by_visit_ = VisitRanges(of_kept, visits.count());
  slots_.assign(batches_.size(), {});
  uniform_.clear();
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    Slot& slot = slots_[b];
    for (int l = elements::num_lanes - 1; l >= 0; --l) {
      const int id = batches_[b].element[static_cast<std::size_t>(l)];
      if (id < 0) continue;
      ++slot.present;
      slot.first = l;
      slot.is_trimmed |= trimmed != nullptr && trimmed->trims(static_cast<std::size_t>(id));
    }
    if (slot.present < least_lanes) continue;
    const int first = batches_[b].element[static_cast<std::size_t>(slot.first)];
    if (std::any_of(batches_[b].element.begin(), batches_[b].element.end(),
                    [this](int id) { return reads_signals(id); }))
      continue;
    const int array = plan.directory[static_cast<std::size_t>(first)].array;
    plan::with_array<Arrays>(array, [&]<std::size_t I>() { add<I>(batches_[b], slot); });
  }
}

template <class G>
void LaneBatches<G>::set_frames(const plan::FrameMotions& frames) {
  carriers_.resize(frames.in_ground.size());
  for (std::size_t i = 0; i < carriers_.size(); ++i) elements::set_all_lanes(carriers_[i], frames.in_ground[i]);
  elements::set_all_lanes(observer_, frames.observer);
}

template <class G>
void LaneBatches<G>::evaluate(std::size_t batch, const State& state, const Field& field,
                              const ElementResults& to) const {
  const Slot& slot = slots_[batch];
  plan::with_array<Arrays>(slot.array,
                           [&]<std::size_t I>() { evaluate_as<I>(batches_[batch], slot, state, field, to); });
}

template <class G>
template <std::size_t I>
void LaneBatches<G>::evaluate_as(const solve::ElementBatch& batch, const Slot& slot, const State& state,
                                 const Field& field, const ElementResults& to) const {
  using Pack = elements::LanePack;
  using E = typename std::tuple_element_t<I, Arrays>::value_type;
  constexpr int rows = E::num_multipliers, wide = elements::num_lanes, most = G::dof * E::num_ports + rows;
  const auto& lane_element = std::get<I>(lanes_)[static_cast<std::size_t>(slot.index)];
  const int n = slot.num_unknowns;
  elements::NodeMotionOn<G, Pack> nodes[E::num_ports];
  Pack laws[elements::max_laws], multipliers[rows > 0 ? rows : 1], turns(0.0);
  const int* place = places_.data() + slot.places;
  for (int p = 0; p < E::num_ports; ++p, place += wide) {
    if (place[0] == elements::ground) continue;
    gather_motions(field.nodes, place, looks_at_rates(lane_element), to.want_tangents(), nodes[p]);
  }
  for (int k = 0; k < slot.num_laws; ++k, place += wide) laws[k] = lanes::load_lanes<wide>(field.around.laws, place);
  if constexpr (rows > 0) {
    for (int r = 0; r < slot.num_rows; ++r, place += wide)
      multipliers[r] = lanes::load_lanes<wide>(state.multipliers.data(), place);
    turns = lanes::load_lanes<wide>(state.turns.data(), place);
  }
  elements::FieldOn<G, Pack> around;
  around.nodes = nodes;
  around.slopes = field.slopes;
  if (field.carriers != nullptr) around.carriers = carriers_.data();
  if (field.observer != nullptr) around.observer = &observer_;
  for (int i = 0; i < field.around.gravity.size(); ++i) around.around.gravity[i] = Pack(field.around.gravity[i]);
  around.around.laws = laws;
  around.around.has_inertia = field.around.has_inertia;
  constexpr int room = std::max(8, 2 * most);  // eight parts are transposed at once
  Pack residual[most], magnitude[most], parts[room], spare[most * most];
  // Only full batches are written directly: the solver's empty lanes must stay empty.
  const bool may_be_direct = to.want_tangents() && slot.present == wide && batch.stride == wide && !slot.is_trimmed;
  Pack* const direct = may_be_direct ? reinterpret_cast<Pack*>(to.tangent_of(batch.element[0]).first) : nullptr;
  Pack* matrix = direct != nullptr ? direct : to.want_tangents() ? spare : nullptr;
  evaluate_lanes(lane_element, around, multipliers, turns, residual, magnitude, matrix);
  join_parts(std::integral_constant<int, G::dof>{}, n, slot.num_rows, residual, magnitude, parts);
  double nowhere[2 * most], *to_parts[wide];
  for (int l = 0; l < wide; ++l) {
    const int id = batch.element[static_cast<std::size_t>(l)];
    to_parts[l] = id < 0 ? nowhere : to.parts_of(id);
    if (to.want_tangents() && direct == nullptr && id >= 0)
      write_matrix(
          trimmed_, static_cast<std::size_t>(id), n, [&](int i) { return spare[i][l]; }, to.tangent_of(id));
  }
  lanes::scatter_lanes(parts, 2 * n, to_parts);
}

#define BOUGH_INSTANTIATE(G) template class LaneBatches<G>;
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE)
#undef BOUGH_INSTANTIATE

}  // namespace bough::step
