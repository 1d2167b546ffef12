/// Velocities that belong to momenta, and the accelerations and multipliers that belong to a state: linear problems in [M G^T; G 0],
/// solved with an old factor and refined.
#include <algorithm>
#include <cmath>

#include "bough/elements/momentum.hpp"
#include "bough/step/variational.hpp"
#include "system_parts.hpp"

namespace bough::step {

using motion::Se3;
using motion::Vec6;

namespace {
constexpr elements::Slopes mass_slopes{0.0, 0.0, true};
}

/// Largest of lengths over the scene's size, and of angles.
double Variational::largest(const Vectors& vectors) const {
  double lengths = 0.0, angles = 0.0;
  for (const Vec6<double>& v : vectors)
    for (int i = 0; i < 3; ++i) {
      lengths = std::max(lengths, std::abs(v[i]));
      angles = std::max(angles, std::abs(v[3 + i]));
    }
  return std::max(lengths / system_.plan().length_scale, angles);
}

/// Matrix [M G^T; G 0] with the elastic inertia of steps of h.
std::optional<Trouble> Variational::factor_mass(const State& state, double h) {
  mass_step_ = 0.0;
  if (const auto t = mass_.set_time(state.time, laws::Side::left)) return t;
  if (const auto t = mass_.evaluate(state, mass_slopes, true)) return t;
  const elements::Field field = mass_.field(state);
  mass_.begin_matrices();
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k)
      plan::with_element(mass_.plan().elements, mass_.plan().directory[static_cast<std::size_t>(k)],
                         [&](const auto& e) {
                           constexpr int most = 6 * std::decay_t<decltype(e)>::num_ports + elements::max_rows;
                           double elastic[most * most] = {};
                           elements::add_elastic_mass(e, field, elastic_inertia(h), elastic);
                           mass_.add_matrix(static_cast<int>(k), elements::num_unknowns(e), elastic);
                         });
  };
  mass_.walker().for_each_chunk(static_cast<std::int64_t>(mass_.plan().directory.size()), element_grain,
                                tree::make_chunk(by_element));
  if (const auto t = mass_.factor(true, mass_slopes))
    return Trouble{t->text + "; every part that can move needs inertia or has to be held by a joint"};
  mass_step_ = h;
  return std::nullopt;
}

/// P(q, x) + G^T mu = goal_, G dx = row_goals_ for changes dx of the guess, x the velocities of `moving`, mu `multipliers`: solved with the
/// factor at hand and refined until the change is below `target`. A factor that no longer serves is made anew.
std::optional<Trouble> Variational::solve_mass(State& moving, std::vector<double>& multipliers, double h,
                                               double target) {
  constexpr double slowest = 0.05;  // a factor that contracts less than this is made anew
  constexpr int most = 12;
  bool fresh = mass_step_ != h;
  if (fresh)
    if (auto t = factor_mass(moving, h)) return t;
  double previous = 0.0, scale = 0.0;
  for (const Vec6<double>& g : goal_)
    for (int i = 0; i < 6; ++i) scale = std::max(scale, std::abs(g[i]));
  for (int k = 0; k < most; ++k) {
    const elements::Field field = system_.field(moving);
    if (auto t = sums_.evaluate(system_, field, moving.turns, elastic_inertia(h), MomentumSums::Want::momenta))
      return t;
    for (std::size_t n = 0; n < goal_.size(); ++n) left_[n] = goal_[n] - sums_.momentum(n);
    after_.add_forces(multipliers.data(), -1.0, left_);
    for (std::size_t n = 0; n < goal_.size(); ++n) system_.set_node_part(rhs_.data(), static_cast<int>(n), left_[n]);
    set_rows([&](std::size_t m) { return row_goals_[m]; });
    if (auto t = mass_.solve(rhs_.data(), x_.data())) return t;
    const double change = add_solution(moving, multipliers, scale);
    if (!std::isfinite(change)) return Trouble{"velocities or accelerations are not finite"};
    const double rate = previous > 0.0 ? change / previous : 1.0;
    if (change <= target || change * rate <= target) break;
    if (previous > 0.0 && rate > slowest) {
      if (fresh) break;  // as near as round-off allows
      if (auto t = factor_mass(moving, h)) return t;
      fresh = true;
      previous = 0.0;
      continue;
    }
    previous = change;
  }
  return std::nullopt;
}

/// Adds x_ to velocities and multipliers, and what it closes to the rows. Returns the largest change: of motion relative to the motion, of
/// multipliers to their largest or `scale`.
double Variational::add_solution(State& moving, std::vector<double>& multipliers, double scale) {
  std::vector<elements::NodeMotion>& nodes = moving.change<Se3>().motion;
  for (std::size_t n = 0; n < D_.size(); ++n) {
    increments_[n] = node_part(n);
    nodes[n].v += increments_[n];
    left_[n] = nodes[n].v;
  }
  double by_rows = 0.0, largest_row = scale;
  for (const ConstraintRows::Place& p : after_.places())
    for (int k = 0; k < p.joint->num_rows; ++k) {
      const auto m = static_cast<std::size_t>(p.multiplier_begin + k);
      const double* g = after_.gradient(p, k);
      for (int n = 0; n < p.num_nodes; ++n)
        for (int i = 0; i < 6; ++i)
          row_goals_[m] -= g[6 * n + i] * increments_[static_cast<std::size_t>(p.nodes[n])][i];
      multipliers[m] += x_[row_unknown(p, k)];
      by_rows = std::max(by_rows, std::abs(x_[row_unknown(p, k)]));
      largest_row = std::max(largest_row, std::abs(multipliers[m]));
    }
  const double motion = largest(left_);
  return std::max(motion > 0.0 ? largest(increments_) / motion : 0.0, largest_row > 0.0 ? by_rows / largest_row : 0.0);
}

/// P(q, v) + G^T mu = p,  Phi'(q, v) = 0;  then p <- p - G^T mu.
std::optional<Trouble> Variational::solve_velocities(State& state, double h) {
  std::vector<elements::NodeMotion>& nodes = state.change<Se3>().motion;
  for (std::size_t n = 0; n < D_.size(); ++n) nodes[n].v = (2.0 / h) * D_[n] - base_.on<Se3>().motion[n].v;
  system_.constraint_series(state, nullptr, 0.0, series_);
  for (std::size_t m = 0; m < impulses_.size(); ++m) {
    row_goals_[m] = -series_[m].c[1];
    impulses_[m] = 0.0;
  }
  goal_ = state.momentum;
  if (auto t = solve_mass(state, impulses_, h, 1e-15)) return t;
  after_.add_forces(impulses_.data(), -1.0, state.momentum);
  for (std::size_t n = 0; n < D_.size(); ++n)
    if (is_held(n)) state.momentum[n] = sums_.momentum(n);  // the impulses of what holds it taken off
  return std::nullopt;
}

/// Equations of motion with the elastic inertia of steps of h, and Phi''(q, v, a) = 0: what is faster than the step is held back, what is
/// slower changes by O(h^2).
std::optional<Trouble> Variational::solve_accelerations(State& state, double h) {
  // Of dependent rows the multipliers of least norm are wanted: corrections of none have it, those of former ones do not.
  if (mass_step_ > 0.0 && mass_.solver().last_status().deficiency != 0)
    std::fill(state.multipliers.begin(), state.multipliers.end(), 0.0);
  system_.constraint_series(state, nullptr, 0.0, series_);
  for (std::size_t m = 0; m < impulses_.size(); ++m) row_goals_[m] = -2.0 * series_[m].c[2];
  SpatialNodes& mid = mid_.change<Se3>();
  mid.motion = state.on<Se3>().motion;
  mid.rotation = state.on<Se3>().rotation;
  mid_.time = state.time;
  mid_.turns = state.turns;
  mid_.multipliers = impulses_;
  std::fill(mid_.multipliers.begin(), mid_.multipliers.end(), 0.0);
  for (elements::NodeMotion& n : mid.motion) n.a = Vec6<double>::zero();
  if (auto t = system_.evaluate(mid_, {}, false)) return t;
  for (std::size_t n = 0; n < D_.size(); ++n) {
    goal_[n] = -1.0 * system_.node_part(system_.residual().data(), static_cast<int>(n));
    mid.motion[n].v = state.on<Se3>().motion[n].a;
  }
  if (auto t = solve_mass(mid_, state.multipliers, h, 1e-12)) return t;
  if (auto t = recover_multipliers(state, h)) return t;
  std::vector<elements::NodeMotion>& nodes = state.change<Se3>().motion;
  for (std::size_t n = 0; n < D_.size(); ++n) nodes[n].a = mid.motion[n].v;
  return std::nullopt;
}

/// Of joints that hold nodes: from inertia as in the equations of motion above, P(q, a), and all forces without it.
std::optional<Trouble> Variational::recover_multipliers(State& state, double h) {
  if (system_.plan().held.empty()) return std::nullopt;
  if (auto t =
          sums_.evaluate(system_, system_.field(mid_), state.turns, elastic_inertia(h), MomentumSums::Want::momenta))
    return t;
  for (std::size_t n = 0; n < D_.size(); ++n) {
    left_[n] = sums_.momentum(n);
    state.change<Se3>().motion[n].a = Vec6<double>::zero();
  }
  system_.recover_multipliers(state, &left_);
  return std::nullopt;
}

void Variational::add_counts() {
  WorkCounts &from = mass_.counts(), &to = system_.counts();
  to.assemble += from.assemble;
  to.factor += from.factor;
  to.solve += from.solve;
  to.factorizations += from.factorizations;
  to.solutions += from.solutions;
  to.evaluations += from.evaluations;
  to.backward_error_max = std::max(to.backward_error_max, from.backward_error_max);
  to.rank_error_max = std::max(to.rank_error_max, from.rank_error_max);
  from = WorkCounts{};
}

/// The trapezoidal rule holds to O(h^2) where the step resolves the motion.
void Variational::compare_rates(const State& state, double h) {
  const std::vector<elements::NodeMotion>&before = base_.on<Se3>().motion, &after = state.on<Se3>().motion;
  for (std::size_t n = 0; n < D_.size(); ++n) {
    const elements::NodeMotion &a = before[n], &b = after[n];
    increments_[n] = b.v - a.v - (0.5 * h) * (a.a + b.a);
    left_[n] = (0.5 * h) * (a.a + b.a);
  }
  Vectors& changes = residual_;
  for (std::size_t n = 0; n < D_.size(); ++n) changes[n] = after[n].v - before[n].v;
  const double size = std::max(largest(left_), largest(changes));
  unresolved_ = size > 0.0 ? largest(increments_) / size : 0.0;
}

}  // namespace bough::step
