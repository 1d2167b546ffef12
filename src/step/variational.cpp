#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bough/elements/rows.hpp"
#include "element_parts.hpp"
#include "moving_nodes.hpp"
#include "newton.hpp"
#include "signal_columns.hpp"
#include "variational_on.hpp"

namespace bough::step {

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

template <class Vector>
void add_sizes(const Vector& v, Vector& to) {
  for (int i = 0; i < v.size(); ++i) to[i] += std::abs(v[i]);
}

}  // namespace

template <class G>
VariationalOn<G>::VariationalOn(System& system, const scene::Solver& solver, double newmark_beta)
    : system_(system),
      solver_(solver),
      newmark_beta_(newmark_beta),
      mass_(system.plan(), solver, system.walker()),
      sums_(system.plan()),
      before_(system.plan()),
      after_(system.plan()),
      base_(make_initial_state(system.plan())),
      mid_(base_) {
  D_.assign(system.plan().nodes.size(), Vector::zero());
  residual_ = increments_ = goal_ = left_ = D_;
  inertia_.assign(D_.size(), motion::Vec6<double>::zero());
  end_laws_.assign(system.plan().laws.size(), 0.0);
  impulses_.assign(static_cast<std::size_t>(system.plan().num_multipliers), 0.0);
  row_goals_ = impulses_;
  series_.resize(impulses_.size());
  if (!system.signals().are_none())
    signal_sums_ = std::make_unique<ResidualSums>(system.plan(), system.places(), system.linear(), nullptr);
  rhs_.assign(system.places().size(), 0.0);
  x_ = rhs_;
}

template <class G>
StartReport VariationalOn<G>::start(State& state, const StepOptions& /*options*/, double step_size) {
  state.step_size = step_size;
  state.change<G>().momentum.resize(D_.size());
  state.last_step = 0.0;
  mass_step_ = 0.0;
  StartReport report;
  const std::optional<Trouble> trouble = set_momenta(state, step_size);
  report.ok = !trouble;
  if (trouble) report.cause = trouble->text;
  return report;
}

/// The momenta for the new step size are computed at the beginning of the next step.
template <class G>
StartReport VariationalOn<G>::change_step_size(State& state, const StepOptions& /*options*/, double step_size) {
  state.step_size = step_size;
  StartReport report;
  report.ok = true;
  return report;
}

/// tau = (beta - 1/4) h^2 with the beta of Newmark's rule.
template <class G>
double VariationalOn<G>::elastic_inertia(double h) const {
  return (newmark_beta_ - 0.25) * h * h;
}

/// Sets the momenta that belong to the velocities in steps of size h.
template <class G>
std::optional<Trouble> VariationalOn<G>::set_momenta(State& state, double h) {
  const Field field = system_.instant().template field_on<G>(state);
  if (auto t = sums_.evaluate(system_, field, state.turns, elastic_inertia(h), Sums::Want::momenta)) return t;
  Vectors& momentum = state.change<G>().momentum;
  for (std::size_t n = 0; n < D_.size(); ++n) momentum[n] = sums_.momentum(n);
  return std::nullopt;
}

/// Predictor D = h v_n + (h^2/2) a_n. After the first step a_n = 2 (v_n - D_n / h_n) / h_n, from the increment D_n of
/// the last step. The accelerations of the equations of motion may contain vibrations faster than the step, which would
/// spoil the prediction.
template <class G>
void VariationalOn<G>::predict(double h) {
  const double last = base_.last_step;
  for (std::size_t n = 0; n < D_.size(); ++n) {
    const auto& node = nodes(base_)[n];
    const Vector a = last > 0.0 ? Vector((2.0 / last) * (node.v - (1.0 / last) * node.dq)) : node.a;
    D_[n] = h * node.v + (0.5 * h * h) * a;
  }
}

/// Places the nodes at the end and at the middle of the step according to D.
template <class G>
std::optional<Trouble> VariationalOn<G>::place_nodes(State& next, double h) {
  const NodesOn<G>& base = base_.on<G>();
  NodesOn<G>&mid = mid_.change<G>(), &end = next.change<G>();
  for (std::size_t n = 0; n < D_.size(); ++n) {
    if (!(On::template angular_square<double>(D_[n]) <= largest_turn * largest_turn))
      return Trouble{"'" + system_.plan().nodes[n].name + "' turns by nearly half a turn in one step"};
    place_node(base, n, Vector(0.5 * D_[n]), mid);
    place_node(base, n, D_[n], end);
    mid.motion[n].v = (1.0 / h) * D_[n];
    mid.motion[n].a = Vector::zero();
  }
  return std::nullopt;
}

/// Signals of the middle: states by the slope of their rate at the start, the others as the predicted motion has them.
template <class G>
void VariationalOn<G>::predict_signals(double h) {
  mid_.signals = base_.signals;
  for (std::size_t i = 0; i < mid_.signals.value.size(); ++i)
    if (system_.plan().signals[i].is_state()) mid_.signals.value[i] += 0.5 * h * base_.signals.rate[i];
}

/// The equations of signals at the middle of the step, s - f = 0 and, of states, (2/h) (x - x_n) - f = 0.
template <class G>
std::optional<Trouble> VariationalOn<G>::evaluate_signals(const elements::Slopes& slopes, double h,
                                                          ResidualSize& size) {
  SignalValues& middle = mid_.signals;
  for (std::size_t i = 0; i < middle.value.size(); ++i)
    if (system_.plan().signals[i].is_state()) middle.rate[i] = (2.0 / h) * (middle.value[i] - base_.signals.value[i]);
  system_.signals().evaluate(mid_, slopes, false, *signal_sums_);
  const ResidualSize of_signals = signal_sums_->size();
  size.signal = of_signals.signal;
  size.worst_signal = of_signals.worst_signal;
  if (const int lost = signal_sums_->lost_signal(); lost >= 0)
    return Trouble{"signal '" + system_.plan().signals[static_cast<std::size_t>(lost)].name +
                   "' is not finite at time " + std::to_string(base_.time)};
  return std::nullopt;
}

/// States that only observe, by the rule of the others.
template <class G>
void VariationalOn<G>::observe_signals(State& next, double h) {
  SignalValues& middle = mid_.signals;
  const auto for_states = [&](auto&& f) {
    for (std::size_t i = plan::driving_signals(system_.plan()).size(); i < middle.value.size(); ++i)
      if (system_.plan().signals[i].is_state()) f(i);
  };
  for_states([&](std::size_t i) { middle.rate[i] = (2.0 / h) * (middle.value[i] - base_.signals.value[i]); });
  system_.signals().observe(mid_, 2.0 / h);
  for_states([&](std::size_t i) { next.signals.value[i] = 2.0 * middle.value[i] - base_.signals.value[i]; });
}

/// States at the end, x_{n+1} = 2 x - x_n, and the signals that rows take there, with which the laws of the end are
/// completed.
template <class G>
std::optional<Trouble> VariationalOn<G>::end_signals(State& next, double h) {
  next.signals.given = base_.signals.given;
  for (std::size_t i = 0; i < mid_.signals.value.size(); ++i)
    if (system_.plan().signals[i].is_state())
      next.signals.value[i] = 2.0 * mid_.signals.value[i] - base_.signals.value[i];
  if (!system_.plan().signals_drive) return std::nullopt;
  if (auto t = system_.set_time(end_time_, laws::Side::left)) return t;
  system_.signals().follow_motion(next);
  end_laws_ = system_.instant().law_values();
  return system_.set_time(end_time_ - 0.5 * h, laws::Side::left);
}

/// residual_ = (2/h) B (-D_1 L_d - p_n + (h/2) G_n^T lambda) by node, and the rows at the end of the step. B =
/// T(-D/2)^-T T(-D)^T = (1 + Ad(exp(D/2))^T)/2 carries wrenches from the start to the middle such that forces of the
/// middle are in it as they are: stiff ones then meet their own tangent in the iteration.
template <class G>
std::optional<Trouble> VariationalOn<G>::evaluate_step(State& next, const elements::Slopes& slopes, double h,
                                                       ResidualSize& size) {
  PhaseTimer timer{system_.clock(), system_.counts().assemble};
  ++system_.counts().evaluations;
  size = ResidualSize{};
  if (!system_.signals().are_none()) {
    if (auto t = end_signals(next, h)) return t;
    if (auto t = evaluate_signals(slopes, h, size)) return t;
  }
  const Field middle = system_.instant().template field_on<G>(mid_);
  if (auto t = sums_.evaluate(system_, middle, base_.turns, elastic_inertia(h), Sums::Want::forces)) return t;
  Field end = system_.instant().template field_on<G>(next);
  end.around.laws = end_laws_.data();
  after_.evaluate(system_, end, base_.turns);
  for (Vector& f : residual_) f = Vector::zero();
  before_.add_forces(mid_.multipliers.data(), 1.0, residual_);
  for (std::size_t n = 0; n < D_.size(); ++n) {
    const Vector P = sums_.momentum(n), p = base_.on<G>().momentum[n], half = 0.5 * D_[n];
    Vector terms = sums_.force_size(n);
    add_sizes(residual_[n], terms);
    add_sizes(Vector((2.0 / h) * (P - p)), terms);
    add_sizes(On::template dual_bracket<double>(nodes(mid_)[n].v, P), terms);
    residual_[n] -= (2.0 / h) * p;
    residual_[n] = 0.5 * (residual_[n] + On::template adjoint_transpose_times<double>(G::exp(half), residual_[n])) +
                   (2.0 / h) * On::template inverse_tangent_transpose_times<double>(Vector(-half), P) + sums_.force(n);
    residual_[n] = without_moment_on_point(n, residual_[n]);
    const Vector left = residual_[n];
    if (is_held(n)) {  // the joints that hold the node balance it
      add_sizes(left, terms);
      residual_[n] = Vector::zero();
    }
    for (int i = 0; i < G::dof; ++i) {
      const bool is_force = i < G::translations;
      double& largest = is_force ? size.force : size.moment;
      double& scale = is_force ? size.force_scale : size.moment_scale;
      if (!std::isfinite(left[i]))
        return Trouble{"the forces at '" + system_.plan().nodes[n].name + "' are not finite at time " +
                       std::to_string(base_.time)};
      const double r = std::abs(residual_[n][i]);
      if (r > largest) {
        largest = r;
        (is_force ? size.worst_force_node : size.worst_moment_node) = static_cast<int>(n);
      }
      scale = std::max(scale, terms[i]);
    }
  }
  for (const Place& p : after_.places())
    for (int k = 0; k < p.joint->num_rows; ++k) {
      const bool is_length = elements::is_length(p.joint->rows[k].kind);
      const double gap = std::abs(after_.value(p, k));
      if (!std::isfinite(gap)) return Trouble{"the constraints of a joint are not finite"};
      if (gap > std::max(size.length, size.angle))
        size.worst_joint = system_.plan().joint_of_element[static_cast<std::size_t>(p.element)];
      (is_length ? size.length : size.angle) = std::max(is_length ? size.length : size.angle, gap);
    }
  return std::nullopt;
}

/// Round-off floor of the residual, from the momenta and the present element matrices.
template <class G>
ResidualSize VariationalOn<G>::round_off_floor(double h) const {
  ResidualSize floor = system_.round_off().floor();
  for (std::size_t n = 0; n < D_.size(); ++n)
    for (int i = 0; i < G::dof; ++i) {
      double& f = i < G::translations ? floor.force : floor.moment;
      f = std::max(f, (2.0 * eps / h) * std::abs(base_.on<G>().momentum[n][i]));
    }
  return floor;
}

/// (2/h) T(-D/2)^-T P + F of the elastic inertia, F = ad(v)^T P at each node but for rates of strain: stiffness
/// between the axes of the nodes, which h omega times it would spoil if it were left out.
template <class G>
template <class E>
void VariationalOn<G>::add_elastic_tangent(const E& e, const Field& field, double h, double* matrix) const {
  if constexpr (E::has_stiffness_matrix) {
    constexpr int most = G::dof * E::num_ports;
    const int size = elements::num_unknowns(e);
    double elastic[most * most] = {};
    elements::add_elastic_mass(e, field, 4.0 * elastic_inertia(h) / (h * h), elastic);
    int row = 0;
    for (const auto& port : e.ports) {
      if (port.node == elements::ground) continue;
      const auto& node = nodes(mid_)[static_cast<std::size_t>(port.node)];
      for (int j = 0; j < size; ++j) {
        Vector P;
        for (int i = 0; i < G::dof; ++i) P[i] = elastic[(row + i) * size + j];
        P = On::template inverse_tangent_transpose_times<double>(Vector(-node.dq), P) +
            (0.5 * h) * On::template dual_bracket<double>(node.v, P);
        for (int i = 0; i < G::dof; ++i) matrix[(row + i) * size + j] += P[i];
      }
      row += G::dof;
    }
  }
}

/// Increments of the iteration are those of the middle, xi. There the residual's derivative is the tangent of the
/// equations of motion with dv = (2/h) T(D/2)^-1 xi, da = (4/h^2) T(D/2)^-1 xi, a = 0, plus ad(v)^T M / h, but for
/// terms of the order of (h omega)^2 and of h times the rates of relative motion, both in the inertia alone. Rows and
/// forces of constraints are exact:  eta_{n+1} = (1 + Ad(exp(D/2))^-1) xi.
template <class G>
void VariationalOn<G>::evaluate_tangent(const elements::Slopes& slopes, double h) {
  PhaseTimer timer{system_.clock(), system_.counts().assemble};
  const Field field = system_.instant().template field_on<G>(mid_, slopes);
  const plan::Plan& plan = system_.plan();
  constexpr double no_multipliers[elements::max_rows] = {};
  system_.linear().begin_matrices();
  if (system_.remembers()) keep_tangents(slopes, h);
  if (!system_.signals().are_none()) system_.signals().evaluate(mid_, slopes, true, *signal_sums_);
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const int id = system_.linear().tree().element_order[static_cast<std::size_t>(k)];
      if (static_cast<std::size_t>(id) >= plan.directory.size()) continue;  // the equation of a signal
      const int joint = system_.plan().joint_of_element[static_cast<std::size_t>(id)];
      plan::with_element(plan::arrays_on<G>(plan), plan.directory[static_cast<std::size_t>(id)], [&](const auto& e) {
        using E = std::decay_t<decltype(e)>;
        double residual[G::dof * E::num_ports + E::num_multipliers];
        std::array<double, most_unknowns * most_unknowns> matrix;
        elements::evaluate(e, field, no_multipliers, joint < 0 ? 0.0 : base_.turns[static_cast<std::size_t>(joint)],
                           residual, matrix.data());
        elements::add_gyroscopic(e, field, 1.0 / h, matrix.data());
        add_elastic_tangent(e, field, h, matrix.data());
        if constexpr (E::role == elements::Role::joint) set_rows_of(id, matrix.data());
        const std::span<const int> signals = plan::signals_of(plan, static_cast<std::size_t>(id));
        if (signals.empty()) return system_.elements().set_matrix(id, elements::num_unknowns(e), matrix.data());
        // A row is closed at the end of the step, where a state has changed by twice what it has in the middle.
        const int n = elements::num_unknowns(e), rows = elements::num_multipliers(e),
                  all = n + static_cast<int>(signals.size());
        std::array<double, most_unknowns * most_unknowns> extended;
        add_signal_columns(n, all - n, matrix.data(), extended.data(), [&](int s, double* column) {
          const int law = plan.signals[static_cast<std::size_t>(signals[static_cast<std::size_t>(s)])].law;
          elements::evaluate_law_slope(e, field, no_multipliers,
                                       joint < 0 ? 0.0 : base_.turns[static_cast<std::size_t>(joint)], law, column);
          for (int row = n - rows; row < n; ++row) column[row] *= 2.0;
        });
        system_.elements().set_matrix(id, all, extended.data());
      });
    }
  };
  system_.walker().for_each_chunk(static_cast<std::int64_t>(system_.linear().tree().element_order.size()),
                                  element_grain, tree::make_chunk(by_element));
}

/// Sets the gradients of a joint's rows in its matrix: of forces at the start of the step, of rows at its end, both
/// carried to the middle.
template <class G>
void VariationalOn<G>::set_rows_of(int element, double* matrix) const {
  const Place* const p = after_.place_of(element);
  if (p == nullptr) return;
  constexpr int dof = G::dof;
  const int motion = dof * p->num_nodes, size = motion + p->joint->num_rows;
  for (int node = 0; node < p->num_nodes; ++node) {
    const auto half = G::exp(Vector(0.5 * D_[static_cast<std::size_t>(p->nodes[node])]));
    for (int k = 0; k < p->joint->num_rows; ++k) {
      Vector g, f;
      for (int i = 0; i < dof; ++i) g[i] = after_.gradient(*p, k)[dof * node + i];
      g += G::inverse_adjoint_transpose_times(half, g);
      for (int i = 0; i < dof; ++i) f[i] = before_.gradient(*p, k)[dof * node + i];
      f = 0.5 * (f + On::template adjoint_transpose_times<double>(half, f));
      for (int i = 0; i < dof; ++i) {
        matrix[(motion + k) * size + dof * node + i] = g[i];
        matrix[(dof * node + i) * size + motion + k] = f[i];
      }
    }
  }
}

template <class G>
void VariationalOn<G>::keep_tangents(const elements::Slopes& slopes, double h) {
  std::erase_if(remembered_, [this](const Tangents& t) { return !system_.linear().uses(t.matrices); });
  remembered_.push_back({system_.linear().num_matrices(), base_, mid_, D_, end_laws_, slopes, h, end_time_});
}

template <class G>
bool VariationalOn<G>::write_matrices(long matrices) {
  const auto t =
      std::find_if(remembered_.begin(), remembered_.end(), [&](const Tangents& k) { return k.matrices == matrices; });
  if (t == remembered_.end()) return false;
  base_ = t->base;
  mid_ = t->mid;
  D_ = t->D;
  end_laws_ = t->end_laws;
  end_time_ = t->end_time;
  if (system_.set_time(end_time_ - 0.5 * t->h, laws::Side::left)) return false;
  before_.evaluate(system_, system_.instant().template field_on<G>(base_), base_.turns);
  State next = base_;
  if (place_nodes(next, t->h)) return false;
  Field end = system_.instant().template field_on<G>(next);
  end.around.laws = end_laws_.data();
  after_.evaluate(system_, end, base_.turns);
  evaluate_tangent(t->slopes, t->h);
  return true;
}

template <class G>
void VariationalOn<G>::checkpoint(records::Archive& archive) {
  archive(remembered_, unresolved_, mass_step_, mass_state_);
  const double h = mass_step_;
  if (!archive.is_reading() || !(h > 0.0)) return;
  if (factor_mass(mass_state_, h)) throw std::runtime_error("its mass matrix cannot be factored");
  mass_.counts() = WorkCounts{};
}

/// Newton's iteration for D and the multipliers. The factorization is reused as long as the iteration contracts, as in
/// newton_iteration.hpp.
template <class G>
StepReport VariationalOn<G>::iterate(State& next, const StepOptions& options, double h) {
  StepReport report;
  const auto fail = [&report](const Trouble& t) {
    report.cause = t.text;
    return report;
  };
  const elements::Slopes slopes{2.0 / h, 4.0 / (h * h), false, 2.0 / h};
  const double length = system_.plan().length_scale, tolerance = options.tolerance;
  double previous = 0.0, rate = system_.linear().last_contraction();
  bool fresh = !system_.linear().has_factor(slopes);
  for (int k = 0;; ++k) {
    if (const auto t = place_nodes(next, h)) return fail(*t);
    if (k == 0 && !system_.signals().are_none()) system_.signals().follow_motion(mid_);
    if (const auto t = evaluate_step(next, slopes, h, report.residual)) return fail(*t);
    if (k > 0) {
      if (k > 1) rate = previous > 0.0 ? report.change / previous : 0.0;
      const bool still = report.change < tolerance;
      const bool stalled = k > 1 && rate > 0.3;
      if (still && (stalled || report.change * rate <= 1e-6 * tolerance)) {
        report.converged = is_small(system_, report.residual, tolerance);
        if (report.converged && k > 1) system_.linear().set_last_contraction(rate);
        if (!report.converged && (stalled || report.change == 0.0)) {
          const ResidualSize floor = round_off_floor(h), &r = report.residual;
          report.converged = report.at_floor = r.force <= std::max(16.0 * floor.force, tolerance * r.force_scale) &&
                                               r.moment <= std::max(16.0 * floor.moment, tolerance * r.moment_scale) &&
                                               r.length <= std::max(floor.length, tolerance * length) &&
                                               r.angle <= std::max(floor.angle, tolerance) &&
                                               r.signal <= std::max(16.0 * eps, tolerance);
        }
        if (report.converged) return report;
      }
      if (k >= options.max_iterations)
        return fail({"no convergence in " + std::to_string(k) +
                     " iterations: " + describe(system_, report.residual, tolerance)});
      if (k >= 4 && report.change > 1e3 * std::max(previous, 1.0))
        return fail({"the iteration diverges: " + describe(system_, report.residual, tolerance)});
      fresh = k > 1 && rate > slowest_contraction;
    }
    if (fresh) {
      evaluate_tangent(slopes, h);
      if (const auto t = system_.linear().factor(k == 0, slopes)) return fail(*t);
    }
    for (std::size_t n = 0; n < D_.size(); ++n)
      system_.places().set_node_part(rhs_.data(), static_cast<int>(n), Vector(-1.0 * residual_[n]));
    set_rows([&](const Place& place, int row) { return -after_.value(place, row); });
    for (const std::size_t unknown : system_.places().signals())
      rhs_[unknown] = signal_sums_->right_hand_side()[unknown];
    if (const auto t = system_.linear().solve(rhs_.data(), x_.data())) return fail(*t);
    for (std::size_t n = 0; n < D_.size(); ++n)
      D_[n] += 2.0 * On::template inverse_tangent_times<double>(Vector(0.5 * D_[n]), node_part(n));
    previous = report.change;
    report.change = 2.0 * system_.corrections().apply(mid_, x_.data());
    if (report.iterations < StepReport::remembered_changes)
      report.change_list[static_cast<std::size_t>(report.iterations)] = report.change;
    ++report.iterations;
    if (!std::isfinite(report.change)) return fail({"the iteration left finite numbers"});
  }
}

template <class G>
StepReport VariationalOn<G>::advance(State& state, const StepOptions& options, double end_time) {
  base_ = state;
  StepReport report = try_step(state, options, end_time);
  if (!report.converged) state = base_;
  return report;
}

template <class G>
StepReport VariationalOn<G>::try_step(State& state, const StepOptions& options, double end_time) {
  const double h = state.step_size;
  StepReport report;
  const auto failed = [&report](const std::optional<Trouble>& t) {
    if (t) {
      report.converged = false;
      report.cause = t->text;
    }
    return t.has_value();
  };
  if (state.last_step > 0.0 && state.last_step != h)
    if (failed(set_momenta(base_, h))) return report;
  if (failed(system_.set_time(end_time, laws::Side::left))) return report;
  end_laws_ = system_.instant().law_values();
  if (failed(system_.set_time(end_time - 0.5 * h, laws::Side::left))) return report;
  before_.evaluate(system_, system_.instant().template field_on<G>(base_), base_.turns);
  mid_.multipliers = state.multipliers;
  end_time_ = end_time;
  predict(h);
  predict_signals(h);
  report = iterate(state, options, h);
  if (!report.converged) return report;
  observe_signals(state, h);
  Vectors& momentum = state.change<G>().momentum;
  // The remaining residual r is carried over to the momenta, so that the momentum balance is kept to round-off,
  // whatever the tolerance.
  for (std::size_t n = 0; n < D_.size(); ++n) {
    const Vector open = On::template inverse_tangent_transpose_times<double>(
        Vector(-D_[n]), On::template tangent_transpose_times<double>(Vector(-0.5 * D_[n]), residual_[n]));
    momentum[n] = elements::eval_momentum_after<G, double>(D_[n], h, sums_.momentum(n), sums_.force(n)) -
                  (0.5 * h) * On::template adjoint_transpose_times<double>(G::exp(D_[n]), open);
  }
  state.time = end_time;
  state.last_step = h;
  if (failed(system_.set_time(end_time, laws::Side::left))) return report;
  if (failed(solve_velocities(state, h))) return report;
  system_.signals().follow_motion(state);
  if (failed(solve_accelerations(state, h))) return report;
  add_counts();
  compare_rates(state, h);
  failed(check_shape(system_, state));
  return report;
}

#define BOUGH_INSTANTIATE(G) template class VariationalOn<G>;
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE)
#undef BOUGH_INSTANTIATE

std::unique_ptr<Integrator> make_variational(System& system, const scene::Solver& solver, double newmark_beta) {
  return system.plan().with_group([&]<class G>() -> std::unique_ptr<Integrator> {
    return std::make_unique<VariationalOn<G>>(system, solver, newmark_beta);
  });
}

}  // namespace bough::step
