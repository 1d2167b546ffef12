#include "not_judged.hpp"

#include <algorithm>

#include "bough/results/observe.hpp"

namespace bough::run {

namespace {

constexpr const char* remedy = "; a run in steps half as long tells";

/// The reason why there is no estimate for any sensor; empty if there are estimates.
std::string why_none(const step::StepOptions& options, bool checks) {
  if (options.integrator == scene::Integrator::variational) return "the variational integrator tells no local errors";
  if (options.integrator == scene::Integrator::bdf) return "backward differences tell no local errors";
  if (!checks) return "/output/checks is false";
  if (options.single_solution && !options.step_control) return "steps of one linear solution tell no local errors";
  return "";
}

std::string names_of(const std::vector<std::string>& sensors) {
  constexpr std::size_t most_named = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(sensors.size(), most_named); ++i)
    text += (i == 0 ? "'" : ", '") + sensors[i] + "'";
  if (sensors.size() > most_named) text += " and " + std::to_string(sensors.size() - most_named) + " more sensors";
  return text;
}

}  // namespace

std::string one_line(std::initializer_list<std::string> parts) {
  std::string text;
  for (const std::string& part : parts)
    if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
  return text;
}

std::string error_not_judged(const plan::Plan& plan, const step::StepOptions& options, bool checks,
                             const std::vector<records::SensorError>& errors) {
  const std::string why = why_none(options, checks);
  if (!why.empty()) return "the error in time is not estimated, " + why + remedy;
  std::vector<std::string> others;
  bool shows_motion = false;
  for (const plan::SensorPlan& s : plan.sensors)
    if (results::shows_motion(s.sensor.kind))
      shows_motion = true;
    else
      others.push_back(s.sensor.name);
  if (shows_motion && errors.empty())
    return std::string("the error in time is not estimated, no local error was measured in so few steps") + remedy;
  if (others.empty()) return "";
  return "the error in time of " + names_of(others) +
         " is not estimated, only that of places, rotations and velocities is" + remedy;
}

}  // namespace bough::run
