#include "bough/step/bdf.hpp"

#include <cmath>
#include <utility>

#include "newton.hpp"
#include "start_parts.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

constexpr double largest_turn =
    1.4;  ///< of a node in one step [rad]: two of them stay below pi, where the logarithm is no longer unique

/// log(H_a^-1 H_b) of a node.
Vec6<double> increment(const State& a, const State& b, std::size_t node) {
  const elements::NodeMotion &from = a.nodes[node], &to = b.nodes[node];
  return motion::Se3::log(
      motion::relative(motion::PreciseFrame<double>{from.R, from.x}, motion::PreciseFrame<double>{to.R, to.x}));
}

StepReport failed(StepReport report, const std::string& cause) {
  report.converged = false;
  report.cause = cause;
  return report;
}

}  // namespace

Bdf::Bdf(System& system, int order)
    : system_(system), order_(order), c_(order == 2 ? second : third), begin_(make_initial_state(system.plan())) {
  alpha_ = first_ = second_ = begin_;
  increments_.assign(begin_.nodes.size(), Vec6<double>::zero());
  last_ = earlier_ = v_now_ = v_last_ = v_earlier_ = y_ = rates_ = increments_;
  for (Vectors& s : samples_) s = increments_;
}

void Bdf::restart(double h) {
  h_ = h;
  done_ = 0;
}

StepReport Bdf::advance(State& state, const StepOptions& options, double end_time) {
  begin_ = state;
  StepReport report =
      done_ < start_steps ? take_start_step(state, options, end_time) : take_step(state, options, end_time);
  if (!report.converged) state = begin_;
  return report;
}

StepReport Bdf::take_start_step(State& state, const StepOptions& options, double end_time) {
  const double part = h_ / parts;
  StepReport total;
  if (done_ == 0) {
    first_ = alpha_ = state;
    if (const auto t = system_.set_time(state.time, laws::Side::right)) return failed(total, t->text);
    const StartReport started = start_alpha(system_, alpha_, options, part);
    if (!started.ok) return failed(total, started.cause);
  }
  State next = alpha_;
  next.turns = state.turns;
  for (int i = 1; i <= parts; ++i) {
    const StepReport report =
        step::advance(system_, next, options, i == parts ? end_time : begin_.time + static_cast<double>(i) * part);
    const int iterations = total.iterations + report.iterations;
    total = report;
    total.iterations = iterations;
    if (!report.converged) return total;
    const int sample = done_ * parts + i - 2;  // 0, 3, 6 are wanted
    if (sample % 3 == 0 && sample >= 0)
      for (std::size_t n = 0; n < next.nodes.size(); ++n)
        samples_[static_cast<std::size_t>(sample / 3)][n] = next.nodes[n].a;
  }
  // What is reported: velocities of the constraints, accelerations and multipliers of the equations of motion there.
  state = next;
  if (system_.plan().num_multipliers > 0) {
    if (const auto t = set_normal_velocities(system_, state, nullptr)) return failed(total, t->text);
    if (const auto t = solve_accelerations(system_, state)) return failed(total, t->text);
  }
  alpha_ = std::move(next);
  if (++done_ == 1) {
    second_ = state;
    return total;
  }
  if (const auto t = finish_start(state)) {
    done_ = 0;
    return failed(total, t->text);
  }
  return total;
}

void Bdf::eval_steady_error(const State& point, Vectors& error) const {
  const double apart = 3.0 * h_ / parts;
  for (std::size_t n = 0; n < error.size(); ++n) {
    const Vec6<double>&a = samples_[0][n], &b = samples_[1][n], &c = samples_[2][n], &v = point.nodes[n].v;
    const Vec6<double> jerk = (0.5 / apart) * (c - a);
    if (order_ == 2) {
      error[n] = (-h_ * h_ / 3.0) * (jerk + 0.5 * motion::cross6_times(v, b));
    } else {
      const Vec6<double> snap = (1.0 / (apart * apart)) * (c - b - (b - a));
      error[n] = (-0.25 * h_ * h_ * h_) * (snap + motion::cross6_times(v, jerk));
    }
  }
}

/// Increments and velocities of the starting steps, these with the steady error of the scheme.
std::optional<Trouble> Bdf::finish_start(const State& state) {
  State last = state;
  Vectors& d = increments_;
  const std::pair<State*, Vectors*> points[] = {{&first_, &v_earlier_}, {&second_, &v_last_}, {&last, &v_now_}};
  for (const auto& [point, v] : points) {
    if (system_.plan().num_multipliers > 0) {
      eval_steady_error(*point, d);
      if (auto t = system_.set_time(point->time, point == &first_ ? laws::Side::right : laws::Side::left)) return t;
      if (auto t = set_normal_velocities(system_, *point, &d)) return t;
    }
    for (std::size_t n = 0; n < d.size(); ++n) (*v)[n] = point->nodes[n].v;
  }
  for (std::size_t n = 0; n < d.size(); ++n) {
    last_[n] = increment(second_, last, n);
    earlier_[n] = increment(first_, second_, n);
  }
  return std::nullopt;
}

/// The parabola through y_n = 0 and y_{n-1}, or the cubic that also meets y_{n-2}, with the slope v_n.
void Bdf::predict(State& state) {
  for (std::size_t n = 0; n < last_.size(); ++n) {
    const Vec6<double> y1 = -1.0 * last_[n];
    rates_[n] = c_.c1 * v_now_[n] + c_.c2 * v_last_[n];
    if (order_ == 2) {
      y_[n] = c_.c2 * y1;
      move_node(state, n, (2.0 * h_) * v_now_[n] + y1);
      continue;
    }
    const Vec6<double> y2 =
        motion::Se3::log(motion::compose(motion::Se3::exp(y1), motion::Se3::exp(-1.0 * earlier_[n])));
    y_[n] = c_.c2 * y1 + c_.c3 * y2;
    rates_[n] = rates_[n] + c_.c3 * v_earlier_[n];
    move_node(state, n, (3.0 * h_) * v_now_[n] + 3.0 * y1 - 0.5 * y2);
  }
}

/// Velocities and accelerations by the formulas; dq as the tangents of the elements take it.
std::optional<Trouble> Bdf::follow(State& state) const {
  for (std::size_t n = 0; n < state.nodes.size(); ++n) {
    elements::NodeMotion& node = state.nodes[n];
    const Vec6<double> D = increment(begin_, state, n);
    const motion::Vec3<double> turn = lanes::angular_part(D);
    if (!(lanes::dot(turn, turn) <= largest_turn * largest_turn))
      return Trouble{"'" + system_.plan().nodes[n].name + "' turns by nearly a quarter of a turn in one step"};
    node.v = motion::tangent_times(D, (1.0 / h_) * (c_.c0 * D + y_[n]));
    node.a = (1.0 / h_) * (c_.c0 * node.v + rates_[n]);
    node.dq = (1.0 / c_.c0) * D;
  }
  return std::nullopt;
}

StepReport Bdf::take_step(State& state, const StepOptions& options, double end_time) {
  StepReport report;
  if (const auto t = system_.set_time(end_time, laws::Side::left)) return failed(report, t->text);
  state.time = end_time;
  predict(state);
  if (const auto t = follow(state)) return failed(report, t->text);
  const elements::Slopes slopes{c_.c0 / h_, (c_.c0 / h_) * (c_.c0 / h_), false};
  report = iterate(system_, state, options, {}, slopes, [&](State& s) { return follow(s); });
  if (!report.converged) return report;
  if (const auto t = check_shape(system_, state)) return failed(report, t->text);
  for (std::size_t n = 0; n < state.nodes.size(); ++n) state.nodes[n].dq = c_.c0 * state.nodes[n].dq;
  std::swap(earlier_, last_);
  std::swap(v_earlier_, v_last_);
  std::swap(v_last_, v_now_);
  for (std::size_t n = 0; n < state.nodes.size(); ++n) {
    last_[n] = state.nodes[n].dq;
    v_now_[n] = state.nodes[n].v;
  }
  system_.recover_multipliers(state);
  return report;
}

}  // namespace bough::step
