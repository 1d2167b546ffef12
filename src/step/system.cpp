#include "bough/step/system.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "lane_batches.hpp"
#include "make_solver.hpp"
#include "planar_system.hpp"
#include "projection.hpp"
#include "system_parts.hpp"

namespace bough::step {

using elements::NodeMotion;
using motion::Vec3;
using motion::Vec6;

namespace {

/// By exponents, which no trap minds and compilers vectorise.
bool all_finite(const double* a, int count) {
  constexpr std::uint64_t exponent = 0x7ff0000000000000u;
  bool finite = true;
  for (int i = 0; i < count; ++i) finite &= (std::bit_cast<std::uint64_t>(a[i]) & exponent) != exponent;
  return finite;
}

double largest_of_three(const double* a) { return std::max(std::max(std::abs(a[0]), std::abs(a[1])), std::abs(a[2])); }

struct NodeSize {
  double force, moment;
};
/// Largest entries of the force and the moment at a node.
inline NodeSize size_up(plan::Motions motions, const double* a) {
  switch (motions) {
    case plan::Motions::spatial:
      return {largest_of_three(a), largest_of_three(a + 3)};
    case plan::Motions::planar:
      return {std::max(std::abs(a[0]), std::abs(a[1])), std::abs(a[2])};
    case plan::Motions::translation:
      return {largest_of_three(a), 0.0};
    case plan::Motions::line:
      break;
  }
  return {std::abs(a[0]), 0.0};
}

/// r = sum of parts, m = sum of terms, of `Size` entries each; Size 0: of `size`.
template <int Size>
inline void add_parts(const double* parts, const double* terms, const std::int64_t* begin, const std::int64_t* end,
                      int size, double* r, double* m) {
  const int count = Size > 0 ? Size : size;
  for (int i = 0; i < count; ++i) r[i] = m[i] = 0.0;
  for (const std::int64_t* use = begin; use != end; ++use)
    for (int i = 0; i < count; ++i) {
      r[i] += parts[*use + i];
      m[i] += terms[*use + i];
    }
}

std::unique_ptr<tree::Tree> make_scene_tree(const plan::Plan& plan, const scene::Solver& given) {
  tree::TreeOptions options;
  options.leaf_size = given.leaf_size;
  options.depth = given.depth;
  return std::make_unique<tree::Tree>(tree::make_tree(plan.graph, options));
}

template <class E>
requires requires(const E& e) { e.length; }
double length_of(const E& e, const std::vector<plan::NodePlan>&, double) { return e.length; }
template <class E>
double length_of(const E&, const std::vector<plan::NodePlan>&, double fallback) {
  return fallback;
}

}  // namespace

System::System(const plan::Plan& plan, const scene::Solver& solver, const tree::Walker& walker)
    : plan_(plan), tree_(make_scene_tree(plan, solver)), walker_(walker) {
  solver_ = make_solver(plan, *tree_, solver);
  const blocks::BlockGraph& g = plan.graph;
  const std::size_t num_elements = plan.directory.size();
  element_begin_.assign(1, 0);
  std::vector<std::vector<std::int64_t>> uses(static_cast<std::size_t>(g.num_blocks()));
  element_length_.resize(num_elements);
  for (std::size_t e = 0; e < num_elements; ++e) {
    std::int64_t at = element_begin_.back();
    for (std::int64_t k = g.element_begin[e]; k < g.element_begin[e + 1]; ++k) {
      const int block = g.element_blocks[static_cast<std::size_t>(k)];
      uses[static_cast<std::size_t>(block)].push_back(at);
      at += g.block_size[static_cast<std::size_t>(block)];
    }
    element_begin_.push_back(at);
    plan::with_element(plan.elements, plan.directory[e], [&](const auto& element) {
      element_length_[e] = length_of(element, plan.nodes, plan.length_scale);
      if constexpr (requires { element.length; }) moment_arm_ = std::max(moment_arm_, element.length);
    });
  }
  if (!plan.is_dynamic) motion_tree_ = make_motion_tree(plan);
  if (moment_arm_ == 0.0) moment_arm_ = plan.length_scale;
  element_residual_.assign(static_cast<std::size_t>(element_begin_.back()), 0.0);
  element_magnitude_ = element_residual_;
  use_begin_.assign(1, 0);
  for (const auto& list : uses) {
    uses_.insert(uses_.end(), list.begin(), list.end());
    use_begin_.push_back(static_cast<std::int64_t>(uses_.size()));
  }
  residual_.assign(num_unknowns(), 0.0);
  magnitude_.assign(num_unknowns(), 0.0);
  joint_of_element_.assign(num_elements, -1);
  joint_of_block_.assign(static_cast<std::size_t>(g.num_blocks()), -1);
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    joint_of_element_[static_cast<std::size_t>(plan.joints[j].element)] = static_cast<int>(j);
    if (plan.joints[j].block >= 0)
      joint_of_block_[static_cast<std::size_t>(plan.joints[j].block)] = static_cast<int>(j);
  }
  lane_batches_ = std::make_unique<LaneBatches<SpatialKernels>>();
  if (plan.unknowns.is_whole())
    lane_batches_->make(plan, solver_->batches(), joint_of_element_);
  else
    projection_ = std::make_unique<Projection>(plan);
  takes_symmetric_parts_ = plan.took("symmetric");
  if (plan.planar) planar_ = std::make_unique<PlanarSystem>(plan, solver_->batches(), joint_of_element_);
  law_values_.assign(plan.laws.size(), 0.0);
  law_rates_ = law_accelerations_ = law_values_;
  law_series_.resize(plan.laws.size());
  row_series_.resize(static_cast<std::size_t>(plan.num_multipliers));
  work_.rhs.assign(num_unknowns(), 0.0);
  work_.x = work_.rhs;
  is_length_.assign(num_unknowns(), 0);
  for_each_multiplier(*this, [&](int joint, std::size_t, std::size_t unknown, std::size_t row) {
    const auto& e = plan::array_of<elements::Joint>(plan.elements)[static_cast<std::size_t>(
        plan.directory[static_cast<std::size_t>(plan.joints[static_cast<std::size_t>(joint)].element)].index)];
    is_length_[unknown] = e.rows[row].kind == elements::RowKind::along || e.rows[row].kind == elements::RowKind::screw;
  });
  chunk_sizes_.resize((static_cast<std::size_t>(g.num_blocks()) + block_grain - 1) / block_grain, {{}, true});
  find_pairs();
}

System::~System() = default;

std::optional<Trouble> System::set_time(double time, laws::Side side) {
  time_ = time;
  for (std::size_t i = 0; i < plan_.laws.size(); ++i) {
    const laws::LawValue v = plan_.laws[i].law.at(plan_.laws[i].at_start ? 0.0 : time, side);
    if (const auto which = laws::non_finite(v))
      return Trouble{"the time function of '" + plan_.laws[i].user + "' is not finite at time " + std::to_string(time) +
                     ": " + *which};
    law_values_[i] = v.value;
    law_rates_[i] = v.rate;
    law_accelerations_[i] = v.acceleration;
  }
  if (!plan_.frames.empty()) set_frames();
  return std::nullopt;
}

elements::Field System::field(const State& state, const elements::Slopes& slopes, bool with_inertia) const {
  elements::Field f;
  f.nodes = state.nodes.data();
  f.slopes = slopes;
  f.around.gravity = law_values_[static_cast<std::size_t>(plan_.gravity_law)] * plan_.gravity;
  f.around.laws = law_values_.data();
  f.around.has_inertia = plan_.is_dynamic && with_inertia;
  if (plan_.frames.empty()) return f;
  f.carriers = frames_.in_ground.data();
  f.observer = observer();
  if (f.observer == nullptr) return f;
  f.around.gravity = lanes::transpose_times(f.observer->pose.R, f.around.gravity);
  f.around.has_inertia = with_inertia;  // statics, too: at rest in a frame that moves steadily
  return f;
}

void System::evaluate_alone(std::size_t id, const State& state, const elements::Field& f, bool tangent) {
  const int j = joint_of_element_[id];
  const double* multipliers = nullptr;
  double turns = 0.0;
  if (j >= 0) {
    multipliers = state.multipliers.data() + plan_.joints[static_cast<std::size_t>(j)].multiplier_begin;
    turns = state.turns[static_cast<std::size_t>(j)];
  }
  plan::with_element(plan_.elements, plan_.directory[id], [&](const auto& e) {
    double* residual = element_residual_.data() + element_begin_[id];
    if (projection_) return evaluate_projected(e, id, f, multipliers, turns, tangent);
    std::array<double, most_unknowns * most_unknowns> tangent_entries;
    const solve::ElementView view = solver_->element(static_cast<int>(id));
    const bool is_direct = view.stride == 1;
    elements::evaluate(e, f, multipliers, turns, residual,
                       !tangent    ? nullptr
                       : is_direct ? view.first
                                   : tangent_entries.data());
    if (tangent && !is_direct) {
      const int n = elements::num_unknowns(e);
      for (int i = 0; i < n * n; ++i) view[i] = tangent_entries[static_cast<std::size_t>(i)];
    }
    elements::eval_magnitude(e, f, residual, element_magnitude_.data() + element_begin_[id]);
  });
}

/// The element in six unknowns a node, then in those that the scene has.
template <class E>
void System::evaluate_projected(const E& e, std::size_t id, const elements::Field& f, const double* multipliers,
                                double turns, bool tangent) {
  std::array<double, most_unknowns * most_unknowns> entries, reduced;
  std::array<double, most_unknowns> residual, magnitude;
  elements::evaluate(e, f, multipliers, turns, residual.data(), tangent ? entries.data() : nullptr);
  elements::eval_magnitude(e, f, residual.data(), magnitude.data());
  projection_->project_vector(id, residual.data(), element_residual_.data() + element_begin_[id]);
  projection_->project_sizes(id, magnitude.data(), element_magnitude_.data() + element_begin_[id]);
  if (!tangent) return;
  const int n = projection_->project_matrix(id, entries.data(), reduced.data());
  const solve::ElementView view = solver_->element(static_cast<int>(id));
  for (int i = 0; i < n * n; ++i) view[i] = reduced[static_cast<std::size_t>(i)];
}

void System::symmetrise(const solve::ElementBatch& batch) {
  for (int id : batch.element) {
    if (id < 0) continue;
    const auto n = static_cast<int>(element_begin_[static_cast<std::size_t>(id) + 1] -
                                    element_begin_[static_cast<std::size_t>(id)]);
    const solve::ElementView view = solver_->element(id);
    for (int i = 1; i < n; ++i)
      for (int j = 0; j < i; ++j) view[i * n + j] = view[j * n + i] = 0.5 * (view[i * n + j] + view[j * n + i]);
  }
}

std::optional<Trouble> System::evaluate(const State& state, const elements::Slopes& slopes, bool tangent) {
  PhaseTimer timer{counts_.assemble};
  ++counts_.evaluations;
  const elements::Field f = field(state, slopes);
  PlanarSystem* const planar = as_sensors_ ? nullptr : planar_.get();
  const std::span<const solve::ElementBatch> batches = planar != nullptr ? planar->batches()
                                                       : projection_     ? solver_->batches()
                                                                         : lane_batches_->batches();
  const auto result = [&](int id) {
    const auto begin = static_cast<std::size_t>(element_begin_[static_cast<std::size_t>(id)]);
    return ElementResult{element_residual_.data() + begin, element_magnitude_.data() + begin,
                         tangent ? solver_->element(id) : solve::ElementView{}};
  };
  if (planar != nullptr) {
    auto by_node = [&](std::int64_t begin, std::int64_t end) { planar->set_nodes(state, begin, end); };
    walker_.for_each_chunk(static_cast<std::int64_t>(state.nodes.size()), block_grain, tree::make_chunk(by_node));
    planar->set_field(f);
  }
  auto by_batch = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const auto batch = static_cast<std::size_t>(k);
      if (planar != nullptr)
        planar->evaluate(batch, state, tangent, result);
      else if (lane_batches_->holds(batch))
        lane_batches_->evaluate(batch, state, f, tangent, result);
      else
        for (int id : batches[batch].element)
          if (id >= 0) evaluate_alone(static_cast<std::size_t>(id), state, f, tangent);
      if (tangent && takes_symmetric_parts_) symmetrise(batches[batch]);
    }
  };
  walker_.for_each_chunk(static_cast<std::int64_t>(batches.size()), batch_grain,
                         tree::make_chunk(by_batch, tree::Work::evaluate));
  auto by_block = [&](std::int64_t begin, std::int64_t end) { sum_blocks(begin, end); };
  walker_.for_each_chunk(plan_.graph.num_blocks(), block_grain, tree::make_chunk(by_block));
  if (std::all_of(chunk_sizes_.begin(), chunk_sizes_.end(), [](const ChunkSize& c) { return c.is_finite; }))
    return std::nullopt;
  for (std::size_t e = 0; e < plan_.directory.size(); ++e)
    for (std::int64_t i = element_begin_[e]; i < element_begin_[e + 1]; ++i)
      if (!std::isfinite(element_residual_[static_cast<std::size_t>(i)]))
        return Trouble{"the forces of '" + plan_.element_owner[e] + "' are not finite at time " +
                       std::to_string(time_)};
  return Trouble{"a sum of forces is not finite at time " + std::to_string(time_)};
}

/// Adds the parts of blocks [begin, end), a chunk, in a fixed order, and sizes up the sums.
void System::sum_blocks(std::int64_t begin, std::int64_t end) {
  ChunkSize chunk{{}, true};
  ResidualSize& s = chunk.size;
  for (std::int64_t b = begin; b < end; ++b) {
    const auto block = static_cast<std::size_t>(b);
    const int size = plan_.graph.block_size[block];
    const auto first = static_cast<std::size_t>(tree_->unknown_begin[block]);
    double *r = residual_.data() + first, *m = magnitude_.data() + first;
    const auto add = size == 6 ? add_parts<6> : size == 3 ? add_parts<3> : size == 2 ? add_parts<2> : add_parts<0>;
    add(element_residual_.data(), element_magnitude_.data(), uses_.data() + use_begin_[block],
        uses_.data() + use_begin_[block + 1], size, r, m);
    if (!all_finite(r, size)) {
      chunk.is_finite = false;
      continue;
    }
    const int joint = joint_of_block_[block];
    if (joint < 0) {
      const NodeSize now = size_up(plan_.unknowns.motions, r), terms = size_up(plan_.unknowns.motions, m);
      if (now.force > s.force) s.worst_force_node = static_cast<int>(b);
      if (now.moment > s.moment) s.worst_moment_node = static_cast<int>(b);
      s.force = std::max(s.force, now.force);
      s.moment = std::max(s.moment, now.moment);
      s.force_scale = std::max(s.force_scale, terms.force);
      s.moment_scale = std::max(s.moment_scale, terms.moment);
      continue;
    }
    for (int i = 0; i < size; ++i) {
      const double value = std::abs(r[i]);
      if (value > std::max(s.length, s.angle)) s.worst_joint = joint;
      double& most = is_length_[first + static_cast<std::size_t>(i)] != 0 ? s.length : s.angle;
      most = std::max(most, value);
    }
  }
  chunk_sizes_[static_cast<std::size_t>(begin / block_grain)] = chunk;
}

ResidualSize System::residual_size() const {
  ResidualSize s;
  for (const ChunkSize& chunk : chunk_sizes_) {
    const ResidualSize& c = chunk.size;
    if (c.force > s.force) s.worst_force_node = c.worst_force_node;
    if (c.moment > s.moment) s.worst_moment_node = c.worst_moment_node;
    if (std::max(c.length, c.angle) > std::max(s.length, s.angle)) s.worst_joint = c.worst_joint;
    s.force = std::max(s.force, c.force);
    s.moment = std::max(s.moment, c.moment);
    s.force_scale = std::max(s.force_scale, c.force_scale);
    s.moment_scale = std::max(s.moment_scale, c.moment_scale);
    s.length = std::max(s.length, c.length);
    s.angle = std::max(s.angle, c.angle);
  }
  return s;
}

ResidualSize System::round_off_floor(const State&) const {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  std::vector<double> floor(num_unknowns(), 0.0);
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    const int n = static_cast<int>(element_begin_[e + 1] - element_begin_[e]), count = plan_.unknowns.count;
    const solve::ElementView K = const_cast<solve::AnySolver&>(*solver_).element(static_cast<int>(e));
    int row = 0, node_columns = 0;
    for (std::int64_t kb = plan_.graph.element_begin[e]; kb < plan_.graph.element_begin[e + 1]; ++kb)
      if (plan_.graph.element_blocks[static_cast<std::size_t>(kb)] < static_cast<int>(plan_.nodes.size()))
        node_columns += count;
    for (std::int64_t kb = plan_.graph.element_begin[e]; kb < plan_.graph.element_begin[e + 1]; ++kb) {
      const int block = plan_.graph.element_blocks[static_cast<std::size_t>(kb)];
      for (int i = 0; i < plan_.graph.block_size[static_cast<std::size_t>(block)]; ++i, ++row) {
        double sum = 0.0;
        for (int col = 0; col < node_columns; ++col)
          sum += std::abs(K[row * n + col]) * (plan_.unknowns.is_length(col % count) ? element_length_[e] : 1.0);
        floor[static_cast<std::size_t>(block_begin(block) + i)] += eps * sum;
      }
    }
  }
  ResidualSize s;
  for (int b = 0; b < plan_.graph.num_blocks(); ++b) {
    if (joint_of_block_[static_cast<std::size_t>(b)] >= 0) continue;
    const NodeSize size = size_up(plan_.unknowns.motions, floor.data() + block_begin(b));
    s.force = std::max(s.force, size.force);
    s.moment = std::max(s.moment, size.moment);
  }
  s.length = 8.0 * eps * plan_.length_scale;
  s.angle = 8.0 * eps;
  return s;
}

bool System::has_factor(const elements::Slopes& s) const {
  return is_factored_ && s.velocity == factored_.velocity && s.acceleration == factored_.acceleration &&
         s.mass_only == factored_.mass_only;
}

std::optional<Trouble> System::factor(bool rescale, const elements::Slopes& slopes) {
  PhaseTimer timer{counts_.factor};
  if (rescale || !has_factor(slopes)) solver_->rescale();
  is_factored_ = is_trusted_ = false;
  contraction_ = 1.0;
  ++counts_.factorizations;
  const solve::FactorStatus status = solver_->factor(walker_);
  if (status.ok()) {
    factored_ = slopes;
    is_factored_ = true;
    return std::nullopt;
  }
  if (status.outcome == solve::FactorOutcome::not_finite) return Trouble{"a tangent is not finite"};
  if (const char* why = explain_backend(status.outcome)) return Trouble{why};
  std::string text = "the linear system is singular";
  if (status.block >= 0) {
    static const char* const axes[] = {"displacement along axis 1", "displacement along axis 2",
                                       "displacement along axis 3", "rotation about axis 1",
                                       "rotation about axis 2",     "rotation about axis 3"};
    text += ": nothing holds " + block_name(status.block);
    if (joint_of_block_[static_cast<std::size_t>(status.block)] < 0 && status.local >= 0 &&
        status.local < plan_.unknowns.count) {
      std::array<double, 6> unit{};
      unit[static_cast<std::size_t>(status.local)] = 1.0;
      const Vec6<double> eta = plan_.unknowns.expanded(unit.data(), static_cast<std::size_t>(status.block));
      int largest = 0;
      for (int i = 1; i < 6; ++i)
        if (std::abs(eta[i]) > std::abs(eta[largest])) largest = i;
      text += std::string(" (") + axes[largest] + " of its own frame has the largest share)";
    }
    text += ", or it is held some 1e16 times more softly than its neighbours hold each other";
  }
  return Trouble{text};
}

std::optional<Trouble> System::solve(const double* rhs, double* x, bool check) {
  PhaseTimer timer{counts_.solve};
  ++counts_.solutions;
  if (!check && is_trusted_ && solver_->hierarchical() != nullptr) {
    static_cast<void>(solver_->solve(walker_, rhs, x, false));
    return std::nullopt;  // what is not finite shows in the change that it makes
  }
  last_solution_ = solver_->solve(walker_, rhs, x);
  is_trusted_ = last_solution_.backward_error <= 1e-14 && last_solution_.refinement_steps == 0;
  if (!last_solution_.interface_converged)
    return Trouble{"the iteration on the interface problem gave up after " +
                   std::to_string(last_solution_.interface_iterations) +
                   " iterations: choose \"direct\" for /solver/interface_solution, or another /solver/kind"};
  if (!last_solution_.finite) return Trouble{"the solution of the linear system is not finite"};
  if (last_solution_.backward_error > counts_.backward_error_max)
    counts_.backward_error_max = last_solution_.backward_error;
  return std::nullopt;
}

int System::joint_of_block(int block) const { return joint_of_block_[static_cast<std::size_t>(block)]; }

std::string System::block_name(int block) const {
  const int joint = joint_of_block(block);
  if (joint >= 0)
    return plan_.joints[static_cast<std::size_t>(joint)].what + " '" +
           plan_.joints[static_cast<std::size_t>(joint)].name + "'";
  return "'" + plan_.nodes[static_cast<std::size_t>(block)].name + "'";
}

}  // namespace bough::step
