#include "error_watch.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "bough/results/observe.hpp"
#include "bough/scene/sensor_kinds.hpp"

namespace bough::run {

namespace {

constexpr double least_part = 1e-6;  ///< least range of a sensor, relative to the size of the structure or 1 rad
constexpr double least_kinetic_share =
    0.3;  ///< least k of the virial theorem; 1/3 is that of a potential linear in its coordinate
constexpr double part_of_frames = 0.2;  ///< the same in a moving frame, which sees the rest of a large motion
constexpr double flip = 0.1;            ///< a larger change in one step is a jump of a rotation vector or quaternion

bool is_rate(const plan::SensorPlan& s) { return scene::type_of(s.sensor.kind).shows == scene::SensorShows::rate; }

bool is_length(const plan::SensorPlan& s, std::size_t component) {
  const std::string unit = scene::unit_of(s.sensor, component);
  return unit == "m" || unit == "m/s";
}

bool is_driven(const plan::Plan& plan) {
  if (plan.observer >= 0 || !plan.frames.empty()) return true;
  return std::any_of(plan.joints.begin(), plan.joints.end(), [&](const plan::JointPlan& joint) {
    bool driven = false;
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(joint.element)], [&](const auto& e) {
      if constexpr (std::decay_t<decltype(e)>::role == elements::Role::joint) driven = elements::is_driven(e);
    });
    return driven;
  });
}

}  // namespace

ErrorWatch::ErrorWatch(const plan::Plan& plan) : is_driven_(is_driven(plan)) {
  std::size_t index = 0;
  for (const plan::SensorPlan& s : plan.sensors) {
    for (std::size_t k = 0; k < s.components.size(); ++k, ++index) {
      if (!results::shows_motion(s.sensor.kind)) continue;
      const bool is_first = k == 0 || (is_rate(s) && k == 3);
      const bool moves_along = !s.sensor.frame.empty() && !is_rate(s);
      const double part = moves_along ? part_of_frames : least_part;
      if (is_first) least_range_.push_back(part * (is_length(s, k) ? plan.length_scale : 1.0));
      Column c;
      c.index = index;
      c.group = least_range_.size() - 1;
      c.is_rate = is_rate(s);
      c.jumps = scene::type_of(s.sensor.kind).of == scene::SensorOf::point && !c.is_rate && !is_length(s, k);
      columns_.push_back(c);
    }
  }
}

void ErrorWatch::see(const std::vector<double>& values) {
  for (Column& c : columns_) {
    const double value = values[c.index];
    c.lowest = std::min(c.lowest, value);
    c.highest = std::max(c.highest, value);
  }
}

void ErrorWatch::look(const std::vector<double>& before, const std::vector<double>& now,
                      const std::vector<double>& displaced, double norm, double h) {
  see(now);
  for (Column& c : columns_) {
    double d = std::abs(displaced[c.index] - now[c.index]);
    if (c.jumps && d > flip) d = 0.0;
    if (c.is_rate) d *= h;
    const double share = norm > 0.0 ? d / norm : 0.0;
    c.sum += (has_looked_ ? 0.5 * (c.share + share) : share) * passed_;
    c.share = share;
    if (before.empty()) continue;
    double rate = (now[c.index] - before[c.index]) / h;
    if (c.jumps && std::abs(rate) * h > flip) rate = 0.0;
    c.squares += now[c.index] * now[c.index];
    c.squared_rates += rate * rate;
  }
  if (!before.empty()) ++rated_;
  has_looked_ = true;
  passed_ = 0.0;
}

void ErrorWatch::follow(const std::vector<double>& values, bool is_next) {
  constexpr double fading = 0.9;
  followed_ = is_next ? followed_ + 1 : 0;
  see(values);
  for (Column& c : columns_) {
    const double now = values[c.index], step = now - c.last, bend = step - c.step;
    c.last = now;
    if (followed_ == 0 || (c.jumps && std::abs(step) > flip)) continue;
    c.step = step;
    if (followed_ == 1) continue;
    c.squared_steps = fading * c.squared_steps + step * step;
    c.squared_bends = fading * c.squared_bends + bend * bend;
  }
}

double ErrorWatch::turn() const {
  constexpr double least_amplitude = 0.01;  // of the range
  std::vector<double> ranges = least_range_;
  for (const Column& c : columns_) ranges[c.group] = std::max(ranges[c.group], c.highest - c.lowest);
  double most = 0.0;
  for (const Column& c : columns_) {
    if (!(c.squared_bends > 0.0 && c.squared_steps > 0.0)) continue;
    const double turn = std::sqrt(c.squared_bends / c.squared_steps);
    const double amplitude = std::sqrt(0.2 * c.squared_steps) / turn;  // 0.2: of the fading sum, the mean of squares
    if (amplitude > least_amplitude * ranges[c.group]) most = std::max(most, turn);
  }
  return most;
}

void ErrorWatch::carry(const std::vector<double>& now, const std::vector<double>& displaced, double share) {
  has_carried_ = true;
  for (Column& c : columns_) {
    const double d = share > 0.0 ? std::abs(displaced[c.index] - now[c.index]) : 0.0;
    if (share < 0.0) c.carried = std::numeric_limits<double>::infinity();
    if (c.jumps && d > flip) continue;
    if (d > 0.0) c.carried = std::max(c.carried, d / share);
  }
}

void ErrorWatch::see_energies(double time, double kinetic, double other, double taken, double largest) {
  if (has_energies_) {
    const double duration = time - last_time_;
    taken_ += 0.5 * duration * (last_taken_ + std::abs(taken));
    kinetic_ += duration * kinetic;
    other_ += duration * other;
    least_other_ = std::min(least_other_, other);
  } else {
    begin_ = time;
    least_other_ = other;
  }
  has_energies_ = true;
  last_time_ = time;
  last_taken_ = std::abs(taken);
  largest_ = largest;
}

/// Shift in time due to numerical dissipation [s].
double ErrorWatch::slowed_by() const {
  const double other = other_ - least_other_ * (last_time_ - begin_), all = kinetic_ + other;
  if (is_driven_ || !(all > 0.0 && largest_ > 0.0)) return 0.0;
  const double share = std::max(kinetic_ / all, least_kinetic_share);
  return std::abs(1.0 - 2.0 * share) / (2.0 * share) * taken_ / largest_;
}

std::vector<records::SensorError> ErrorWatch::errors(const records::HistoryHeader& header) const {
  std::vector<records::SensorError> found;
  if (!has_looked_) return found;
  std::vector<double> ranges = least_range_;
  for (const Column& c : columns_) ranges[c.group] = std::max(ranges[c.group], c.highest - c.lowest);
  const double slowed = slowed_by(), looks = std::max(1.0, static_cast<double>(rated_));
  for (const Column& c : columns_) {
    const double local = growth * (c.sum + c.share * passed_);
    const double of_shift = c.squares > 0.0 ? std::sqrt(c.squared_rates / c.squares) : 0.0;
    const double of_energy = slowed * std::sqrt(c.squared_rates / looks);
    double of_steps = c.is_rate ? local * of_shift : local;
    if (takes_carried_ && has_carried_) {
      const double beyond = c.carried - of_steps;
      if (beyond < 0.0)
        of_steps = c.carried;
      else if (certain_part_ > 0.0)
        of_steps += certain_part_ * beyond;
    }
    found.push_back({header.columns[c.index], of_steps, of_energy, ranges[c.group]});
  }
  return found;
}

}  // namespace bough::run
