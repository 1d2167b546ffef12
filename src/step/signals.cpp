#include "bough/step/signals.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "bough/blocks/at.hpp"
#include "bough/elements/reading.hpp"

namespace bough::step {

namespace {

constexpr std::size_t most_of_ports = 12;  ///< unknowns of both ports of a reading

/// x = A^-1 x by elimination with row interchanges, A by rows, which is overwritten; false: A is singular. Nothing is
/// allocated, and there are as few unknowns as a scene has states.
bool solve_in_place(std::span<double> a, std::span<double> x) {
  const std::size_t n = x.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(a[i * n + k]) > std::abs(a[pivot * n + k])) pivot = i;
    if (!(std::abs(a[pivot * n + k]) > 0.0)) return false;
    std::swap(x[k], x[pivot]);
    if (pivot != k) std::swap_ranges(&a[k * n], &a[k * n] + n, &a[pivot * n]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = a[i * n + k] / a[k * n + k];
      for (std::size_t j = k; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      x[i] -= factor * x[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) x[k] -= a[k * n + j] * x[j];
    x[k] /= a[k * n + k];
  }
  return std::all_of(x.begin(), x.end(), [](double of_x) { return std::isfinite(of_x); });
}

}  // namespace

Signals::Signals(const plan::Plan& plan, const Instant& instant, const UnknownPlaces& places, LinearSolution& linear)
    : plan_(plan), instant_(instant), places_(places), linear_(linear) {
  std::size_t most = most_of_ports;
  for (const plan::SignalPlan& s : plan.signals) most = std::max(most, s.inputs.size());
  for (std::vector<double>* scratch : {&inputs_, &slopes_}) scratch->assign(most, 0.0);
  row_.assign(most_of_ports + most + 1, 0.0);
  for (std::size_t i = plan::driving_signals(plan).size(); i < plan.signals.size(); ++i) {
    const plan::SignalPlan& s = plan.signals[i];
    if (s.is_state()) observed_states_.push_back(i);
    if (!s.reads_motion()) continue;
    for (const elements::Port& p : s.reading.ports)
      if (p.node != elements::ground) observed_nodes_.push_back(p.node);
  }
  const std::size_t states = observed_states_.size();
  observed_slopes_.assign(plan.signals.size() * states, 0.0);
  jacobian_.assign(states * states, 0.0);
  left_.assign(states, 0.0);
  residual_.assign(states, 0.0);
  if (!observed_nodes_.empty()) nodes_.resize(plan.nodes.size());
}

/// The angle at the last accepted step of the joint that a signal reads.
double Signals::turns_of(const plan::SignalPlan& signal, const State& state) const {
  return signal.joint < 0 ? 0.0 : state.turns[at(signal.joint)];
}

/// Size of what rounds an equation beside the terms of f: a reading is rounded as poses are, whose size is that of the
/// structure or 1 rad, and the rate of a state as the state is. Where signals prescribe coordinates, they are solved for
/// together with poses, and are rounded as these, also where they are zero.
double Signals::size_of(const plan::SignalPlan& s, double value, const elements::Slopes& slopes) const {
  if (s.is_state()) return std::abs(slopes.rate * value);
  if (!s.reads_motion()) return plan_.signals_drive ? std::max(plan_.length_scale, 1.0) : 0.0;
  const elements::Effort& read = s.reading.efforts[0];
  const double of_pose = motion::traits_of(read.coordinate).is_length ? plan_.length_scale : 1.0;
  return (std::abs(read.stiffness) + std::abs(read.damping) * slopes.velocity) * of_pose;
}

template <class G>
Signals::Value Signals::eval(std::size_t signal, const State& state, const elements::FieldOn<G, double>& field) {
  const plan::SignalPlan& s = plan_.signals[signal];
  if (s.reads_motion()) {
    const double f =
        elements::eval_reading(plan::reading_on<G>(plan_, signal), field, turns_of(s, state), slopes_.data());
    Value value{f, std::abs(f)};
    const auto add = [&value](double part) {
      value.f += part;
      value.magnitude += std::abs(part);
    };
    for (const int law : s.inputs) add(field.around.laws[at(law)]);
    if (s.row >= 0) add(-state.multipliers[at(plan_.joints[at(s.joint)].multiplier_begin + s.row)]);
    return value;
  }
  if (s.rule == plan::SignalRule::input) return {state.signals.given[signal], std::abs(state.signals.given[signal])};
  const double* laws = field.around.laws;
  if (s.rule == plan::SignalRule::surface) {
    const double x = laws[at(s.inputs[0])], y = laws[at(s.inputs[1])];
    const double f = s.surface(x, y, std::span<double, 2>(slopes_.data(), 2));
    return {f, std::abs(f) + std::abs(slopes_[0] * x) + std::abs(slopes_[1] * y)};
  }
  if (s.rule == plan::SignalRule::function) {
    const double input = laws[at(s.inputs.front())];
    const laws::LawValue v = s.function.at(input);
    slopes_[0] = v.rate;
    return {v.value, std::abs(v.value) + std::abs(v.rate * input)};
  }
  const std::size_t n = s.inputs.size();
  for (std::size_t k = 0; k < n; ++k) inputs_[k] = laws[at(s.inputs[k])];
  Value value{s.formula({inputs_.data(), n}, {slopes_.data(), n})};
  value.magnitude = std::abs(value.f);
  for (std::size_t k = 0; k < n; ++k) value.magnitude += std::abs(slopes_[k] * inputs_[k]);
  return value;
}

/// The last row of the matrix of an equation is (-df/d(nodes), -df/d(other signals), own); all else is zero. By the
/// multiplier that an effort reads, the entry is in the matrix of the joint.
void Signals::put_matrix(std::size_t signal, const elements::Slopes& slopes) {
  const plan::SignalPlan& s = plan_.signals[signal];
  const auto dof = static_cast<std::size_t>(plan_.unknowns.count);
  const auto count_of = [this](int node) {
    return static_cast<std::size_t>(plan_.unknowns.count_of(static_cast<std::size_t>(node)));
  };
  std::size_t others = 0;
  for (const int node : s.nodes) others += count_of(node);
  const std::size_t n = others + s.signals.size() + 1;
  std::fill(row_.begin(), row_.begin() + static_cast<std::ptrdiff_t>(n), 0.0);
  double& own = row_[n - 1] = 1.0;
  if (!slopes.mass_only) {
    if (s.is_state()) own = slopes.rate;
    if (s.reads_motion()) {
      for (std::size_t port = 0; port < 2; ++port) {
        const auto node = std::find(s.nodes.begin(), s.nodes.end(), s.reading.ports[port].node);
        if (node == s.nodes.end()) continue;
        const std::size_t begin = node == s.nodes.begin() ? 0 : count_of(s.nodes.front());  // there are two at most
        for (std::size_t i = 0; i < count_of(*node); ++i) row_[begin + i] -= slopes_[dof * port + i];
      }
      std::fill(slopes_.begin(), slopes_.end(), 1.0);  // by the laws of an effort
    }
    for (std::size_t k = 0; k < s.inputs.size(); ++k) {
      const int input = plan_.signal_of_law[at(s.inputs[k])];
      const auto other = std::find(s.signals.begin(), s.signals.end(), input);
      if (s.inputs[k] == s.law)
        own -= slopes_[k];
      else if (other != s.signals.end())
        row_[others + static_cast<std::size_t>(other - s.signals.begin())] -= slopes_[k];
    }
  }
  const solve::ElementView view = linear_.solver().element(s.element);
  const std::size_t last = (n - 1) * n;
  for (std::size_t i = 0; i < last; ++i) view[static_cast<std::int64_t>(i)] = 0.0;
  for (std::size_t i = 0; i < n; ++i) view[static_cast<std::int64_t>(last + i)] = row_[i];
}

void Signals::evaluate(const State& state, const elements::Slopes& slopes, bool tangent, ResidualSums& sums) {
  sums.clear_signals();
  state.visit([&]<class G>(const NodesOn<G>&) {
    const elements::FieldOn<G, double> field = instant_.field_on<G>(state, slopes);
    for (std::size_t i = 0; i < plan::driving_signals(plan_).size(); ++i) {
      const plan::SignalPlan& s = plan_.signals[i];
      const Value value = eval<G>(i, state, field);
      const double left = s.is_state() ? state.signals.rate[i] : state.signals.value[i];
      sums.set_signal(static_cast<int>(i), static_cast<std::size_t>(places_.block_begin(s.block)), left - value.f,
                      std::abs(left) + value.magnitude + size_of(s, state.signals.value[i], slopes));
      if (tangent) put_matrix(i, slopes);
    }
  });
}

template <class G>
void Signals::follow(State& state, const elements::FieldOn<G, double>& field, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const plan::SignalPlan& s = plan_.signals[i];
    if (s.is_state()) continue;
    state.signals.value[i] = eval<G>(i, state, field).f;
    instant_.note_signal(s, state.signals.value[i]);
  }
  for (std::size_t i = begin; i < end; ++i)
    if (plan_.signals[i].is_state()) state.signals.rate[i] = plan_.is_dynamic ? eval<G>(i, state, field).f : 0.0;
}

void Signals::follow_motion(State& state) {
  const std::size_t driving = plan::driving_signals(plan_).size();
  if (driving > 0)
    state.visit([&]<class G>(const NodesOn<G>&) { follow<G>(state, instant_.field_on<G>(state), 0, driving); });
  if (driving < plan_.signals.size())
    follow<motion::Se3>(state, instant_.field_of(state, observed_nodes_, nodes_), driving, plan_.signals.size());
}

/// Adds the derivatives of the inputs to those of a signal that only observes.
void Signals::add_observed_slopes(const plan::SignalPlan& signal, double* row) const {
  const std::size_t states = observed_states_.size();
  for (std::size_t k = 0; k < signal.inputs.size(); ++k) {
    const int input = plan_.signal_of_law[at(signal.inputs[k])];
    if (input < plan_.num_driving_signals) continue;  // a law of time, or a signal of the motion
    const double slope = signal.reads_motion() ? 1.0 : slopes_[k];
    for (std::size_t j = 0; j < states; ++j) row[j] += slope * observed_slopes_[at(input) * states + j];
  }
}

/// Newton's method for the states alone. All others are functions of these, which are evaluated in their order.
void Signals::observe_all(State& state, double slope) {
  const std::size_t driving = plan::driving_signals(plan_).size(), count = plan_.signals.size(),
                    states = observed_states_.size();
  constexpr int most = 20;
  constexpr double settled = 1e-15;
  const elements::Field field = instant_.field_of(state, observed_nodes_, nodes_);
  SignalValues& now = state.signals;
  for (std::size_t j = 0; j < states; ++j) {  // s' - slope s at the present values
    const std::size_t i = observed_states_[j];
    left_[j] = now.rate[i] - slope * now.value[i];
    std::fill_n(observed_slopes_.begin() + static_cast<std::ptrdiff_t>(i * states), states, 0.0);
    observed_slopes_[i * states + j] = 1.0;
  }
  for (int iteration = 0;; ++iteration) {
    for (std::size_t i = driving; i < count; ++i) {
      const plan::SignalPlan& s = plan_.signals[i];
      if (s.is_state()) continue;
      now.value[i] = eval<motion::Se3>(i, state, field).f;
      instant_.note_signal(s, now.value[i]);
      double* row = observed_slopes_.data() + i * states;
      std::fill_n(row, states, 0.0);
      add_observed_slopes(s, row);
    }
    if (states == 0) return;
    for (std::size_t j = 0; j < states; ++j) {
      const std::size_t i = observed_states_[j];
      double* row = jacobian_.data() + j * states;
      std::fill_n(row, states, 0.0);
      residual_[j] = slope * now.value[i] + left_[j] - eval<motion::Se3>(i, state, field).f;
      add_observed_slopes(plan_.signals[i], row);
      for (std::size_t k = 0; k < states; ++k) row[k] = (k == j ? slope : 0.0) - row[k];
    }
    if (iteration == most) break;
    if (!solve_in_place(jacobian_, residual_)) break;  // in statics a state without an equilibrium stays where it is
    double largest = 0.0;
    for (std::size_t j = 0; j < states; ++j) {
      const std::size_t i = observed_states_[j];
      now.value[i] -= residual_[j];
      instant_.note_signal(plan_.signals[i], now.value[i]);
      largest = std::max(largest, std::abs(residual_[j]) / std::max(std::abs(now.value[i]), 1e-300));
    }
    if (largest <= settled) break;
  }
  for (std::size_t j = 0; j < states; ++j)
    now.rate[observed_states_[j]] = slope * now.value[observed_states_[j]] + left_[j];
}

/// df/dt along the motion.
template <class G>
double Signals::eval_rate(std::size_t signal, const State& state, const elements::FieldOn<G, double>& field,
                          const std::vector<lanes::Taylor<double, 1>>& laws) {
  const plan::SignalPlan& s = plan_.signals[signal];
  if (s.rule == plan::SignalRule::input) return 0.0;
  double rate = 0.0;
  if (s.reads_motion()) {
    rate = elements::eval_reading_rate(plan::reading_on<G>(plan_, signal), field, turns_of(s, state));
    std::fill(slopes_.begin(), slopes_.end(), 1.0);  // by the laws of an effort; its multiplier's rate is an unknown
  } else {
    eval<G>(signal, state, field);
  }
  for (std::size_t k = 0; k < s.inputs.size(); ++k) rate += slopes_[k] * laws[at(s.inputs[k])].c[1];
  return rate;
}

void Signals::add_rates(const State& state, std::vector<lanes::Taylor<double, 1>>& laws, std::vector<double>& second) {
  second.assign(plan_.signals.size(), 0.0);
  for (std::size_t i = 0; i < plan_.signals.size(); ++i) {
    const plan::SignalPlan& s = plan_.signals[i];
    laws[at(s.law)].c[0] = state.signals.value[i];
    laws[at(s.law)].c[1] = state.signals.rate[i];
  }
  const auto add = [&]<class G>(const elements::FieldOn<G, double>& field, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (const plan::SignalPlan& s = plan_.signals[i]; !s.is_state())
        laws[at(s.law)].c[1] = eval_rate<G>(i, state, field, laws);
    for (std::size_t i = begin; i < end; ++i)
      if (plan_.signals[i].is_state()) second[i] = eval_rate<G>(i, state, field, laws);
  };
  const std::size_t driving = plan::driving_signals(plan_).size();
  state.visit([&]<class G>(const NodesOn<G>&) { add(instant_.field_on<G>(state), 0, driving); });
  if (driving < plan_.signals.size())
    add(instant_.field_of(state, observed_nodes_, nodes_), driving, plan_.signals.size());
}

}  // namespace bough::step
