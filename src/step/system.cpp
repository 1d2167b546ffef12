#include "bough/step/system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "bough/elements/rows.hpp"
#include "bough/step/step_cost.hpp"
#include "lane_batches.hpp"
#include "moving_nodes.hpp"
#include "reduced_elements.hpp"
#include "system_parts.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

/// Of the reference axis, where an element has one.
template <class E>
double length_of(const E& e, double fallback) {
  if constexpr (E::data_axes == elements::DataAxes::section) return e.length;
  return fallback;
}

}  // namespace

System::System(const plan::Plan& plan, const scene::Solver& solver, const tree::Walker& walker)
    : plan_(plan),
      instant_(plan),
      walker_(walker),
      clock_(walker.threads == 1),
      linear_(plan, solver, walker, clock_, counts_) {
  const std::size_t num_elements = plan.directory.size();
  element_length_.resize(num_elements);
  for (std::size_t e = 0; e < num_elements; ++e)
    plan::with_element(plan.elements, plan.directory[e], [&](const auto& element) {
      element_length_[e] = length_of(element, plan.length_scale);
      if constexpr (std::decay_t<decltype(element)>::data_axes == elements::DataAxes::section)
        moment_arm_ = std::max(moment_arm_, element.length);
    });
  if (!plan.is_dynamic) motion_tree_ = make_motion_tree(plan);
  if (moment_arm_ == 0.0) moment_arm_ = plan.length_scale;
  residual_.assign(num_unknowns(), 0.0);
  floor_ = residual_;
  floor_unknowns_.reserve(most_unknowns);
  joint_of_element_.assign(num_elements, -1);
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    joint_of_element_[static_cast<std::size_t>(plan.joints[j].element)] = static_cast<int>(j);
  if (!plan.held.empty()) held_ = std::make_unique<HeldNodes>(plan);
  place_parts();
  spatial_lanes_ = std::make_unique<LaneBatches<motion::Se3>>();
  if (!plan.planar) spatial_lanes_->make(plan, linear_.solver().batches(), joint_of_element_, held_.get());
  if (plan.planar) {
    if (!plan.is_dynamic) seen_parts_.resize(static_cast<std::size_t>(element_begin_.back()));
    planar_lanes_ = std::make_unique<LaneBatches<motion::Se2>>();
    planar_lanes_->make(plan, linear_.solver().batches(), joint_of_element_, held_.get());
  }
  row_series_.resize(static_cast<std::size_t>(plan.num_multipliers));
  work_.rhs.assign(num_unknowns(), 0.0);
  work_.x = work_.rhs;
  is_length_.assign(num_unknowns(), 0);
  for_each_multiplier(*this, [&](int joint, std::size_t multiplier, std::size_t unknown, std::size_t row) {
    multiplier_places_.push_back({multiplier, unknown});
    const auto& e = plan::array_of<elements::Joint>(plan.elements)[static_cast<std::size_t>(
        plan.directory[static_cast<std::size_t>(plan.joints[static_cast<std::size_t>(joint)].element)].index)];
    is_length_[unknown] = elements::is_length(e.rows[row].kind);
  });
  linear_.set_renewal_cost(estimate_step_cost(*this).renewal());
  chunk_sizes_.resize((sums_.size() + block_grain - 1) / block_grain, {{}, true});
  find_pairs();
}

System::~System() = default;

std::optional<Trouble> System::set_time(double time, laws::Side side) {
  if (auto t = instant_.set(time, side)) return t;
  if (!plan_.frames.empty()) spatial_lanes_->set_frames(instant_.frames());
  return std::nullopt;
}

elements::Field System::field(const State& state, const elements::Slopes& slopes, bool with_inertia) const {
  elements::Field f = instant_.surroundings(slopes, with_inertia);
  f.nodes = nodes(state).data();
  return f;
}

elements::Field System::field_of(const State& state, std::span<const int> nodes,
                                 std::vector<elements::NodeMotion>& scratch) const {
  if (!state.is_planar()) return field(state);
  elements::Field f = instant_.surroundings({}, true);
  scratch.resize(plan_.nodes.size());
  copy_nodes_in_space(plan_, state, nodes, scratch);
  f.nodes = scratch.data();
  return f;
}

template <class G>
elements::FieldOn<G, double> System::field_on(const State& state, const elements::Slopes& slopes,
                                              bool with_inertia) const {
  if constexpr (std::is_same_v<G, motion::Se3>) {
    return field(state, slopes, with_inertia);
  } else {
    const elements::Field space = instant_.surroundings(slopes, with_inertia);
    elements::FieldOn<G, double> f;
    f.nodes = state.on<G>().motion.data();
    f.slopes = slopes;
    f.around.gravity = motion::plane_part(lanes::transpose_times(plan_.planar->axes, space.around.gravity));
    f.around.laws = space.around.laws;
    f.around.has_inertia = space.around.has_inertia;
    return f;
  }
}
template elements::Field System::field_on<motion::Se3>(const State&, const elements::Slopes&, bool) const;
template elements::FieldOn<motion::Se2, double> System::field_on<motion::Se2>(const State&, const elements::Slopes&,
                                                                              bool) const;

std::span<const solve::ElementBatch> System::batches() const {
  return planar_lanes_ ? batches_on<motion::Se2>() : batches_on<motion::Se3>();
}

template <>
const LaneBatches<motion::Se3>& System::lanes_on<motion::Se3>() const {
  return *spatial_lanes_;
}
template <>
const LaneBatches<motion::Se2>& System::lanes_on<motion::Se2>() const {
  return *planar_lanes_;
}
template <class G>
std::span<const solve::ElementBatch> System::batches_on() const {
  return lanes_on<G>().batches();
}

template <class G>
void System::evaluate_alone(std::size_t id, const State& state, const elements::FieldOn<G, double>& f,
                            const ElementResults& to) {
  if (held_ && held_->leaves_out(id)) return;
  const int j = joint_of_element_[id];
  if (is_idle_joint(plan_, j)) return;
  std::array<double, elements::max_rows> scratch;
  const double* multipliers = nullptr;
  double turns = 0.0;
  if (j >= 0) {
    multipliers = multipliers_on<G>(plan_.joints[static_cast<std::size_t>(j)], state, scratch.data());
    turns = state.turns[static_cast<std::size_t>(j)];
  }
  plan::with_element(plan::arrays_on<G>(plan_), plan_.directory[id], [&](const auto& e) {
    if constexpr (std::is_same_v<G, motion::Se3>)
      if (are_elements_reduced(plan_)) return evaluate_reduced(e, id, f, multipliers, turns, to.want_tangents());
    std::array<double, most_unknowns> residual, magnitude;
    std::array<double, most_unknowns * most_unknowns> tangent_entries;
    const solve::ElementView view = to.want_tangents() ? to.tangent_of(static_cast<int>(id)) : solve::ElementView{};
    const bool is_direct = view.stride == 1 && !(held_ && held_->trims(id));
    elements::evaluate(e, f, multipliers, turns, residual.data(),
                       !to.want_tangents() ? nullptr
                       : is_direct         ? view.first
                                           : tangent_entries.data());
    elements::eval_magnitude(e, f, residual.data(), magnitude.data());
    set_parts(id, residual.data(), magnitude.data());
    if (to.want_tangents() && !is_direct)
      write_matrix(
          held_.get(), id, elements::num_unknowns(e),
          [&](int i) { return tangent_entries[static_cast<std::size_t>(i)]; }, view);
  });
}

/// The element in six unknowns a node, then in those that the scene has.
template <class E>
void System::evaluate_reduced(const E& e, std::size_t id, const elements::Field& f, const double* multipliers,
                              double turns, bool tangent) {
  std::array<double, most_unknowns * most_unknowns> entries, reduced;
  std::array<double, most_unknowns> residual, magnitude, reduced_residual, sizes;
  elements::evaluate(e, f, multipliers, turns, residual.data(), tangent ? entries.data() : nullptr);
  elements::eval_magnitude(e, f, residual.data(), magnitude.data());
  const plan::JointPlan* const joint = joint_plan_of(id);
  reduce_vector(plan_.unknowns, e, joint, residual.data(), reduced_residual.data());
  reduce_sizes(plan_.unknowns, e, joint, magnitude.data(), sizes.data());
  set_parts(id, reduced_residual.data(), sizes.data());
  if (!tangent) return;
  const int n = reduce_matrix(plan_.unknowns, e, joint, entries.data(), reduced.data());
  write_matrix(
      held_.get(), id, n, [&](int i) { return reduced[static_cast<std::size_t>(i)]; },
      linear_.solver().element(static_cast<int>(id)));
}

void System::begin_matrices(bool are_symmetric) {
  linear_.begin_matrices(are_symmetric);
  round_off_floor_.reset();
  round_off_of_poses_.reset();
}

void System::set_matrix(int element, int num_unknowns, const double* entries) {
  const solve::ElementView view = linear_.solver().element(element);
  for_each_kept(held_.get(), static_cast<std::size_t>(element), num_unknowns,
                [&](std::int64_t place, int i) { view[place] = entries[i]; });
}

void System::add_matrix(int element, int num_unknowns, const double* entries) {
  const solve::ElementView view = linear_.solver().element(element);
  for_each_kept(held_.get(), static_cast<std::size_t>(element), num_unknowns,
                [&](std::int64_t place, int i) { view[place] += entries[i]; });
}

/// Of an element, those that the solver knows.
int System::num_unknowns_of(std::size_t element) const {
  int n = 0;
  const blocks::BlockGraph& g = plan_.graph;
  for (std::int64_t k = g.element_begin[element]; k < g.element_begin[element + 1]; ++k)
    n += g.block_size[static_cast<std::size_t>(g.element_blocks[static_cast<std::size_t>(k)])];
  return n;
}

void System::symmetrise(const solve::ElementBatch& batch) {
  for (int id : batch.element) {
    if (id < 0) continue;
    const int n = num_unknowns_of(static_cast<std::size_t>(id));
    const solve::ElementView view = linear_.solver().element(id);
    for (int i = 1; i < n; ++i)
      for (int j = 0; j < i; ++j) view[i * n + j] = view[j * n + i] = 0.5 * (view[i * n + j] + view[j * n + i]);
  }
}

template <class G>
void System::evaluate_on(const State& state, const elements::FieldOn<G, double>& field, bool tangent) {
  const LaneBatches<G>& lanes = lanes_on<G>();
  const std::span<const solve::ElementBatch> batches = batches_on<G>();
  const ElementResults results{parts_.data(), element_begin_.data(), tangent ? &linear_.solver() : nullptr};
  auto by_batch = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const auto batch = static_cast<std::size_t>(k);
      if (lanes.holds(batch))
        lanes.evaluate(batch, state, field, results);
      else
        for (int id : batches[batch].element)
          if (id >= 0) evaluate_alone(static_cast<std::size_t>(id), state, field, results);
      if (tangent && linear_.takes_symmetric_parts()) symmetrise(batches[batch]);
    }
  };
  walker_.for_each_chunk(static_cast<std::int64_t>(batches.size()), batch_grain,
                         tree::make_chunk(by_batch, tree::Work::evaluate));
}

std::optional<Trouble> System::evaluate(const State& state, const elements::Slopes& slopes, bool tangent) {
  PhaseTimer timer{clock_, counts_.assemble};
  ++counts_.evaluations;
  if (tangent) begin_matrices(linear_.takes_symmetric_parts());
  if (state.is_planar())
    evaluate_on(state, field_on<motion::Se2>(state, slopes), tangent);
  else
    evaluate_on(state, field(state, slopes), tangent);
  auto by_sum = [&](std::int64_t begin, std::int64_t end) { sum_parts(begin, end); };
  walker_.for_each_chunk(static_cast<std::int64_t>(sums_.size()), block_grain, tree::make_chunk(by_sum));
  if (std::all_of(chunk_sizes_.begin(), chunk_sizes_.end(), [](const ChunkSize& c) { return c.is_finite; }))
    return std::nullopt;
  for (std::size_t e = 0; e < plan_.directory.size(); ++e)
    for (std::int64_t i = 2 * element_begin_[e]; i < 2 * element_begin_[e + 1]; ++i)
      if (!std::isfinite(parts_[static_cast<std::size_t>(i)]))
        return Trouble{"the forces of '" + plan_.element_owner[e] + "' are not finite at time " +
                       std::to_string(state.time)};
  return Trouble{"a sum of forces is not finite at time " + std::to_string(state.time)};
}

solve::ConstElementView System::matrix_of(int element, std::vector<std::int64_t>& unknowns) const {
  unknowns.clear();
  const auto e = static_cast<std::size_t>(element);
  const blocks::BlockGraph& g = plan_.graph;
  for (std::int64_t k = g.element_begin[e]; k < g.element_begin[e + 1]; ++k) {
    const int block = g.element_blocks[static_cast<std::size_t>(k)];
    for (std::int64_t u = block_begin(block); u < block_begin(block + 1); ++u) unknowns.push_back(u);
  }
  return linear_.solver().element(element);
}

}  // namespace bough::step
