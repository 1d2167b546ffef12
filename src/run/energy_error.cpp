#include "energy_error.hpp"

#include <algorithm>
#include <cmath>

#include "bough/scene/sensor_kinds.hpp"

namespace bough::run {

using scene::SensorKind;

namespace {

bool has_sensor(const plan::Plan& plan, SensorKind kind) {
  return std::any_of(plan.sensors.begin(), plan.sensors.end(),
                     [kind](const plan::SensorPlan& s) { return s.sensor.kind == kind; });
}

bool has_sensor(const plan::Plan& plan, scene::SensorShows shows) {
  return std::any_of(plan.sensors.begin(), plan.sensors.end(),
                     [shows](const plan::SensorPlan& s) { return scene::type_of(s.sensor.kind).shows == shows; });
}

}  // namespace

EnergyError::EnergyError(const plan::Plan& plan, double duration, double mass)
    : of_kinetic_(has_sensor(plan, SensorKind::kinetic_energy) || has_sensor(plan, scene::SensorShows::force)),
      of_strain_(has_sensor(plan, SensorKind::strain_energy) || has_sensor(plan, scene::SensorShows::force)),
      of_potential_(has_sensor(plan, SensorKind::potential_energy)),
      of_total_(has_sensor(plan, SensorKind::total_energy)),
      largest_(0.5 * mass * plan.length_scale * plan.length_scale / (duration * duration)) {}

bool EnergyError::is_needed(const plan::Plan& plan) {
  return has_sensor(plan, scene::SensorShows::force) || has_sensor(plan, scene::SensorShows::energy);
}

double EnergyError::eval(const step::System& system, const step::State& after, const step::State& disturbed,
                         results::EnergyMeter& meter) {
  const results::Energies is = meter.eval(system, after), other = meter.eval(system, disturbed);
  if (!has_first_) first_potential_ = is.potential;
  has_first_ = true;
  largest_ = std::max(largest_, is.kinetic + is.strain + std::abs(is.potential - first_potential_));
  double most = 0.0;
  if (of_kinetic_) most = std::max(most, std::abs(other.kinetic - is.kinetic));
  if (of_strain_) most = std::max(most, std::abs(other.strain - is.strain));
  if (of_potential_) most = std::max(most, std::abs(other.potential - is.potential));
  if (of_total_) most = std::max(most, std::abs(other.total() - is.total()));
  return largest_ > 0.0 ? most / largest_ : 0.0;
}

}  // namespace bough::run
