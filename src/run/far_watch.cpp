#include "far_watch.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "bough/io/number_text.hpp"

namespace bough::run {

namespace {

constexpr double far = 1e4;          ///< |x| / L
constexpr double few_digits = 0.05;  ///< noise over the largest value of the force
constexpr double of_others = 1e-4;   ///< noise over the largest force of the sensor: less is a zero among larger forces

}  // namespace

FarWatch::FarWatch(const plan::Plan& plan) {
  std::size_t column = 0;
  for (std::size_t s = 0; s < plan.sensors.size(); column += plan.sensors[s].components.size(), ++s) {
    const plan::SensorPlan& sensor = plan.sensors[s];
    if (!plan.is_dynamic || sensor.beam < 0 || sensor.sensor.kind != scene::SensorKind::section_force) continue;
    const plan::BeamPlan& beam = plan.beams[static_cast<std::size_t>(sensor.beam)];
    double distance = 0.0;
    for (const int node : beam.nodes)
      distance = std::max(distance, length_of(plan.nodes[static_cast<std::size_t>(node)].pose.x));
    const double length = beam.length / static_cast<double>(beam.elements.size());
    if (!(distance > far * length)) continue;
    plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(beam.elements.front())],
                       [&](const auto& e) {
                         if constexpr (std::decay_t<decltype(e)>::role == elements::Role::beam)
                           for (int k = 0; k < 3; ++k)
                             forces_.push_back({column + static_cast<std::size_t>(k), sensor.sensor.name,
                                                e.stiffness(k, k) * 0x1p-53 * distance / length, distance, 0.0, s});
                       });
  }
}

void FarWatch::see(const std::vector<double>& values) {
  for (Force& f : forces_) f.largest = std::max(f.largest, std::abs(values[f.column]));
}

std::string FarWatch::text() const {
  const Force* worst = nullptr;
  for (const Force& f : forces_) {
    double of_sensor = 0.0;
    for (const Force& other : forces_)
      if (other.sensor == f.sensor) of_sensor = std::max(of_sensor, other.largest);
    if (!(f.noise > few_digits * f.largest) || !(f.noise > of_others * of_sensor)) continue;
    if (worst == nullptr || f.noise * worst->largest > worst->noise * f.largest) worst = &f;
  }
  if (worst == nullptr) return {};
  return "the section forces of '" + worst->name + "' are known to " + io::rounded_text(worst->noise, 2) +
         " N, of a component of up to " + io::rounded_text(worst->largest, 2) +
         " N: " + io::rounded_text(worst->distance, 2) +
         " m from the origin places have few digits left, which stiff sections turn into forces; put the origin near "
         "the structure";
}

}  // namespace bough::run
