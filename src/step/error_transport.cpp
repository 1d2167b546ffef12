#include "bough/step/error_transport.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alpha_rule.hpp"

namespace bough::step {

using lanes::angular_part;
using lanes::cross;
using lanes::join;
using lanes::linear_part;
using motion::Mat3;
using motion::Vec3;
using motion::Vec6;

namespace {

/// Numerical damping of what the steps do not resolve; a resolved vibration of 20 steps a period loses 4e-4 of its
/// amplitude in one.
constexpr double spectral_radius = 0.8;
/// The matrix lacks the terms of z that turn with the nodes. They are of the order w h, by which each solution of a step
/// is nearer to the last: fewer are needed the less the nodes turn. What is left acts as a force that moves with the
/// error and would make it grow in a thousand turns.
constexpr int most_solutions = 14;
constexpr double lost = 1e50;  ///< size of an error that tells nothing any more, whose squares are finite
constexpr double solved = 1e-6, not_solved = 1e-2;  ///< change by the last solution, relative to that over the step
constexpr double rounding = 1e-6;  ///< of the error: smaller changes over a step are resolved no better
/// Size of the velocities at which residuals are differenced, relative to the size of the structure in a step: far
/// above round-off, and small enough that gyroscopic forces, which are quadratic, are linear to the same digits.
constexpr double difference = 1e-6;

Vec6<double> to_ground(const Mat3<double>& R, const Vec6<double>& v) {
  return join(R * linear_part(v), R * angular_part(v));
}
Vec6<double> to_node(const Mat3<double>& R, const Vec6<double>& v) {
  return join(transpose_times(R, linear_part(v)), transpose_times(R, angular_part(v)));
}

/// So many steps of an error that changes by `change` from one to the next keep its sign.
Vec3<double> coherent(const Vec3<double>& error, const Vec3<double>& change, double steps) {
  const double e = length_of(error), d = length_of(change);
  return (d * steps > e ? e / d : steps) * error;
}

/// The larger of a displacement, relative to this length, and a rotation.
double size_of(const Vec6<double>& v, double length) {
  return std::max(length_of(linear_part(v)) / length, length_of(angular_part(v)));
}

}  // namespace

ErrorTransport::ErrorTransport(const plan::Plan& plan, const scene::Solver& solver, const tree::Walker& walker,
                               const State& start)
    : plan_(plan), solver_(solver), walker_(walker), system_(plan, solver, walker), moved_(start), time_(start.time) {
  z_.assign(plan.nodes.size(), Vec6<double>::zero());
  rate_ = second_ = algorithmic_ = next_ = extra_v_ = extra_a_ = z_;
  base_.assign(system_.places().size(), 0.0);
  rhs_ = x_ = base_;
  signals_.value.assign(plan.signals.size(), 0.0);
  signals_.rate = signals_.algorithmic = signals_.value;
  system_.linear().drop_symmetry();  // the error is to be carried by whole tangents
}

ErrorTransport::ErrorTransport(const ErrorTransport& other)
    : ErrorTransport(other.plan_, other.solver_, other.walker_, other.moved_) {
  time_ = other.time_;
  z_ = other.z_;
  rate_ = other.rate_;
  second_ = other.second_;
  algorithmic_ = other.algorithmic_;
  signals_ = other.signals_;
  step_ = other.step_;
  random_ = other.random_;
}

void ErrorTransport::restart(double time) {
  time_ = time;
  step_ = 0.0;
  std::fill(second_.begin(), second_.end(), Vec6<double>::zero());
  std::fill(algorithmic_.begin(), algorithmic_.end(), Vec6<double>::zero());
}

ErrorTransport::BodyRates ErrorTransport::rates_of(const elements::NodeMotion& node, const Vec6<double>& z,
                                                   const Vec6<double>& rate, const Vec6<double>& second) const {
  const Vec3<double> u = linear_part(node.v), w = angular_part(node.v), a = linear_part(node.a);
  const Vec6<double> eta = to_node(node.R, z), first = to_node(node.R, rate), next = to_node(node.R, second);
  const Vec3<double> turn = angular_part(eta), dw = angular_part(first);
  return {join(linear_part(first) + cross(u, turn), dw),
          join(linear_part(next) - cross(w, linear_part(first)) + cross(a, turn) + cross(u, dw - cross(w, turn)),
               angular_part(next) - cross(w, dw))};
}

std::optional<Trouble> ErrorTransport::carry(const State& state) {
  const double h = state.time - time_;
  if (!(h > 0.0)) return std::nullopt;
  time_ = state.time;
  if (!(size() > 0.0) || !(size() < lost)) return std::nullopt;
  return solve_rates(state, h);
}

/// One step of the rule. Rates are those of z = 0 and what differs from c1 eta and c2 eta, so that the pose, on which
/// stiff forces depend, is that of the run in all evaluations:
///   S eta = -(R(v + s g_v, a + s g_a) - R(v, a)) / s,   g_v = du - c1 eta,   g_a = d(du)/dt - c2 eta
std::optional<Trouble> ErrorTransport::solve_rates(const State& state, double h) {
  const AlphaRule rule{make_alpha_coefficients(spectral_radius), h, FirstOrderRule(spectral_radius, h)};
  if (auto t = begin_step(state, rule)) return t;
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(plan_, state);
  for (std::size_t n = 0; n < nodes.size(); ++n) next_[n] = z_[n] + h * rate_[n];
  num_solutions_ = 0;
  double left = 1.0;
  for (int k = 0; k < most_solutions && left > solved; ++k)
    if (auto t = solve_once(state, rule, left)) return t;
  is_solved_ = left <= not_solved;
  if (num_solutions_ > 0) end_step(rule);
  return std::nullopt;
}

/// Evaluates and factors the tangents of the run at the end of the step.
std::optional<Trouble> ErrorTransport::begin_step(const State& state, const AlphaRule& rule) {
  // a_n belongs to a time after the step that is a part of its size.
  if (step_ > 0.0)
    for (std::size_t n = 0; n < z_.size(); ++n)
      algorithmic_[n] = second_[n] + (rule.h / step_) * Vec6<double>(algorithmic_[n] - second_[n]);
  step_ = rule.h;
  moved_ = state;
  moved_.change_all([]<class G>(NodesOn<G>& of) {  // S is the derivative by eta alone, not by the increment of a step
    for (auto& node : of.motion) node.dq = NodesOn<G>::Vector::zero();
  });
  const elements::Slopes slopes = rule.slopes();
  if (auto t = system_.set_time(state.time)) return t;
  if (auto t = system_.evaluate(moved_, slopes, true)) return t;
  base_ = system_.right_hand_side();
  return system_.linear().factor(true, slopes);
}

/// One solution for next_. left: its change, relative to that over the step; 0 where there is no error.
std::optional<Trouble> ErrorTransport::solve_once(const State& state, const AlphaRule& rule, double& left) {
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(plan_, state);
  const double most = find_extra_rates(nodes, rule);
  left = 0.0;
  if (!(most > 0.0) || !std::isfinite(most)) return std::nullopt;
  const double share = difference / most;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    set_velocity(plan_, moved_, n, nodes[n].v + share * extra_v_[n]);
    set_acceleration(plan_, moved_, n, nodes[n].a + share * extra_a_[n]);
  }
  for (std::size_t i = 0; i < plan::driving_signals(plan_).size(); ++i) {
    if (!plan_.signals[i].is_state()) continue;
    const double algorithmic = rule.states.algorithmic(0.0, signals_.value[i], signals_.algorithmic[i]);
    moved_.signals.rate[i] =
        state.signals.rate[i] + share * rule.states.rate(algorithmic, signals_.algorithmic[i], signals_.rate[i]);
  }
  if (auto t = system_.evaluate(moved_, {}, false)) return t;
  for (std::size_t i = 0; i < rhs_.size(); ++i) rhs_[i] = (system_.right_hand_side()[i] - base_[i]) / share;
  if (auto t = system_.linear().solve(rhs_.data(), x_.data(), false)) return t;
  ++num_solutions_;
  double change = 0.0, size = 0.0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Vec6<double> z = to_ground(nodes[n].R, system_.places().node_part(x_.data(), static_cast<int>(n)));
    change = std::max(change, size_of(Vec6<double>(z - next_[n]), plan_.length_scale));
    size = std::max(
        {size, size_of(Vec6<double>(z - z_[n]), plan_.length_scale), rounding * size_of(z, plan_.length_scale)});
    next_[n] = z;
  }
  left = size > 0.0 ? change / size : 0.0;
  return std::nullopt;
}

/// g_v and g_a of next_, and the largest of them as displacements in a step, lengths over the size of the structure.
double ErrorTransport::find_extra_rates(const std::vector<elements::NodeMotion>& nodes, const AlphaRule& rule) {
  const elements::Slopes slopes = rule.slopes();
  double most = 0.0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto now = rule.follow(Vec6<double>(next_[n] - z_[n]), rate_[n], second_[n], algorithmic_[n]);
    const BodyRates body = rates_of(nodes[n], next_[n], now.v, now.a);
    const Vec6<double> eta = to_node(nodes[n].R, next_[n]);
    extra_v_[n] = body.v - slopes.velocity * eta;
    extra_a_[n] = body.a - slopes.acceleration * eta;
    most = std::max({most, rule.h * size_of(extra_v_[n], plan_.length_scale),
                     rule.h * rule.h * size_of(extra_a_[n], plan_.length_scale)});
  }
  for (const double r : signals_.algorithmic) most = std::max(most, rule.h * std::abs(r));
  return most;
}

void ErrorTransport::end_step(const AlphaRule& rule) {
  for (std::size_t n = 0; n < z_.size(); ++n) {
    const auto now = rule.follow(Vec6<double>(next_[n] - z_[n]), rate_[n], second_[n], algorithmic_[n]);
    rate_[n] = now.v;
    second_[n] = now.a;
    algorithmic_[n] = now.algorithmic;
    z_[n] = next_[n];
  }
  for (std::size_t i = 0; i < plan::driving_signals(plan_).size(); ++i) {
    const double value = x_[system_.places().signals()[i]];
    if (plan_.signals[i].is_state()) {
      const double algorithmic = rule.states.algorithmic(value, signals_.value[i], signals_.algorithmic[i]);
      signals_.rate[i] = rule.states.rate(algorithmic, signals_.algorithmic[i], signals_.rate[i]);
      signals_.algorithmic[i] = algorithmic;
    }
    signals_.value[i] = value;
  }
}

double ErrorTransport::add(const State& state, const LocalError& local, double steps) {
  double most = 0.0;
  std::size_t k = 0;
  for (std::size_t i = 0; i < plan::driving_signals(plan_).size(); ++i)
    if (plan_.signals[i].is_state()) signals_.value[i] += steps * local.of_state(k++);
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(plan_, state);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (system_.places().node_begin(static_cast<int>(n)) < 0) continue;
    const LocalError::OfNode error = local.of_node(n);
    const Vec6<double> eta = join(coherent(linear_part(error.place), linear_part(error.change), steps),
                                  coherent(angular_part(error.place), angular_part(error.change), steps));
    const double of_place = length_of(linear_part(error.place)), of_turn = length_of(angular_part(error.place));
    const Vec6<double> dv =
        join((of_place > 0.0 ? length_of(linear_part(eta)) / of_place : 0.0) * linear_part(error.velocity),
             (of_turn > 0.0 ? length_of(angular_part(eta)) / of_turn : 0.0) * angular_part(error.velocity));
    most = std::max(most, size_of(eta, plan_.length_scale));
    z_[n] += to_ground(nodes[n].R, eta);
    // dx' = R (du - u x eta_w)
    rate_[n] += to_ground(nodes[n].R,
                          join(linear_part(dv) - cross(linear_part(nodes[n].v), angular_part(eta)), angular_part(dv)));
  }
  return most;
}

void ErrorTransport::disturb(const State& state, double duration) {
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(plan_, state);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (system_.places().node_begin(static_cast<int>(n)) < 0) continue;
    const double u = length_of(linear_part(nodes[n].v)), w = length_of(angular_part(nodes[n].v));
    const double linear = duration * (length_of(linear_part(nodes[n].a)) + w * u) + 0x1p-53 * u;
    const double angular = duration * (length_of(angular_part(nodes[n].a)) + w * w) + 0x1p-53 * w;
    for (int i = 0; i < 6; ++i) {
      random_ = random_ * 6364136223846793005ULL + 1442695040888963407ULL;
      rate_[n][i] += (i < 3 ? linear : angular) * (static_cast<double>(random_ >> 11) * 0x1p-52 - 1.0);
    }
  }
}

double ErrorTransport::size() const {
  double most = 0.0;
  for (std::size_t n = 0; n < z_.size(); ++n) {
    const double here = size_of(z_[n], plan_.length_scale);
    if (!std::isfinite(here)) return std::numeric_limits<double>::infinity();
    most = std::max(most, here);
  }
  return most;
}

void ErrorTransport::displace(double share, std::size_t node, elements::NodeMotion& motion) const {
  const BodyRates body = rates_of(motion, z_[node], rate_[node], second_[node]);
  motion.v += share * body.v;
  const Vec6<double> eta = share * to_node(motion.R, z_[node]);
  const auto moved = motion::moved(motion::PreciseFrame<double>{motion.R, motion.x}, eta);
  motion.R = moved.R;
  motion.x = moved.x;
}

}  // namespace bough::step
