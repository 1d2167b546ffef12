#include "bough/step/find_equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "newton.hpp"

namespace bough::step {

namespace {

constexpr double tightest = 1e-12;  ///< tolerance of the equations: what is left unbalanced would ring
constexpr double endless = 1e3;     ///< motion over the size of the structure that has no end
constexpr int most_steps = 400;

/// The state at rest, its signals too, and nothing known of steps before it.
void rest(System& system, State& state) {
  set_at_rest(state);
  system.signals().follow_motion(state);
  for (auto* known : {&state.signals.rate, &state.signals.algorithmic, &state.signals.trend})
    std::fill(known->begin(), known->end(), 0.0);
  state.change_all([&](auto& nodes) {
    for (auto* known : {&nodes.algorithmic, &nodes.acceleration_trend, &nodes.trend_change})
      known->assign_zero(system.node_order());
  });
  std::fill(state.multiplier_trend.begin(), state.multiplier_trend.end(), 0.0);
  std::fill(state.multiplier_trend_change.begin(), state.multiplier_trend_change.end(), 0.0);
  state.predictor_order = state.multiplier_order = 0;
  state.local_error = state.increment = state.velocity_error = 0.0;
}

/// Sizes h of the steps of pseudo-time, and when they have arrived. While h is small the changes grow with h^2, then
/// they shrink faster and faster, and in the end they are round-off.
class PseudoTime {
 public:
  explicit PseudoTime(double first_size) : first_(first_size), size_(first_size) {}
  double size() const { return size_; }

  /// After a step that was not solved: Newton's method needs a start that is nearer. False: smaller steps are of no
  /// use.
  bool reject() {
    constexpr double least = 1e-9;  // of the first size
    growth_ = cautious;
    size_ /= cut;
    return size_ >= least * first_;
  }
  /// After a step that changed poses by this much. True: they change no more.
  bool accept(double change) {
    constexpr double small = 1e-8;   // changes that may be round-off
    constexpr double most = 1e12;    // of the first size: inertia is 1e24 times weaker than there
    constexpr int quiet_enough = 3;  // one or two equal changes may be chance
    const bool has_shrunk = previous_ < 1e-3 * largest_;
    const bool grows = change > 4.0 * previous_, shrinks = change <= 0.25 * previous_;
    const bool is_round_off = change < small && !shrinks && !grows;
    quiet_ = change == 0.0 || is_round_off ? quiet_ + 1 : 0;
    if (grows && has_shrunk && previous_ < small) {
      // Motions that nothing resists take the residual's round-off times h^2: h has become too large for them.
      size_ /= cut * growth_;
      growth_ = 1.0;
    } else if (size_ < most * first_) {
      size_ *= growth_;
    }
    largest_ = std::max(largest_, change);
    previous_ = change;
    return quiet_ == quiet_enough;
  }

 private:
  // Changes grow with the square of h: by 16 from step to step while inertia prevails.
  static constexpr double bold = 4.0, cautious = 2.0, cut = 4.0;
  double first_, size_, growth_ = bold;
  double largest_ = 0.0, previous_ = 0.0;  ///< changes
  int quiet_ = 0;                          ///< steps in a row whose changes look like round-off
};

/// The largest change of a state that drives the motion, relative to what it was or has become.
double change_of_states(const plan::Plan& plan, const std::vector<double>& before, const std::vector<double>& now) {
  double most = 0.0;
  for (std::size_t i = 0; i < plan::driving_signals(plan).size(); ++i)
    if (const double change = std::abs(now[i] - before[i]); plan.signals[i].is_state() && change > 0.0)
      most = std::max(most, change / std::max(std::abs(now[i]), std::abs(before[i])));
  return most;
}

/// The node that has moved farthest from its place in `start`.
const std::string& farthest(const plan::Plan& plan, const std::vector<elements::NodeMotion>& start,
                            const std::vector<elements::NodeMotion>& now) {
  std::size_t most = 0;
  double largest = -1.0;
  for (std::size_t n = 0; n < now.size(); ++n) {
    const motion::Vec3<double> shift = motion::difference(now[n].x, start[n].x);
    const double square = lanes::dot(shift, shift);
    if (square > largest) {
      largest = square;
      most = n;
    }
  }
  return plan.nodes[most].name;
}

}  // namespace

EquilibriumReport find_equilibrium(System& system, State& state, const StepOptions& given, double first_size) {
  EquilibriumReport report;
  const plan::Plan& plan = system.plan();
  const std::vector<elements::NodeMotion> start = nodes_in_space(plan, state);
  const double time = state.time;
  const std::vector<double> signals = state.signals.value;
  std::vector<double> before;
  StepOptions options = given;
  options.spectral_radius = 0.0;
  options.tolerance = std::min(given.tolerance, tightest);
  options.single_solution = false;
  for (PseudoTime pseudo(first_size); !report.found;) {
    rest(system, state);
    state.time = time;
    state.step_size = pseudo.size();
    before = state.signals.value;
    const StepReport step = advance(system, state, options, time, laws::Side::right);
    report.iterations += step.iterations;
    if (!step.converged) {
      if (pseudo.reject()) continue;
      report.cause = step.cause;
      return report;
    }
    if (!plan.joints.empty()) accept_turns(system, state);
    ++report.steps;
    report.moved += state.increment;
    report.found = pseudo.accept(std::max(state.increment, change_of_states(plan, before, state.signals.value)));
    if (!report.found && (report.steps == most_steps || report.moved > endless)) {
      report.cause = "'" + farthest(plan, start, nodes_in_space(plan, state)) +
                     "' moves farthest and comes to no rest: hold it, or start from the given places";
      return report;
    }
  }
  rest(system, state);
  // States that only observe have x' = 0, or stay where they start.
  for (std::size_t i = plan::driving_signals(plan).size(); i < signals.size(); ++i) {
    if (plan.signals[i].is_state()) state.signals.value[i] = signals[i];
    state.signals.rate[i] = 0.0;
  }
  system.signals().observe(state, 0.0);
  state.time = time;
  state.step_size = 0.0;
  system.linear().forget_factor();
  const std::vector<elements::NodeMotion> now = nodes_in_space(plan, state);
  for (std::size_t n = 0; n < now.size(); ++n) {
    const motion::Mat3<double> turn = lanes::transpose(now[n].R) * start[n].R;
    set_velocity(plan, state, n,
                 lanes::join(turn * lanes::linear_part(start[n].v), turn * lanes::angular_part(start[n].v)));
  }
  return report;
}

}  // namespace bough::step
