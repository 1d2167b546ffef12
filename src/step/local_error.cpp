#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <type_traits>

#include "bough/motion/vectors_on.hpp"
#include "bough/scene/sensor_kinds.hpp"
#include "bough/step/step_control.hpp"
#include "drift.hpp"
#include "first_order.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

/// Largest magnitude of each of the six entries over many vectors.
struct Largest {
  Vec6<double> most = Vec6<double>::zero();
  void include(const Vec6<double>& v) {
    for (int i = 0; i < 6; ++i) most[i] = std::max(most[i], std::abs(v[i]));
  }
  double linear() const { return std::max({most[0], most[1], most[2]}); }
  double angular() const { return std::max({most[3], most[4], most[5]}); }
};

/// Whether values of a sensor depend on the motion of the whole mechanism, not on that of its point or joint alone.
bool is_seen_whole(const plan::SensorPlan& s) {
  const scene::SensorShows shows = scene::type_of(s.sensor.kind).shows;
  return shows == scene::SensorShows::force || shows == scene::SensorShows::energy;
}

}  // namespace

LocalError::LocalError(const System& system, const StepOptions& options, double duration)
    : plan_(system.plan()),
      spectral_radius_(options.spectral_radius),
      alpha_(make_alpha_coefficients(options.spectral_radius)) {
  const double length = system.plan().length_scale;
  least_ = {length, 1.0, length / duration, 1.0 / duration};
  if (options.step_control) {
    const scene::StepControl& c = *options.step_control;
    allowance_ = {c.position_tolerance / c.tolerance, c.rotation_tolerance / c.tolerance,
                  c.velocity_tolerance / c.tolerance, c.angular_velocity_tolerance / c.tolerance};
  }
  now_.assign(system.plan().nodes.size(), Vec6<double>::zero());
  previous_ = now_;
  shifted_ = make_initial_state(system.plan());
  watched_.assign(now_.size(), {true, true, true, 0.0});
  if (options.step_control) watch(system.plan());
  for (std::size_t i = 0; i < plan::driving_signals(plan_).size(); ++i)
    if (plan_.signals[i].is_state()) states_.push_back({i});
}

void LocalError::watch(const plan::Plan& plan) {
  if (plan.sensors.empty()) return;
  std::fill(watched_.begin(), watched_.end(), Watched{});
  for (const plan::SensorPlan& s : plan.sensors) watch(plan, s);
  if (std::any_of(plan.sensors.begin(), plan.sensors.end(), is_seen_whole)) watch_mechanism(plan);
}

/// Watches the gross motion of the mechanism: positions and rotations of bodies, positions of the ends of beams. Inner
/// nodes of beams and rotations of their ends are not watched, because they carry many vibrations and little of the
/// gross motion.
void LocalError::watch_mechanism(const plan::Plan& plan) {
  std::vector<char> is_of_beam(watched_.size(), 0), is_end(watched_.size(), 0);
  for (const plan::BeamPlan& beam : plan.beams) {
    for (const int node : beam.nodes) is_of_beam[static_cast<std::size_t>(node)] = 1;
    for (const int node : {beam.nodes.front(), beam.nodes.back()}) is_end[static_cast<std::size_t>(node)] = 1;
  }
  for (std::size_t n = 0; n < watched_.size(); ++n) {
    if (is_of_beam[n] != 0 && is_end[n] == 0) continue;
    watched_[n].place = true;
    watched_[n].turns |= is_end[n] == 0;
  }
}

void LocalError::watch(const plan::Plan& plan, const plan::SensorPlan& sensor) {
  const scene::SensorType& type = scene::type_of(sensor.sensor.kind);
  if (type.shows == scene::SensorShows::energy) return;  // their error is given by set_energy_error()
  const bool velocity = type.shows != scene::SensorShows::pose;
  const bool is_length = !velocity && type.components.front().unit == "m";
  const bool turns = !is_length || type.takes(scene::SensorField::axes_of);  // of a part that turns
  if (sensor.beam >= 0) {
    const plan::BeamPlan& beam = plan.beams[static_cast<std::size_t>(sensor.beam)];
    const std::size_t count = beam.elements.size(), order = (beam.nodes.size() - 1) / count;
    const double at = sensor.sensor.station * static_cast<double>(count);
    const std::size_t element = std::min(static_cast<std::size_t>(std::max(at, 0.0)), count - 1);
    for (std::size_t k = 0; k <= order; ++k)
      watch(beam.nodes[element * order + k], beam.length / static_cast<double>(count), turns, velocity);
  } else if (sensor.joint >= 0) {
    const int element = plan.joints[static_cast<std::size_t>(sensor.joint)].element;
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(element)], [&](const auto& e) {
      for (const elements::Port& port : e.ports) {
        watch(port, turns, velocity);
        if (type.of == scene::SensorOf::reaction) watch_ends(plan, port.node);
      }
    });
  } else {
    watch(sensor.port, turns, velocity);
  }
  for (const int element : sensor.elements)
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(element)], [&](const auto& e) {
      for (const elements::Port& port : e.ports) {
        watch(port, turns, velocity);
        watch_ends(plan, port.node);
      }
    });
  for (const elements::Port& port : sensor.chain) watch(port, turns, velocity);
}

/// Watches the end elements of all beams that end at a node: a reaction there contains their vibrations.
void LocalError::watch_ends(const plan::Plan& plan, int node) {
  for (const plan::BeamPlan& beam : plan.beams) {
    const std::size_t count = beam.elements.size(), order = (beam.nodes.size() - 1) / count;
    for (std::size_t k = 0; k <= order; ++k) {
      if (beam.nodes.front() == node) watch(beam.nodes[k], 0.0, true, true);
      if (beam.nodes.back() == node) watch(beam.nodes[beam.nodes.size() - 1 - k], 0.0, true, true);
    }
  }
}

void LocalError::watch(const elements::Port& port, bool turns, bool velocity) {
  watch(port.node, port.has_offset ? length_of(port.offset.x) : 0.0, turns, velocity);
}

void LocalError::watch(int node, double arm, bool turns, bool velocity) {
  if (node < 0) return;
  Watched& w = watched_[static_cast<std::size_t>(node)];
  w.place = true;
  w.turns |= turns;
  w.velocity |= velocity;
  w.arm = std::max(w.arm, arm);
}

/// Sets `to` to `after` with h times (unfiltered error of dq) / h^3 added to dv/dt.
void LocalError::shift_accelerations(const System& system, const State& after, State& to) const {
  const double h = after.step_size;
  to = after;
  to.change_all([&]<class G>(NodesOn<G>& nodes) {
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) {
      auto& node = nodes.motion[n];
      typename G::template Vector<double> v = node.v, rate = node.a;  // relative to the frame of the step
      if constexpr (G::turns) {
        const auto& choice = std::get<DriftChoice<G>>(system.work().drift_choice);
        if (!choice.eights.empty()) {
          const Drift<G, double> drift{node.drift,
                                       G::turned_back({node.R, G::template Translation<double>::zero()}, choice.fall)};
          rate = without<G, double>(rate, drift.rate(v));
          v = without<G, double>(v, drift.velocity);
        }
      }
      node.a += h * ((alpha_.error_of_increments() / h) * nodes.acceleration_trend[n] -
                     (1.0 / 12.0) * motion::VectorsOn<G>::template bracket<double>(v, rate));
    }
  });
}

/// Enters s h (e_x / h^3) by the equations of states. x''' is the change of x'' since the step before or, in the first
/// one, since the start, which is half a step away.
void LocalError::enter_states(System& system, const State& after, std::vector<double>& rhs) {
  if (states_.empty()) return;
  const State& start = system.work().start;
  const double h = after.step_size;
  const FirstOrderRule rule(spectral_radius_, h);
  const double constant = 1.0 / 12.0 + rule.shift() * (rule.alpha_f - 0.5);
  const bool is_after_start = start.local_error == 0.0 && start.increment == 0.0;
  for (WatchedState& s : states_) {
    s.trend = (after.signals.rate[s.signal] - start.signals.rate[s.signal]) / h;
    double third = 0.0;
    if (has_previous_)
      third = (s.trend - s.trend_before) / (0.5 * (h + previous_step_));
    else
      third = (s.trend - start.signals.trend[s.signal] / start.step_size) / (is_after_start ? 0.5 * h : h);
    rhs[system.places().signals()[s.signal]] = rule.slope() * h * constant * third;
  }
}

std::optional<Trouble> LocalError::measure(System& system, const State& after) {
  const double h = after.step_size, h3 = h * h * h;
  std::vector<double>&rhs = system.work().rhs, &x = system.work().x;
  // The residual is linear in v', so R(v' + e) = R(v') + M e, of which the step has left R(v') below what it converged
  // to. The e used here is of the size of v', far above that.
  const double c2 = (1.0 - alpha_.alpha_m) / ((1.0 - alpha_.alpha_f) * alpha_.beta * h * h);
  shift_accelerations(system, after, shifted_);
  if (auto t = system.evaluate(shifted_, {}, false)) return t;
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -c2 * system.right_hand_side()[i];
  enter_states(system, after, rhs);
  if (auto t = system.linear().solve(rhs.data(), x.data(), false)) return t;  // the step has checked the factor
  if (!std::all_of(x.begin(), x.end(), [](double of_x) { return std::isfinite(of_x); }))
    return Trouble{"the local error of the step is not finite"};
  for (WatchedState& s : states_) s.error = x[system.places().signals()[s.signal]] / h;
  Largest change;
  ErrorParts most;
  for (std::size_t n = 0; n < now_.size(); ++n) {
    now_[n] = (1.0 / h) * system.places().node_part(x.data(), static_cast<int>(n));
    const Watched& w = watched_[n];
    if (!w.place) continue;
    Largest error;
    error.include(now_[n]);
    most.position = std::max({most.position, error.linear(), w.arm * error.angular()});
    if (w.turns) most.rotation = std::max(most.rotation, error.angular());
    if (has_previous_ && w.velocity) change.include(now_[n] - previous_[n]);
  }
  step_ = h;
  energy_ = 0.0;
  const double of_change = velocity_factor();
  parts_ = {h3 * most.position, h3 * most.rotation, of_change * change.linear(), of_change * change.angular()};
  return std::nullopt;
}

/// Ratio of the velocity error e_v to the change of e / h^3 from step to step.
double LocalError::velocity_factor() const {
  return step_ * step_ * step_ * std::abs(alpha_.error_of_velocities() / alpha_.error_of_increments()) /
         (0.5 * (step_ + previous_step_));
}

ErrorLimit LocalError::limit(double tolerance) const {
  ErrorLimit found;
  const double h3 = step_ * step_ * step_, of_change = velocity_factor(), of_place = h3 / std::pow(tolerance, 1.5);
  const ErrorParts size = sizes();
  double most = 0.0;
  for (std::size_t n = 0; n < now_.size(); ++n) {
    Largest error, change;
    error.include(now_[n]);
    if (has_previous_) change.include(now_[n] - previous_[n]);
    const Watched& w = watched_[n];
    const double linear = std::max(error.linear(), w.arm * error.angular()) / size.position;
    const double angular = w.turns ? error.angular() / size.rotation : 0.0;
    const double place = w.place ? of_place * std::max(linear, angular) : 0.0;
    const double velocity =
        w.velocity ? of_change / tolerance *
                         std::max(change.linear() / size.velocity, change.angular() / size.angular_velocity)
                   : 0.0;
    if (std::max(place, velocity) <= most) continue;
    most = std::max(place, velocity);
    const bool turns = error.angular() * size.position > error.linear() * size.rotation;
    const double of_error = turns ? error.angular() : error.linear(),
                 of_changed = turns ? change.angular() : change.linear();
    found = {static_cast<int>(n), -1, velocity > place, false,
             of_error > 0.0 ? of_changed / (of_error * 0.5 * (step_ + previous_step_)) : 0.0};
  }
  for (const WatchedState& s : states_) {
    const double error = of_place * std::abs(s.error) / s.size;
    if (error <= most) continue;
    most = error;
    found = {-1, static_cast<int>(s.signal), false, false, 0.0};
  }
  if (energy_ / std::pow(tolerance, 1.5) > most) found = {-1, -1, false, true, 0.0};
  return found;
}

LocalError::OfNode LocalError::of_node(std::size_t node) const {
  const double h3 = step_ * step_ * step_;
  if (!has_previous_) return {h3 * now_[node], Vec6<double>::zero(), Vec6<double>::zero()};
  const Vec6<double> change = now_[node] - previous_[node];
  return {(0.5 * h3) * Vec6<double>(now_[node] + previous_[node]), h3 * change,
          std::copysign(velocity_factor(), alpha_.error_of_velocities()) * change};
}

void LocalError::displace(std::size_t node, elements::NodeMotion& motion) const {
  motion.v += (step_ * step_) * now_[node];
  const auto moved = motion::moved(motion::PreciseFrame<double>{motion.R, motion.x},
                                   Vec6<double>((step_ * step_ * step_) * now_[node]));
  motion.R = moved.R;
  motion.x = moved.x;
}

void LocalError::disturb(const State& after, State& to) const {
  to = after;
  const double of_change = has_previous_ ? std::copysign(velocity_factor(), alpha_.error_of_velocities()) : 0.0;
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(plan_, after);
  for (std::size_t n = 0; n < now_.size(); ++n) {
    set_velocity(plan_, to, n, nodes[n].v + of_change * (now_[n] - previous_[n]));
    move_node(plan_, to, n, (step_ * step_ * step_) * now_[n]);
  }
}

void LocalError::accept(const State& after) {
  std::swap(now_, previous_);
  previous_step_ = step_;
  has_previous_ = true;
  Largest velocity;
  after.visit([&]<class G>(const NodesOn<G>& nodes) {
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) {
      if constexpr (std::is_same_v<G, motion::Se3>)
        velocity.include(nodes.motion[n].v);
      else  // without the poses in space, which would cost most of a measurement of a planar scene
        velocity.include(plan_.unknowns.expanded(&nodes.motion[n].v[0], n));
    }
  });
  for (WatchedState& s : states_) {
    s.trend_before = s.trend;
    s.size = std::max(s.size, std::abs(after.signals.value[s.signal]));
  }
  speed_ = std::max(speed_, velocity.linear());
  spin_ = std::max(spin_, velocity.angular());
}

ErrorParts LocalError::sizes() const {
  return {least_.position + allowance_.position, least_.rotation + allowance_.rotation,
          std::max(least_.velocity, speed_) + allowance_.velocity,
          std::max(least_.angular_velocity, spin_) + allowance_.angular_velocity};
}

std::string LocalError::describe(const plan::Plan& plan, double tolerance) const {
  struct Part {
    const char *what, *unit;
    double error, allowed;
  };
  const double of_motion = std::pow(tolerance, 1.5);
  const ErrorParts size = sizes();
  const Part parts[] = {{"position", "m", parts_.position, of_motion * size.position},
                        {"rotation", "rad", parts_.rotation, of_motion * size.rotation},
                        {"velocity", "m/s", parts_.velocity, tolerance * size.velocity},
                        {"angular velocity", "rad/s", parts_.angular_velocity, tolerance * size.angular_velocity}};
  const Part& worst = *std::max_element(std::begin(parts), std::end(parts), [](const Part& a, const Part& b) {
    return a.error * b.allowed < b.error * a.allowed;
  });
  const ErrorLimit most = limit(tolerance);
  char text[160];
  if (most.is_energy) {
    std::snprintf(text, sizeof text,
                  "the local error of the energy is %.2g of the largest so far, %.3g times what the tolerance of step "
                  "control allows",
                  energy_, energy_ / std::pow(tolerance, 1.5));
    return text;
  }
  if (most.signal >= 0) {
    std::snprintf(text, sizeof text, "' is %.2g of its size, %.3g times what the tolerance of step control allows",
                  relative_state(), relative_state() / of_motion);
    return "the local error of the state '" + plan.signals[static_cast<std::size_t>(most.signal)].name + text;
  }
  const auto node = static_cast<std::size_t>(std::max(0, most.node));
  std::snprintf(text, sizeof text, " is %.2g %s, %.3g times what the tolerance of step control allows", worst.error,
                worst.unit, worst.error / worst.allowed);
  return std::string("the local error of the ") + worst.what + " of '" + plan.nodes[node].name + "'" + text;
}

double LocalError::relative_motion() const {
  const ErrorParts size = sizes();
  return std::max(parts_.position / size.position, parts_.rotation / size.rotation);
}

double LocalError::relative_state() const {
  double most = 0.0;
  for (const WatchedState& s : states_) most = std::max(most, std::abs(s.error) / s.size);
  return step_ * step_ * step_ * most;
}

double LocalError::relative_velocity() const {
  const ErrorParts size = sizes();
  return std::max(parts_.velocity / size.velocity, parts_.angular_velocity / size.angular_velocity);
}

}  // namespace bough::step
