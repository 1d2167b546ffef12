#include "bdf.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "bough/motion/vectors_on.hpp"
#include "moving_nodes.hpp"
#include "newton_iteration.hpp"
#include "start_parts.hpp"

namespace bough::step {

namespace {

/// Rotation of a node in one step [rad]: two steps stay below pi, where the logarithm ceases to be unique.
constexpr double largest_turn_of_two = 1.4;

/// Increment of a node from state a to state b, log(H_a^-1 H_b).
template <class G>
typename G::template Vector<double> increment(const NodesOn<G>& a, const NodesOn<G>& b, std::size_t node) {
  const auto &from = a.motion[node], &to = b.motion[node];
  using Pose = typename G::template Pose<double>;
  const auto none = G::template Translation<double>::zero();
  return G::log(G::relative(Pose{from.R, none}, Pose{to.R, motion::difference(to.x, from.x)}));
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
  begin_.visit([&]<class G>(const NodesOn<G>& nodes) { history_.emplace<HistoryOn<G>>().resize(nodes.motion.size()); });
  steady_error_.assign(system.places().size(), 0.0);
}

template <class G>
void Bdf::HistoryOn<G>::resize(std::size_t num_nodes) {
  for (Vectors* v : {&samples[0], &samples[1], &samples[2], &last, &earlier, &v_now, &v_last, &v_earlier, &y, &rates})
    v->assign(num_nodes, G::template Vector<double>::zero());
}

StartReport Bdf::start(State& /*state*/, const StepOptions& /*options*/, double step_size) {
  h_ = step_size;
  done_ = 0;
  StartReport report;
  report.ok = true;
  return report;
}

StartReport Bdf::change_step_size(State& state, const StepOptions& options, double step_size) {
  if (step_size != h_) return start(state, options, step_size);
  StartReport report;
  report.ok = true;
  return report;
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
    const int sample = done_ * parts + i - 2;  // samples are taken at 0, 3 and 6
    if (sample % 3 == 0 && sample >= 0)
      next.visit([&]<class G>(const NodesOn<G>& nodes) {
        for (std::size_t n = 0; n < nodes.motion.size(); ++n) history<G>().samples[sample / 3][n] = nodes.motion[n].a;
      });
  }
  // The reported state has velocities that satisfy the constraints, and accelerations and multipliers that satisfy the
  // equations of motion.
  state = next;
  if (system_.plan().num_multipliers > 0) {
    if (const auto t = set_normal_velocities(system_, state, nullptr, part)) return failed(total, t->text);
    if (const auto t = solve_accelerations(system_, state, part)) return failed(total, t->text);
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

void Bdf::eval_steady_error(const State& point) {
  const double apart = 3.0 * h_ / parts;
  std::fill(steady_error_.begin(), steady_error_.end(), 0.0);
  point.visit([&]<class G>(const NodesOn<G>& nodes) {
    using Vector = typename NodesOn<G>::Vector;
    using On = motion::VectorsOn<G>;
    const auto& samples = history<G>().samples;
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) {
      const Vector &a = samples[0][n], &b = samples[1][n], &c = samples[2][n], &v = nodes.motion[n].v;
      const Vector jerk = (0.5 / apart) * (c - a);
      Vector error;
      if (order_ == 2) {
        error = (-h_ * h_ / 3.0) * (jerk + 0.5 * On::template bracket<double>(v, b));
      } else {
        const Vector snap = (1.0 / (apart * apart)) * (c - b - (b - a));
        error = (-0.25 * h_ * h_ * h_) * (snap + On::template bracket<double>(v, jerk));
      }
      system_.places().set_node_part(steady_error_.data(), static_cast<int>(n), error);
    }
  });
}

/// Fills the history with the increments and velocities of the starting steps. Velocities include the steady error of
/// the scheme.
std::optional<Trouble> Bdf::finish_start(const State& state) {
  State last = state;
  State* const points[] = {&first_, &second_, &last};
  if (system_.plan().num_multipliers > 0)
    for (State* point : points) {
      eval_steady_error(*point);
      if (auto t = system_.set_time(point->time, point == &first_ ? laws::Side::right : laws::Side::left)) return t;
      if (auto t = set_normal_velocities(system_, *point, &steady_error_, h_)) return t;
    }
  signals_earlier_ = first_.signals.value;
  signals_last_ = second_.signals.value;
  last.visit([&]<class G>(const NodesOn<G>& now) {
    HistoryOn<G>& past = history<G>();
    const NodesOn<G>&begin = first_.on<G>(), &middle = second_.on<G>();
    for (std::size_t n = 0; n < now.motion.size(); ++n) {
      past.v_earlier[n] = begin.motion[n].v;
      past.v_last[n] = middle.motion[n].v;
      past.v_now[n] = now.motion[n].v;
      past.last[n] = increment(middle, now, n);
      past.earlier[n] = increment(begin, middle, n);
    }
  });
  return std::nullopt;
}

/// Predictor: extrapolates the parabola through y_n = 0 and y_{n-1} (order 2), or the cubic that also passes through
/// y_{n-2} (order 3), with the slope v_n at y_n.
void Bdf::predict(State& state) {
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    using Vector = typename NodesOn<G>::Vector;
    HistoryOn<G>& past = history<G>();
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) {
      const Vector y1 = -1.0 * past.last[n];
      past.rates[n] = c_.c1 * past.v_now[n] + c_.c2 * past.v_last[n];
      if (order_ == 2) {
        past.y[n] = c_.c2 * y1;
        move_node(nodes, n, Vector((2.0 * h_) * past.v_now[n] + y1));
        continue;
      }
      const Vector y2 = G::log(G::compose(G::exp(y1), G::exp(Vector(-1.0 * past.earlier[n]))));
      past.y[n] = c_.c2 * y1 + c_.c3 * y2;
      past.rates[n] = past.rates[n] + c_.c3 * past.v_earlier[n];
      move_node(nodes, n, Vector((3.0 * h_) * past.v_now[n] + 3.0 * y1 - 0.5 * y2));
    }
  });
}

/// Extrapolates through the last two values (order 2) or three.
void Bdf::predict_signals(State& state) {
  std::vector<double>& value = state.signals.value;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double change = value[i] - signals_last_[i], before = signals_last_[i] - signals_earlier_[i];
    value[i] += order_ == 2 ? change : 2.0 * change - before;
  }
}

/// s'_{n+1} = (c0 s_{n+1} + c1 s_n + c2 s_{n-1} + c3 s_{n-2}) / h of states
void Bdf::follow_states(SignalValues& signals) const {
  const std::vector<double>& now = begin_.signals.value;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (system_.plan().signals[i].is_state())
      signals.rate[i] =
          (c_.c0 * signals.value[i] + c_.c1 * now[i] + c_.c2 * signals_last_[i] + c_.c3 * signals_earlier_[i]) / h_;
}

/// Sets the velocity and the acceleration of a node by the formulas of the scheme, and dq = D / c0, the increment for
/// which the tangents of elements are exact to first order.
template <class G>
void Bdf::follow_node(NodesOn<G>& nodes, std::size_t n) const {
  using Vector = typename NodesOn<G>::Vector;
  using On = motion::VectorsOn<G>;
  const HistoryOn<G>& past = history<G>();
  auto& node = nodes.motion[n];
  const Vector D = increment(begin_.on<G>(), nodes, n);
  node.v = On::template tangent_times<double>(D, Vector((1.0 / h_) * (c_.c0 * D + past.y[n])));
  node.a = (1.0 / h_) * (c_.c0 * node.v + past.rates[n]);
  node.dq = (1.0 / c_.c0) * D;
  node.drift = {};
}

/// The first node that has turned too far, if there is one.
std::optional<Trouble> Bdf::judge_turn(const State& state) const {
  return state.visit([&]<class G>(const NodesOn<G>& nodes) -> std::optional<Trouble> {
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) {
      const typename NodesOn<G>::Vector D = c_.c0 * nodes.motion[n].dq;
      if (!(motion::VectorsOn<G>::template angular_square<double>(D) <= largest_turn_of_two * largest_turn_of_two))
        return Trouble{"'" + system_.plan().nodes[n].name + "' turns by nearly a quarter of a turn in one step"};
    }
    return std::nullopt;
  });
}

/// All nodes and states.
std::optional<Trouble> Bdf::follow(State& state) const {
  follow_states(state.signals);
  state.change_all([&](auto& nodes) {
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) follow_node(nodes, n);
  });
  return judge_turn(state);
}

void Bdf::apply_in_visit(int visit, State& state, const double* x) const {
  begin_.visit([&]<class G>(const NodesOn<G>&) {
    NodesOn<G>& nodes = state.changing<G>();
    system_.corrections().apply_in_visit<G>(
        visit, state, x, [&](std::int64_t begin, std::int64_t end, NodeChange<G>* changes) {
          const auto eights = std::span(system_.node_order()->eights())
                                  .subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
          move_nodes(nodes, eights, system_.places().increments(x), changes);
          for (const NodeEight& eight : eights)
            for (int l = 0; l < eight.count; ++l)
              follow_node(nodes, static_cast<std::size_t>(eight.node[static_cast<std::size_t>(l)]));
        });
  });
}

std::optional<Trouble> Bdf::complete(State& state, const double* x) const {
  system_.corrections().add_signals(state, x, 1.0);
  follow_states(state.signals);
  return judge_turn(state);
}

StepReport Bdf::take_step(State& state, const StepOptions& options, double end_time) {
  StepReport report;
  if (const auto t = system_.set_time(end_time, laws::Side::left)) return failed(report, t->text);
  state.time = end_time;
  predict(state);
  predict_signals(state);
  if (const auto t = follow(state)) return failed(report, t->text);
  const elements::Slopes slopes{c_.c0 / h_, (c_.c0 / h_) * (c_.c0 / h_), false, c_.c0 / h_};
  report = iterate(system_, state, options, {}, slopes, *this);
  if (!report.converged) return report;
  if (const auto t = check_shape(system_, state)) return failed(report, t->text);
  system_.signals().observe(state, c_.c0 / h_);
  std::swap(signals_earlier_, signals_last_);
  signals_last_ = begin_.signals.value;
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    HistoryOn<G>& past = history<G>();
    std::swap(past.earlier, past.last);
    std::swap(past.v_earlier, past.v_last);
    std::swap(past.v_last, past.v_now);
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) {
      nodes.motion[n].dq = c_.c0 * nodes.motion[n].dq;
      past.last[n] = nodes.motion[n].dq;
      past.v_now[n] = nodes.motion[n].v;
    }
  });
  system_.recover_multipliers(state);
  return report;
}

}  // namespace bough::step
