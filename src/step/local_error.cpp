#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "bough/step/step_control.hpp"
#include "planar_step.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

/// The largest magnitudes of each of six entries.
struct Largest {
  Vec6<double> most = Vec6<double>::zero();
  void include(const Vec6<double>& v) {
    for (int i = 0; i < 6; ++i) most[i] = std::max(most[i], std::abs(v[i]));
  }
  double linear() const { return std::max({most[0], most[1], most[2]}); }
  double angular() const { return std::max({most[3], most[4], most[5]}); }
};

/// Whether a sensor shows where something is or how fast it moves: forces, accelerations and energies are of the whole
/// structure.
bool is_of_motion(const plan::SensorPlan& s) {
  using Kind = scene::SensorKind;
  switch (s.sensor.kind) {
    case Kind::position:
    case Kind::rotation:
    case Kind::quaternion:
    case Kind::velocity:
    case Kind::joint_angle:
    case Kind::joint_displacement:
    case Kind::joint_rate:
      return true;
    default:
      return false;
  }
}

}  // namespace

ErrorConstants make_error_constants(const AlphaCoefficients& c) {
  const double d = c.shift();
  const double kappa = 0.5 * (1.0 - c.alpha_f - (1.0 - c.alpha_m) * (1.0 + 2.0 * d) - d * d);
  return {c.beta + 0.5 * d - 1.0 / 6.0, kappa - 0.5 * d * d + 1.0 / 12.0};
}

LocalError::LocalError(const System& system, const StepOptions& options, double duration)
    : alpha_(make_alpha_coefficients(options.spectral_radius)) {
  constants_ = make_error_constants(alpha_);
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
}

void LocalError::watch(const plan::Plan& plan) {
  if (plan.sensors.empty() || !std::all_of(plan.sensors.begin(), plan.sensors.end(), is_of_motion)) return;
  std::fill(watched_.begin(), watched_.end(), Watched{});
  for (const plan::SensorPlan& s : plan.sensors) watch(plan, s);
}

void LocalError::watch(const plan::Plan& plan, const plan::SensorPlan& sensor) {
  using Kind = scene::SensorKind;
  const Kind kind = sensor.sensor.kind;
  const bool is_place = kind == Kind::position || kind == Kind::joint_displacement;
  const bool is_rate = kind == Kind::velocity || kind == Kind::joint_rate;
  const auto add = [&](int node, double arm) {
    if (node < 0) return;
    Watched& w = watched_[static_cast<std::size_t>(node)];
    w.place = true;
    w.turns |= !is_place;
    w.velocity |= is_rate;
    w.arm = std::max(w.arm, arm);
  };
  const auto add_port = [&](const elements::Port& port) {
    const motion::Vec3<double>& x = port.offset.x;
    add(port.node, port.has_offset ? std::sqrt(lanes::dot(x, x)) : 0.0);
  };
  if (sensor.beam >= 0) {
    const plan::BeamPlan& beam = plan.beams[static_cast<std::size_t>(sensor.beam)];
    const std::size_t count = beam.elements.size(), order = (beam.nodes.size() - 1) / count;
    const double at = sensor.sensor.station * static_cast<double>(count);
    const std::size_t element = std::min(static_cast<std::size_t>(std::max(at, 0.0)), count - 1);
    for (std::size_t k = 0; k <= order; ++k)
      add(beam.nodes[element * order + k], beam.length / static_cast<double>(count));
  } else if (sensor.joint >= 0) {
    const int element = plan.joints[static_cast<std::size_t>(sensor.joint)].element;
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(element)], [&](const auto& e) {
      for (const elements::Port& port : e.ports) add_port(port);
    });
  } else {
    add_port(sensor.port);
  }
}

Vec6<double> LocalError::unfiltered_of(const State& after, std::size_t node) const {
  const elements::NodeMotion& to = after.nodes[node];
  return (constants_.position / after.step_size) * after.acceleration_trend[node] -
         (1.0 / 12.0) * motion::cross6_times(to.v, to.a);
}

double LocalError::unfiltered(System& system, const State& after) const {
  const double h3 = after.step_size * after.step_size * after.step_size;
  const auto of_size = [&](double linear, double angular) {
    return std::max(h3 * linear / (least_.position + allowance_.position),
                    h3 * angular / (least_.rotation + allowance_.rotation));
  };
  if (PlanarStep* plane = system.planar_step()) {
    const std::array<double, 2> most = plane->largest_error(constants_.position / after.step_size, system.walker());
    return of_size(most[0], most[1]);
  }
  Largest error;
  for (std::size_t n = 0; n < after.nodes.size(); ++n) error.include(unfiltered_of(after, n));
  return of_size(error.linear(), error.angular());
}

std::optional<Trouble> LocalError::measure(System& system, const State& after) {
  const double h = after.step_size, h3 = h * h * h;
  std::vector<double>&rhs = system.work().rhs, &x = system.work().x;
  // Forces are linear in v': M e = R(v' + e) - R(v'), with an e of the size of v' so that the difference keeps its digits.
  const double c2 = (1.0 - alpha_.alpha_m) / ((1.0 - alpha_.alpha_f) * alpha_.beta * h * h);
  if (auto t = system.evaluate(after, {}, false)) return t;  // the last iteration need not have looked at it
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -system.residual()[i];
  shifted_ = after;
  for (std::size_t n = 0; n < shifted_.nodes.size(); ++n) shifted_.nodes[n].a += h * unfiltered_of(after, n);
  if (auto t = system.evaluate(shifted_, {}, false)) return t;
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = c2 * (rhs[i] + system.residual()[i]);
  if (auto t = system.solve(rhs.data(), x.data())) return t;
  Largest change;
  ErrorParts most;
  for (std::size_t n = 0; n < now_.size(); ++n) {
    now_[n] = (1.0 / h) * system.node_part(x.data(), static_cast<int>(n));
    const Watched& w = watched_[n];
    if (!w.place) continue;
    Largest error;
    error.include(now_[n]);
    most.position = std::max({most.position, error.linear(), w.arm * error.angular()});
    if (w.turns) most.rotation = std::max(most.rotation, error.angular());
    if (has_previous_ && w.velocity) change.include(now_[n] - previous_[n]);
  }
  step_ = h;
  const double of_change = velocity_factor();
  parts_ = {h3 * most.position, h3 * most.rotation, of_change * change.linear(), of_change * change.angular()};
  return std::nullopt;
}

/// e_v over the change of e / h^3 from step to step.
double LocalError::velocity_factor() const {
  return step_ * step_ * step_ * std::abs(constants_.velocity / constants_.position) / (0.5 * (step_ + previous_step_));
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
    found = {static_cast<int>(n), velocity > place,
             of_error > 0.0 ? of_changed / (of_error * 0.5 * (step_ + previous_step_)) : 0.0};
  }
  return found;
}

void LocalError::displace(const State& after, State& to) const {
  to = after;
  for (std::size_t n = 0; n < now_.size(); ++n) {
    to.nodes[n].v += (step_ * step_) * now_[n];
    move_node(to, n, (step_ * step_ * step_) * now_[n]);
  }
}

void LocalError::accept(const State& after) {
  std::swap(now_, previous_);
  previous_step_ = step_;
  has_previous_ = true;
  Largest velocity;
  for (const elements::NodeMotion& n : after.nodes) velocity.include(n.v);
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
  const auto node = static_cast<std::size_t>(std::max(0, limit(tolerance).node));
  char text[160];
  std::snprintf(text, sizeof text, " is %.2g %s, %.3g times what the tolerance of step control allows", worst.error,
                worst.unit, worst.error / worst.allowed);
  return std::string("the local error of the ") + worst.what + " of '" + plan.nodes[node].name + "'" + text;
}

double LocalError::relative_motion() const {
  const ErrorParts size = sizes();
  return std::max(parts_.position / size.position, parts_.rotation / size.rotation);
}

double LocalError::relative_velocity() const {
  const ErrorParts size = sizes();
  return std::max(parts_.velocity / size.velocity, parts_.angular_velocity / size.angular_velocity);
}

}  // namespace bough::step
