#include "bough/step/variational.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bough/elements/momentum.hpp"
#include "newton.hpp"
#include "system_parts.hpp"

namespace bough::step {

using motion::Se3;
using motion::Vec6;

namespace {

constexpr double largest_turn = 2.8;  ///< rotation of a node in one step [rad], below pi: the logarithm is unique

/// Node n of `to` at H exp(d) of `from`.
void place(const SpatialNodes& from, std::size_t n, const Vec6<double>& d, SpatialNodes& to) {
  const motion::Frame<double> step = motion::Se3::exp(d);
  elements::NodeMotion& node = to.motion[n];
  node.x = from.motion[n].x;
  node.x.add(from.motion[n].R * step.x);
  to.rotation[n] =
      motion::normalise(motion::multiply(from.rotation[n], motion::exp_quaternion(lanes::angular_part(d))));
  node.R = motion::rotation_of(to.rotation[n]);
  node.dq = d;
}

void add_sizes(const Vec6<double>& v, Vec6<double>& to) {
  for (int i = 0; i < 6; ++i) to[i] += std::abs(v[i]);
}

}  // namespace

Variational::Variational(System& system, const scene::Solver& solver, double newmark_beta)
    : system_(system),
      newmark_beta_(newmark_beta),
      mass_(system.plan(), solver, system.walker()),
      sums_(system.plan()),
      before_(system.plan()),
      after_(system.plan()),
      base_(make_initial_state(system.plan())),
      mid_(base_) {
  D_.assign(system.plan().nodes.size(), Vec6<double>::zero());
  residual_ = increments_ = goal_ = left_ = D_;
  end_laws_.assign(system.plan().laws.size(), 0.0);
  impulses_.assign(static_cast<std::size_t>(system.plan().num_multipliers), 0.0);
  row_goals_ = impulses_;
  series_.resize(impulses_.size());
  rhs_.assign(system.num_unknowns(), 0.0);
  x_ = rhs_;
}

std::optional<Trouble> Variational::start(State& state) {
  state.momentum.resize(D_.size());
  state.last_step = 0.0;
  mass_step_ = 0.0;
  return set_momenta(state, state.step_size);
}

/// tau = (beta - 1/4) h^2 with the beta of Newmark's rule.
double Variational::elastic_inertia(double h) const { return (newmark_beta_ - 0.25) * h * h; }

/// Momenta that belong to velocities in steps of h.
std::optional<Trouble> Variational::set_momenta(State& state, double h) {
  const elements::Field field = system_.field(state);
  if (auto t = sums_.evaluate(system_, field, state.turns, elastic_inertia(h), MomentumSums::Want::momenta)) return t;
  for (std::size_t n = 0; n < D_.size(); ++n) state.momentum[n] = sums_.momentum(n);
  return std::nullopt;
}

/// D = h v_n + (h^2/2) a_n, with a_n of the last step's own motion, 2 (v_n - D_n / h_n) / h_n, once there is one: the accelerations of the
/// equations of motion may hold vibrations faster than the step, which mean nothing for the next.
void Variational::predict(double h) {
  const double last = base_.last_step;
  for (std::size_t n = 0; n < D_.size(); ++n) {
    const elements::NodeMotion& node = base_.on<Se3>().motion[n];
    const Vec6<double> a = last > 0.0 ? (2.0 / last) * (node.v - (1.0 / last) * node.dq) : node.a;
    D_[n] = h * node.v + (0.5 * h * h) * a;
  }
}

/// The nodes of `next` and of the middle by D.
std::optional<Trouble> Variational::place_nodes(State& next, double h) {
  const SpatialNodes& base = base_.on<Se3>();
  SpatialNodes &mid = mid_.change<Se3>(), &end = next.change<Se3>();
  for (std::size_t n = 0; n < D_.size(); ++n) {
    const motion::Vec3<double> turn = lanes::angular_part(D_[n]);
    if (!(lanes::dot(turn, turn) <= largest_turn * largest_turn))
      return Trouble{"'" + system_.plan().nodes[n].name + "' turns by nearly half a turn in one step"};
    place(base, n, 0.5 * D_[n], mid);
    place(base, n, D_[n], end);
    mid.motion[n].v = (1.0 / h) * D_[n];
    mid.motion[n].a = Vec6<double>::zero();
  }
  return std::nullopt;
}

/// residual_ = (2/h) B (-D_1 L_d - p_n + (h/2) G_n^T lambda) by node, and the rows at the end of the step. B = T(-D/2)^-T T(-D)^T =
/// (1 + Ad(exp(D/2))^T)/2 carries wrenches from the start to the middle such that forces of the middle are in it as they are: stiff ones
/// then meet their own tangent in the iteration.
std::optional<Trouble> Variational::evaluate_step(const State& next, double h, ResidualSize& size) {
  PhaseTimer timer{system_.clock(), system_.counts().assemble};
  ++system_.counts().evaluations;
  const elements::Field middle = system_.field(mid_);
  if (auto t = sums_.evaluate(system_, middle, base_.turns, elastic_inertia(h), MomentumSums::Want::forces)) return t;
  elements::Field end = system_.field(next);
  end.around.laws = end_laws_.data();
  after_.evaluate(system_, end, base_.turns);
  for (Vec6<double>& f : residual_) f = Vec6<double>::zero();
  before_.add_forces(mid_.multipliers.data(), 1.0, residual_);
  size = ResidualSize{};
  for (std::size_t n = 0; n < D_.size(); ++n) {
    const Vec6<double> P = sums_.momentum(n), p = base_.momentum[n], half = 0.5 * D_[n];
    Vec6<double> terms = sums_.force_size(n);
    add_sizes(residual_[n], terms);
    add_sizes((2.0 / h) * (P - p), terms);
    add_sizes(motion::cross6_transpose_times(mid_.on<Se3>().motion[n].v, P), terms);
    residual_[n] -= (2.0 / h) * p;
    residual_[n] = 0.5 * (residual_[n] + motion::adjoint_transpose_times(motion::Se3::exp(half), residual_[n])) +
                   (2.0 / h) * motion::inverse_tangent_transpose_times(-half, P) + sums_.force(n);
    const Vec6<double> left = residual_[n];
    if (is_held(n)) {  // balanced by the joints that hold it
      add_sizes(left, terms);
      residual_[n] = Vec6<double>::zero();
    }
    for (int i = 0; i < 6; ++i) {
      double& largest = i < 3 ? size.force : size.moment;
      double& scale = i < 3 ? size.force_scale : size.moment_scale;
      if (!std::isfinite(left[i]))
        return Trouble{"the forces at '" + system_.plan().nodes[n].name + "' are not finite at time " +
                       std::to_string(base_.time)};
      const double r = std::abs(residual_[n][i]);
      if (r > largest) {
        largest = r;
        (i < 3 ? size.worst_force_node : size.worst_moment_node) = static_cast<int>(n);
      }
      scale = std::max(scale, terms[i]);
    }
  }
  for (const ConstraintRows::Place& p : after_.places())
    for (int k = 0; k < p.joint->num_rows; ++k) {
      const elements::RowKind kind = p.joint->rows[k].kind;
      const bool is_length = kind == elements::RowKind::along || kind == elements::RowKind::screw;
      const double gap = std::abs(after_.value(static_cast<std::size_t>(p.multiplier_begin + k)));
      if (!std::isfinite(gap)) return Trouble{"the constraints of a joint are not finite"};
      if (gap > std::max(size.length, size.angle)) size.worst_joint = system_.joint_of_element(p.element);
      (is_length ? size.length : size.angle) = std::max(is_length ? size.length : size.angle, gap);
    }
  return std::nullopt;
}

/// What round-off leaves in the residual: of the momenta, and of the element matrices now present.
ResidualSize Variational::round_off_floor(double h) const {
  ResidualSize floor = system_.round_off_floor();
  constexpr double eps = std::numeric_limits<double>::epsilon();
  for (std::size_t n = 0; n < D_.size(); ++n)
    for (int i = 0; i < 6; ++i) {
      double& f = i < 3 ? floor.force : floor.moment;
      f = std::max(f, (2.0 * eps / h) * std::abs(base_.momentum[n][i]));
    }
  return floor;
}

/// (2/h) T(-D/2)^-T P + F of the elastic inertia, F = ad(v)^T P at each node but for rates of strain: stiffness between the axes of the
/// nodes, which h omega times it would spoil if it were left out.
template <class E>
void Variational::add_elastic_tangent(const E& e, const elements::Field& field, double h, double* matrix) const {
  if constexpr (E::has_stiffness_matrix) {
    constexpr int most = 6 * E::num_ports;
    const int size = elements::num_unknowns(e);
    double elastic[most * most] = {};
    elements::add_elastic_mass(e, field, 4.0 * elastic_inertia(h) / (h * h), elastic);
    int row = 0;
    for (const elements::Port& port : e.ports) {
      if (port.node == elements::ground) continue;
      const elements::NodeMotion& node = mid_.on<Se3>().motion[static_cast<std::size_t>(port.node)];
      for (int j = 0; j < size; ++j) {
        Vec6<double> P;
        for (int i = 0; i < 6; ++i) P[i] = elastic[(row + i) * size + j];
        P = motion::inverse_tangent_transpose_times(-node.dq, P) +
            (0.5 * h) * motion::cross6_transpose_times(node.v, P);
        for (int i = 0; i < 6; ++i) matrix[(row + i) * size + j] += P[i];
      }
      row += 6;
    }
  }
}

/// Increments of the iteration are those of the middle, xi. There the residual's derivative is the tangent of the equations of motion with
/// dv = (2/h) T(D/2)^-1 xi, da = (4/h^2) T(D/2)^-1 xi, a = 0, plus ad(v)^T M / h, but for terms of the order of (h omega)^2 and of h times
/// the rates of relative motion, both in the inertia alone. Rows and forces of constraints are exact:  eta_{n+1} = (1 + Ad(exp(D/2))^-1) xi.
void Variational::evaluate_tangent(const elements::Slopes& slopes, double h) {
  PhaseTimer timer{system_.clock(), system_.counts().assemble};
  const elements::Field field = system_.field(mid_, slopes);
  const plan::Plan& plan = system_.plan();
  constexpr double no_multipliers[elements::max_rows] = {};
  system_.begin_matrices();
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const int id = system_.tree().element_order[static_cast<std::size_t>(k)];
      const int joint = system_.joint_of_element(id);
      plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(id)], [&](const auto& e) {
        using E = std::decay_t<decltype(e)>;
        double residual[6 * E::num_ports + E::num_multipliers];
        std::array<double, most_unknowns * most_unknowns> matrix;
        elements::evaluate(e, field, no_multipliers, joint < 0 ? 0.0 : base_.turns[static_cast<std::size_t>(joint)],
                           residual, matrix.data());
        elements::add_gyroscopic(e, field, 1.0 / h, matrix.data());
        add_elastic_tangent(e, field, h, matrix.data());
        if constexpr (E::role == elements::Role::joint) set_rows_of(id, matrix.data());
        system_.set_matrix(id, elements::num_unknowns(e), matrix.data());
      });
    }
  };
  system_.walker().for_each_chunk(static_cast<std::int64_t>(plan.directory.size()), element_grain,
                                  tree::make_chunk(by_element));
}

/// Gradients of a joint's rows in its matrix: of forces at the start of the step, of rows at its end, carried to the middle.
void Variational::set_rows_of(int element, double* matrix) const {
  const ConstraintRows::Place* const p = after_.place_of(element);
  if (p == nullptr) return;
  const int motion = 6 * p->num_nodes, size = motion + p->joint->num_rows;
  for (int node = 0; node < p->num_nodes; ++node) {
    const auto half = motion::Se3::exp(0.5 * D_[static_cast<std::size_t>(p->nodes[node])]);
    for (int k = 0; k < p->joint->num_rows; ++k) {
      Vec6<double> g, f;
      for (int i = 0; i < 6; ++i) g[i] = after_.gradient(*p, k)[6 * node + i];
      g += motion::inverse_adjoint_transpose_times(half, g);
      for (int i = 0; i < 6; ++i) f[i] = before_.gradient(*p, k)[6 * node + i];
      f = 0.5 * (f + motion::adjoint_transpose_times(half, f));
      for (int i = 0; i < 6; ++i) {
        matrix[(motion + k) * size + 6 * node + i] = g[i];
        matrix[(6 * node + i) * size + motion + k] = f[i];
      }
    }
  }
}

/// Newton's iteration for D and the multipliers; a factor serves again while it contracts, as in newton_impl.hpp.
StepReport Variational::iterate(State& next, const StepOptions& options, double h) {
  StepReport report;
  const auto fail = [&report](const Trouble& t) {
    report.cause = t.text;
    return report;
  };
  const elements::Slopes slopes{2.0 / h, 4.0 / (h * h), false};
  const double length = system_.plan().length_scale, tolerance = options.tolerance;
  double previous = 0.0, rate = system_.last_contraction();
  bool fresh = !system_.has_factor(slopes);
  for (int k = 0;; ++k) {
    if (const auto t = place_nodes(next, h)) return fail(*t);
    if (const auto t = evaluate_step(next, h, report.residual)) return fail(*t);
    if (k > 0) {
      if (k > 1) rate = previous > 0.0 ? report.change / previous : 0.0;
      const bool still = report.change < tolerance;
      const bool stalled = k > 1 && rate > 0.3;
      if (still && (stalled || report.change * rate <= 1e-6 * tolerance)) {
        report.converged = is_small(system_, report.residual, tolerance);
        if (report.converged && k > 1) system_.set_last_contraction(rate);
        if (!report.converged && (stalled || report.change == 0.0)) {
          const ResidualSize floor = round_off_floor(h), &r = report.residual;
          report.converged = report.at_floor = r.force <= std::max(16.0 * floor.force, tolerance * r.force_scale) &&
                                               r.moment <= std::max(16.0 * floor.moment, tolerance * r.moment_scale) &&
                                               r.length <= std::max(floor.length, tolerance * length) &&
                                               r.angle <= std::max(floor.angle, tolerance);
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
      if (const auto t = system_.factor(k == 0, slopes)) return fail(*t);
    }
    for (std::size_t n = 0; n < D_.size(); ++n)
      system_.set_node_part(rhs_.data(), static_cast<int>(n), -1.0 * residual_[n]);
    set_rows([&](std::size_t m) { return -after_.value(m); });
    if (const auto t = system_.solve(rhs_.data(), x_.data())) return fail(*t);
    for (std::size_t n = 0; n < D_.size(); ++n) D_[n] += 2.0 * motion::inverse_tangent_times(0.5 * D_[n], node_part(n));
    previous = report.change;
    report.change = 2.0 * system_.apply(mid_, x_.data());
    if (report.iterations < StepReport::remembered_changes)
      report.change_list[static_cast<std::size_t>(report.iterations)] = report.change;
    ++report.iterations;
    if (!std::isfinite(report.change)) return fail({"the iteration left finite numbers"});
  }
}

StepReport Variational::advance(State& state, const StepOptions& options, double end_time) {
  base_ = state;
  StepReport report = try_step(state, options, end_time);
  if (!report.converged) state = base_;
  return report;
}

StepReport Variational::try_step(State& state, const StepOptions& options, double end_time) {
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
  end_laws_ = system_.law_values();
  if (failed(system_.set_time(end_time - 0.5 * h, laws::Side::left))) return report;
  before_.evaluate(system_, system_.field(base_), base_.turns);
  mid_.multipliers = state.multipliers;
  predict(h);
  report = iterate(state, options, h);
  if (!report.converged) return report;
  // What the iteration left open, r, is carried along as it is: momenta add up to round-off, whatever the tolerance.
  for (std::size_t n = 0; n < D_.size(); ++n) {
    const Vec6<double> open =
        motion::inverse_tangent_transpose_times(-D_[n], motion::tangent_transpose_times(-0.5 * D_[n], residual_[n]));
    state.momentum[n] = elements::eval_momentum_after(D_[n], h, sums_.momentum(n), sums_.force(n)) -
                        (0.5 * h) * motion::adjoint_transpose_times(motion::Se3::exp(D_[n]), open);
  }
  state.time = end_time;
  state.last_step = h;
  if (failed(system_.set_time(end_time, laws::Side::left))) return report;
  if (failed(solve_velocities(state, h)) || failed(solve_accelerations(state, h))) return report;
  add_counts();
  compare_rates(state, h);
  failed(check_shape(system_, state));
  return report;
}

}  // namespace bough::step
