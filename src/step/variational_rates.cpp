/// Velocities from momenta, and accelerations and multipliers of a state. Both are linear problems in [M G^T; G 0],
/// solved with a factorization of an earlier step and iterative refinement.
#include <algorithm>
#include <cmath>

#include "element_parts.hpp"
#include "moving_nodes.hpp"
#include "signal_columns.hpp"
#include "variational_on.hpp"

namespace bough::step {

namespace {
constexpr elements::Slopes mass_slopes{0.0, 0.0, true};
}

/// Largest entry of vectors, lengths relative to the size of the structure.
template <class G>
double VariationalOn<G>::largest(const Vectors& vectors) const {
  double lengths = 0.0, angles = 0.0;
  for (const Vector& v : vectors)
    for (int i = 0; i < G::dof; ++i) {
      double& most = i < G::translations ? lengths : angles;
      most = std::max(most, std::abs(v[i]));
    }
  return std::max(lengths / system_.plan().length_scale, angles);
}

/// Evaluates and factors the matrix [M G^T; G 0] with the elastic inertia of steps of size h.
template <class G>
std::optional<Trouble> VariationalOn<G>::factor_mass(const State& state, double h) {
  mass_step_ = 0.0;
  if (const auto t = mass_.set_time(state.time, laws::Side::left)) return t;
  if (const auto t = mass_.evaluate(state, mass_slopes, true)) return t;
  const Field field = mass_.instant().template field_on<G>(state);
  mass_.linear().begin_matrices();
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k)
      plan::with_element(plan::arrays_on<G>(mass_.plan()), mass_.plan().directory[static_cast<std::size_t>(k)],
                         [&](const auto& e) {
                           constexpr int most = G::dof * std::decay_t<decltype(e)>::num_ports + elements::max_rows;
                           double elastic[most * most] = {};
                           elements::add_elastic_mass(e, field, elastic_inertia(h), elastic);
                           const auto id = static_cast<std::size_t>(k);
                           const int n = elements::num_unknowns(e),
                                     all = n + static_cast<int>(plan::signals_of(mass_.plan(), id).size());
                           if (all == n) return mass_.elements().add_matrix(static_cast<int>(k), n, elastic);
                           std::array<double, most_unknowns * most_unknowns> extended;
                           add_signal_columns(n, all - n, elastic, extended.data(),
                                              [n](int, double* column) { std::fill(column, column + n, 0.0); });
                           mass_.elements().add_matrix(static_cast<int>(k), all, extended.data());
                         });
  };
  mass_.walker().for_each_chunk(static_cast<std::int64_t>(mass_.plan().directory.size()), element_grain,
                                tree::make_chunk(by_element));
  if (const auto t = mass_.linear().factor(true, mass_slopes)) return t;
  mass_step_ = h;
  if (system_.remembers()) mass_state_ = state;
  return std::nullopt;
}

/// Solves P(q, x) + G^T mu = goal_, G dx = row_goals_, where x are the velocities of `moving`, dx their change from the
/// initial guess, and mu are `multipliers`. The present factorization is used with iterative refinement until the
/// change is below `target`, and replaced if the refinement contracts too slowly.
template <class G>
std::optional<Trouble> VariationalOn<G>::solve_mass(State& moving, std::vector<double>& multipliers, double h,
                                                    double target) {
  constexpr double slowest = 0.05;  // factored anew if the refinement contracts more slowly
  constexpr int most = 12;
  bool fresh = mass_step_ != h;
  if (fresh)
    if (auto t = factor_mass(moving, h)) return t;
  double previous = 0.0, scale = 0.0;
  for (const Vector& g : goal_)
    for (int i = 0; i < G::dof; ++i) scale = std::max(scale, std::abs(g[i]));
  for (int k = 0; k < most; ++k) {
    const Field field = system_.instant().template field_on<G>(moving);
    if (auto t = sums_.evaluate(system_, field, moving.turns, elastic_inertia(h), Sums::Want::momenta)) return t;
    for (std::size_t n = 0; n < goal_.size(); ++n) left_[n] = goal_[n] - sums_.momentum(n);
    after_.add_forces(multipliers.data(), -1.0, left_);
    for (std::size_t n = 0; n < goal_.size(); ++n)
      system_.places().set_node_part(rhs_.data(), static_cast<int>(n), left_[n]);
    set_rows([&](const Place& place, int row) { return row_goals_[place.multiplier(row)]; });
    for (const std::size_t unknown : system_.places().signals()) rhs_[unknown] = 0.0;  // they are known
    if (auto t = mass_.linear().solve(rhs_.data(), x_.data())) return t;
    const double change = add_solution(moving, multipliers, scale);
    if (!std::isfinite(change)) return Trouble{"velocities or accelerations are not finite"};
    const double rate = previous > 0.0 ? change / previous : 1.0;
    if (change <= target || change * rate <= target) break;
    if (previous > 0.0 && rate > slowest) {
      if (fresh) break;  // round-off prevents a smaller change
      if (auto t = factor_mass(moving, h)) return t;
      fresh = true;
      previous = 0.0;
      continue;
    }
    previous = change;
  }
  return std::nullopt;
}

/// Adds the solution x_ to velocities and multipliers, and subtracts its part from row_goals_. Returns the largest
/// change, of velocities relative to the velocities, of multipliers relative to the larger of their maximum and
/// `scale`.
template <class G>
double VariationalOn<G>::add_solution(State& moving, std::vector<double>& multipliers, double scale) {
  Nodes& moved = change(moving);
  for (std::size_t n = 0; n < D_.size(); ++n) {
    increments_[n] = node_part(n);
    moved[n].v += increments_[n];
    left_[n] = moved[n].v;
  }
  double by_rows = 0.0, largest_row = scale;
  for (const Place& p : after_.places())
    for (int k = 0; k < p.joint->num_rows; ++k) {
      const std::size_t m = p.multiplier(k);
      const double* g = after_.gradient(p, k);
      for (int n = 0; n < p.num_nodes; ++n)
        for (int i = 0; i < G::dof; ++i)
          row_goals_[m] -= g[G::dof * n + i] * increments_[static_cast<std::size_t>(p.nodes[n])][i];
      multipliers[m] += x_[row_unknown(p, k)];
      by_rows = std::max(by_rows, std::abs(x_[row_unknown(p, k)]));
      largest_row = std::max(largest_row, std::abs(multipliers[m]));
    }
  const double motion = largest(left_);
  return std::max(motion > 0.0 ? largest(increments_) / motion : 0.0, largest_row > 0.0 ? by_rows / largest_row : 0.0);
}

/// Solves P(q, v) + G^T mu = p,  Phi'(q, v) = 0 for v and mu;  then p <- p - G^T mu.
template <class G>
std::optional<Trouble> VariationalOn<G>::solve_velocities(State& state, double h) {
  Nodes& moved = change(state);
  for (std::size_t n = 0; n < D_.size(); ++n) moved[n].v = (2.0 / h) * D_[n] - nodes(base_)[n].v;
  system_.constraints().series(state, nullptr, 0.0, series_);
  for (std::size_t m = 0; m < impulses_.size(); ++m) {
    row_goals_[m] = -series_[m].c[1];
    impulses_[m] = 0.0;
  }
  goal_ = state.on<G>().momentum;
  if (auto t = solve_mass(state, impulses_, h, 1e-15)) return t;
  Vectors& momentum = state.change<G>().momentum;
  after_.add_forces(impulses_.data(), -1.0, momentum);
  for (std::size_t n = 0; n < D_.size(); ++n)
    momentum[n] = is_held(n) ? sums_.momentum(n)  // without the impulses of the joints that hold the node
                             : without_moment_on_point(n, momentum[n]);
  return std::nullopt;
}

/// Solves the equations of motion with the elastic inertia of steps of size h, and Phi''(q, v, a) = 0. The elastic
/// inertia reduces accelerations of vibrations faster than the step, and changes slower ones by O(h^2).
template <class G>
std::optional<Trouble> VariationalOn<G>::solve_accelerations(State& state, double h) {
  // If rows are dependent, the multipliers of least norm are required. Refinement started from zero gives these;
  // started from earlier multipliers it does not.
  if (mass_step_ > 0.0 && mass_.linear().solver().last_status().deficiency != 0)
    std::fill(state.multipliers.begin(), state.multipliers.end(), 0.0);
  system_.constraints().series(state, nullptr, 0.0, series_);
  for (std::size_t m = 0; m < impulses_.size(); ++m) row_goals_[m] = -2.0 * series_[m].c[2];
  NodesOn<G>& mid = mid_.change<G>();
  mid.motion = nodes(state);
  mid.rotation = state.on<G>().rotation;
  mid_.time = state.time;
  mid_.turns = state.turns;
  mid_.signals = state.signals;
  mid_.multipliers = impulses_;
  std::fill(mid_.multipliers.begin(), mid_.multipliers.end(), 0.0);
  for (auto& n : mid.motion) n.a = Vector::zero();
  if (auto t = system_.evaluate(mid_, {}, false)) return t;
  for (std::size_t n = 0; n < D_.size(); ++n) {
    goal_[n] = system_.places().part_on<G>(system_.right_hand_side().data(), static_cast<int>(n));
    mid.motion[n].v = nodes(state)[n].a;
  }
  if (auto t = solve_mass(mid_, state.multipliers, h, 1e-12)) return t;
  if (auto t = recover_multipliers(state, h)) return t;
  Nodes& moved = change(state);
  for (std::size_t n = 0; n < D_.size(); ++n) moved[n].a = nodes(mid_)[n].v;
  return std::nullopt;
}

/// Recovers the multipliers of joints that hold nodes, from the inertia P(q, a) of the equations of motion above and
/// all other forces.
template <class G>
std::optional<Trouble> VariationalOn<G>::recover_multipliers(State& state, double h) {
  if (system_.plan().held.empty()) return std::nullopt;
  if (auto t = sums_.evaluate(system_, system_.instant().template field_on<G>(mid_), state.turns, elastic_inertia(h),
                              Sums::Want::momenta))
    return t;
  Nodes& moved = change(state);
  for (std::size_t n = 0; n < D_.size(); ++n) {
    inertia_[n] = vector_in_space(system_.plan(), n, sums_.momentum(n));
    moved[n].a = Vector::zero();
  }
  system_.recover_multipliers(state, &inertia_);
  return std::nullopt;
}

template <class G>
void VariationalOn<G>::add_counts() {
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

/// Sets unresolved_ from the error of the trapezoidal rule for velocities, which is O(h^2) if the step resolves the
/// motion.
template <class G>
void VariationalOn<G>::compare_rates(const State& state, double h) {
  const Nodes &before = nodes(base_), &after = nodes(state);
  for (std::size_t n = 0; n < D_.size(); ++n) {
    const auto &a = before[n], &b = after[n];
    increments_[n] = b.v - a.v - (0.5 * h) * (a.a + b.a);
    left_[n] = (0.5 * h) * (a.a + b.a);
  }
  Vectors& changes = residual_;
  for (std::size_t n = 0; n < D_.size(); ++n) changes[n] = after[n].v - before[n].v;
  const double size = std::max(largest(left_), largest(changes));
  unresolved_ = size > 0.0 ? largest(increments_) / size : 0.0;
}

// The class as a whole is instantiated once, in variational.cpp.
#define BOUGH_INSTANTIATE(G)                                                             \
  template double VariationalOn<G>::largest(const Vectors&) const;                       \
  template std::optional<Trouble> VariationalOn<G>::factor_mass(const State&, double);   \
  template std::optional<Trouble> VariationalOn<G>::solve_velocities(State&, double);    \
  template std::optional<Trouble> VariationalOn<G>::solve_accelerations(State&, double); \
  template std::optional<Trouble> VariationalOn<G>::recover_multipliers(State&, double); \
  template void VariationalOn<G>::add_counts();                                          \
  template void VariationalOn<G>::compare_rates(const State&, double);
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE)
#undef BOUGH_INSTANTIATE

}  // namespace bough::step
