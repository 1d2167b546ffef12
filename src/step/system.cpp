#include "bough/step/system.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

namespace bough::step {

using elements::NodeMotion;
using motion::Vec3;
using motion::Vec6;

namespace {

/// CPU seconds of the whole process, all threads.
double cpu_now() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct PhaseTimer {
  double& sum;
  double start = cpu_now();
  ~PhaseTimer() { sum += cpu_now() - start; }
};

std::unique_ptr<solve::AnySolver> make_solver(const plan::Plan& plan, const tree::Tree& tree, const scene::Solver& given) {
  solve::SolveOptions options;
  options.penalty_factor = given.penalty_factor;
  if (given.kind == scene::SolverKind::monolithic)
    return std::make_unique<solve::AnySolver>(solve::Monolithic(plan.graph, tree, options));
  return std::make_unique<solve::AnySolver>(solve::Hierarchical(plan.graph, tree, options));
}

std::unique_ptr<tree::Tree> make_scene_tree(const plan::Plan& plan, const scene::Solver& given) {
  tree::TreeOptions options;
  options.leaf_size = given.leaf_size;
  options.depth = given.depth;
  return std::make_unique<tree::Tree>(tree::make_tree(plan.graph, options));
}

constexpr std::int64_t element_grain = 32, block_grain = 128;

template <class E>
  requires requires(const E& e) { e.length; }
double length_of(const E& e, const std::vector<plan::NodePlan>&, double) {
  return e.length;
}
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
    if (plan.joints[j].block >= 0) joint_of_block_[static_cast<std::size_t>(plan.joints[j].block)] = static_cast<int>(j);
  }
  law_values_.assign(plan.laws.size(), 0.0);
  law_rates_ = law_accelerations_ = law_values_;
  law_series_.resize(plan.laws.size());
  row_series_.resize(static_cast<std::size_t>(plan.num_multipliers));
  work_.rhs.assign(num_unknowns(), 0.0);
  work_.x = work_.rhs;
  work_.v.assign(plan.nodes.size(), Vec6<double>::zero());
  work_.a = work_.algorithmic = work_.v;
  chunk_max_.assign((num_elements + element_grain - 1) / element_grain + 1, 0.0);
}

std::optional<Trouble> System::set_time(double time, laws::Side side) {
  time_ = time;
  for (std::size_t i = 0; i < plan_.laws.size(); ++i) {
    const laws::LawValue v = plan_.laws[i].law.at(time, side);
    if (const auto which = laws::non_finite(v))
      return Trouble{"the time function of '" + plan_.laws[i].user + "' is not finite at time " + std::to_string(time) + ": " + *which};
    law_values_[i] = v.value;
    law_rates_[i] = v.rate;
    law_accelerations_[i] = v.acceleration;
  }
  return std::nullopt;
}

elements::Field System::field(const State& state, const elements::Slopes& slopes, bool with_inertia) const {
  elements::Field f;
  f.nodes = state.nodes.data();
  f.slopes = slopes;
  f.around.gravity = law_values_[static_cast<std::size_t>(plan_.gravity_law)] * plan_.gravity;
  f.around.laws = law_values_.data();
  f.around.has_inertia = plan_.is_dynamic && with_inertia;
  return f;
}

std::optional<Trouble> System::evaluate(const State& state, const elements::Slopes& slopes, bool tangent) {
  PhaseTimer timer{counts_.assemble};
  ++counts_.evaluations;
  const elements::Field f = field(state, slopes);
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const auto id = static_cast<std::size_t>(tree_->element_order[static_cast<std::size_t>(k)]);
      const int j = joint_of_element_[id];
      const double* multipliers = nullptr;
      double turns = 0.0;
      if (j >= 0) {
        multipliers = state.multipliers.data() + plan_.joints[static_cast<std::size_t>(j)].multiplier_begin;
        turns = state.turns[static_cast<std::size_t>(j)];
      }
      double* matrix = tangent ? solver_->element_matrix(static_cast<int>(id)) : nullptr;
      plan::with_element(plan_.elements, plan_.directory[id], [&](const auto& e) {
        double* residual = element_residual_.data() + element_begin_[id];
        elements::evaluate(e, f, multipliers, turns, residual, matrix);
        elements::eval_magnitude(e, f, residual, element_magnitude_.data() + element_begin_[id]);
      });
    }
  };
  walker_.for_each_chunk(static_cast<std::int64_t>(tree_->element_order.size()), element_grain, tree::make_chunk(by_element));
  auto by_block = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t b = begin; b < end; ++b) {
      const auto block = static_cast<std::size_t>(b);
      const int size = plan_.graph.block_size[block];
      double* r = residual_.data() + tree_->unknown_begin[block];
      double* m = magnitude_.data() + tree_->unknown_begin[block];
      for (int i = 0; i < size; ++i) r[i] = m[i] = 0.0;
      for (std::int64_t u = use_begin_[block]; u < use_begin_[block + 1]; ++u) {
        const double* part = element_residual_.data() + uses_[static_cast<std::size_t>(u)];
        const double* terms = element_magnitude_.data() + uses_[static_cast<std::size_t>(u)];
        for (int i = 0; i < size; ++i) {
          r[i] += part[i];
          m[i] += terms[i];
        }
      }
    }
  };
  walker_.for_each_chunk(plan_.graph.num_blocks(), block_grain, tree::make_chunk(by_block));
  for (double r : residual_)
    if (!std::isfinite(r)) {
      for (std::size_t e = 0; e < plan_.directory.size(); ++e)
        for (std::int64_t i = element_begin_[e]; i < element_begin_[e + 1]; ++i)
          if (!std::isfinite(element_residual_[static_cast<std::size_t>(i)]))
            return Trouble{"the forces of '" + plan_.element_owner[e] + "' are not finite at time " + std::to_string(time_)};
      return Trouble{"a sum of forces is not finite at time " + std::to_string(time_)};
    }
  return std::nullopt;
}

ResidualSize System::residual_size() const {
  ResidualSize s;
  for (int b = 0; b < plan_.graph.num_blocks(); ++b) {
    const auto begin = static_cast<std::size_t>(block_begin(b));
    const int joint = joint_of_block_[static_cast<std::size_t>(b)];
    if (joint < 0) {
      for (std::size_t i = 0; i < 6; ++i) {
        double& size = i < 3 ? s.force : s.moment;
        double& scale = i < 3 ? s.force_scale : s.moment_scale;
        if (std::abs(residual_[begin + i]) > size) {
          size = std::abs(residual_[begin + i]);
          (i < 3 ? s.worst_force_node : s.worst_moment_node) = b;
        }
        scale = std::max(scale, magnitude_[begin + i]);
      }
    } else {
      const auto& e = plan::array_of<elements::Joint>(plan_.elements)[static_cast<std::size_t>(
          plan_.directory[static_cast<std::size_t>(plan_.joints[static_cast<std::size_t>(joint)].element)].index)];
      for (int k = 0; k < e.num_rows; ++k) {
        const bool is_length = e.rows[k].kind == elements::RowKind::along || e.rows[k].kind == elements::RowKind::screw;
        double& size = is_length ? s.length : s.angle;
        const double value = std::abs(residual_[begin + static_cast<std::size_t>(k)]);
        if (value > std::max(s.length, s.angle)) s.worst_joint = joint;
        size = std::max(size, value);
      }
    }
  }
  return s;
}

ResidualSize System::round_off_floor(const State&) const {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  std::vector<double> floor(num_unknowns(), 0.0);
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    const int n = static_cast<int>(element_begin_[e + 1] - element_begin_[e]);
    const double* K = const_cast<solve::AnySolver&>(*solver_).element_matrix(static_cast<int>(e));
    int row = 0;
    for (std::int64_t kb = plan_.graph.element_begin[e]; kb < plan_.graph.element_begin[e + 1]; ++kb) {
      const int block = plan_.graph.element_blocks[static_cast<std::size_t>(kb)];
      for (int i = 0; i < plan_.graph.block_size[static_cast<std::size_t>(block)]; ++i, ++row) {
        double sum = 0.0;
        for (int col = 0; col < n; ++col) {
          const bool is_node_column = col < (n / 6) * 6;
          if (is_node_column) sum += std::abs(K[row * n + col]) * (col % 6 < 3 ? element_length_[e] : 1.0);
        }
        floor[static_cast<std::size_t>(block_begin(block) + i)] += eps * sum;
      }
    }
  }
  ResidualSize s;
  for (int b = 0; b < plan_.graph.num_blocks(); ++b) {
    if (joint_of_block_[static_cast<std::size_t>(b)] >= 0) continue;
    for (int i = 0; i < 6; ++i) {
      double& size = i < 3 ? s.force : s.moment;
      size = std::max(size, floor[static_cast<std::size_t>(block_begin(b) + i)]);
    }
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
  is_factored_ = false;
  contraction_ = 1.0;
  ++counts_.factorizations;
  const solve::FactorStatus status = solver_->factor(walker_);
  counts_.deficiency = std::max(counts_.deficiency, status.deficiency);
  if (status.ok()) {
    factored_ = slopes;
    is_factored_ = true;
    return std::nullopt;
  }
  if (status.outcome == solve::FactorOutcome::not_finite) return Trouble{"a tangent is not finite"};
  std::string text = "the linear system is singular";
  if (status.block >= 0) {
    static const char* const axes[] = {"displacement along axis 1", "displacement along axis 2", "displacement along axis 3",
                                       "rotation about axis 1", "rotation about axis 2", "rotation about axis 3"};
    text += ": nothing holds " + block_name(status.block);
    if (joint_of_block_[static_cast<std::size_t>(status.block)] < 0 && status.local >= 0 && status.local < 6)
      text += std::string(" (") + axes[status.local] + " of its own frame has the largest share)";
  }
  return Trouble{text};
}

std::optional<Trouble> System::solve(const double* rhs, double* x) {
  PhaseTimer timer{counts_.solve};
  ++counts_.solutions;
  last_solution_ = solver_->solve(walker_, rhs, x);
  if (!last_solution_.finite) return Trouble{"the solution of the linear system is not finite"};
  if (last_solution_.backward_error > counts_.backward_error_max) counts_.backward_error_max = last_solution_.backward_error;
  return std::nullopt;
}

double System::apply(State& state, const double* x) {
  PhaseTimer timer{counts_.update};
  const auto node_increment = [&](int node) {
    Vec6<double> eta;
    const double* from = x + block_begin(node);
    for (int i = 0; i < 6; ++i) eta[i] = from[i];
    return eta;
  };
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    double most = 0.0;
    for (std::int64_t k = begin; k < end; ++k) {
      const auto id = static_cast<std::size_t>(k);
      plan::with_element(plan_.elements, plan_.directory[id], [&](const auto& e) {
        const elements::Port* first = nullptr;
        for (const elements::Port& p : e.ports) {
          if (p.node == elements::ground) continue;
          Vec6<double> change = node_increment(p.node);
          constexpr int num_ports = std::decay_t<decltype(e)>::num_ports;
          if (first != nullptr) {
            const NodeMotion& a = state.nodes[static_cast<std::size_t>(first->node)];
            const NodeMotion& b = state.nodes[static_cast<std::size_t>(p.node)];
            const motion::Frame<double> H{lanes::transpose_times(a.R, b.R),
                                          lanes::transpose_times(a.R, motion::difference(b.x, a.x))};
            change -= motion::inverse_adjoint_times(H, node_increment(first->node));
          } else if (num_ports > 1 && e.ports[0].node != elements::ground) {
            first = &p;
            continue;
          }
          for (int i = 0; i < 3; ++i) {
            most = std::max(most, std::abs(change[i]) / element_length_[id]);
            most = std::max(most, std::abs(change[3 + i]));
          }
        }
      });
    }
    chunk_max_[static_cast<std::size_t>(begin / element_grain)] = most;
  };
  std::fill(chunk_max_.begin(), chunk_max_.end(), 0.0);
  walker_.for_each_chunk(static_cast<std::int64_t>(plan_.directory.size()), element_grain, tree::make_chunk(by_element));
  auto by_node = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t n = begin; n < end; ++n) move_node(state, static_cast<std::size_t>(n), node_increment(static_cast<int>(n)));
  };
  walker_.for_each_chunk(static_cast<std::int64_t>(state.nodes.size()), block_grain, tree::make_chunk(by_node));
  for (const plan::JointPlan& j : plan_.joints) {
    if (j.block < 0) continue;
    const int size = plan_.graph.block_size[static_cast<std::size_t>(j.block)];
    for (int i = 0; i < size; ++i) state.multipliers[static_cast<std::size_t>(j.multiplier_begin + i)] += x[block_begin(j.block) + i];
  }
  return *std::max_element(chunk_max_.begin(), chunk_max_.end());
}

void System::evaluate_rate(const State& state, std::vector<double>& rate) {
  const elements::Field f = field(state);
  using T = lanes::Taylor<double, 1>;
  std::vector<T> laws(plan_.laws.size());
  for (std::size_t i = 0; i < laws.size(); ++i) {
    laws[i].c[0] = law_values_[i];
    laws[i].c[1] = law_rates_[i];
  }
  elements::Surroundings<T> around;
  for (int k = 0; k < 3; ++k) around.gravity[k] = plan_.gravity[k] * laws[static_cast<std::size_t>(plan_.gravity_law)];
  around.laws = laws.data();
  around.has_inertia = plan_.is_dynamic;
  rate.assign(num_unknowns(), 0.0);
  std::vector<double> part;
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    part.assign(static_cast<std::size_t>(element_begin_[e + 1] - element_begin_[e]), 0.0);
    const int j = joint_of_element_[e];
    const double* multipliers =
        j >= 0 ? state.multipliers.data() + plan_.joints[static_cast<std::size_t>(j)].multiplier_begin : nullptr;
    const double turns = j >= 0 ? state.turns[static_cast<std::size_t>(j)] : 0.0;
    plan::with_element(plan_.elements, plan_.directory[e], [&](const auto& element) {
      elements::evaluate_rate(element, f, around, multipliers, turns, part.data());
    });
    std::size_t at = 0;
    for (std::int64_t k = plan_.graph.element_begin[e]; k < plan_.graph.element_begin[e + 1]; ++k) {
      const int block = plan_.graph.element_blocks[static_cast<std::size_t>(k)];
      for (int i = 0; i < plan_.graph.block_size[static_cast<std::size_t>(block)]; ++i)
        rate[static_cast<std::size_t>(block_begin(block) + i)] += part[at++];
    }
  }
}

void System::constraint_series(const State& state, const Vec6<double>* jerk, double step_size,
                               std::vector<lanes::Taylor<double, 3>>& out) const {
  const elements::Field f = field(state);
  std::vector<lanes::Taylor<double, 3>>& laws = law_series_;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    laws[i].c[0] = law_values_[i];
    laws[i].c[1] = law_rates_[i];
    laws[i].c[2] = 0.5 * law_accelerations_[i];
    // Laws tell two derivatives; the third enters a term of order h^2 only, so a one-sided difference over a step will do.
    laws[i].c[3] = 0.0;
    if (step_size > 0.0 && !plan_.laws[i].law.is_constant()) {
      const double next = plan_.laws[i].law.at(time_ + step_size, laws::Side::left).acceleration;
      if (std::isfinite(next)) laws[i].c[3] = (next - law_accelerations_[i]) / (6.0 * step_size);
    }
  }
  out.resize(static_cast<std::size_t>(plan_.num_multipliers));
  for (std::size_t j = 0; j < plan_.joints.size(); ++j)
    plan::with_element(plan_.elements, plan_.directory[static_cast<std::size_t>(plan_.joints[j].element)], [&](const auto& e) {
      if constexpr (std::is_same_v<std::decay_t<decltype(e)>, elements::Joint>)
        elements::evaluate_constraint_series(e, f, jerk, laws.data(), state.turns[j],
                                             out.data() + plan_.joints[j].multiplier_begin);
    });
}

double System::constraint_violation(const State& state, int order, int* joint) const {
  std::vector<lanes::Taylor<double, 3>>& series = row_series_;
  constraint_series(state, nullptr, 0.0, series);
  double most = 0.0;
  for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
    const int block = plan_.joints[j].block;
    const int size = block < 0 ? 0 : plan_.graph.block_size[static_cast<std::size_t>(block)];
    for (int i = 0; i < size; ++i) {
      const double value = std::abs(series[static_cast<std::size_t>(plan_.joints[j].multiplier_begin + i)].c[order]);
      if (value > most) {
        most = value;
        if (joint != nullptr) *joint = static_cast<int>(j);
      }
    }
  }
  return most;
}

int System::joint_of_block(int block) const { return joint_of_block_[static_cast<std::size_t>(block)]; }

std::string System::block_name(int block) const {
  const int joint = joint_of_block(block);
  if (joint >= 0) return plan_.joints[static_cast<std::size_t>(joint)].what + " '" + plan_.joints[static_cast<std::size_t>(joint)].name + "'";
  return "'" + plan_.nodes[static_cast<std::size_t>(block)].name + "'";
}

}  // namespace bough::step
