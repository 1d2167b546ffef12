#include "vibration_watch.hpp"

#include <cstdio>

namespace bough::run {

std::optional<std::string> VibrationWatch::look(const step::Integrator& integrator, double time) {
  constexpr double noticeable = 0.5;  // of the changes of velocity
  if (seen_ || !(integrator.unresolved() > noticeable)) return std::nullopt;
  seen_ = true;
  return "from time " + std::to_string(time) +
         " on, vibrations faster than the step make up much of the accelerations, and forces and reactions show "
         "them: " +
         undamped;
}

std::optional<std::string> VibrationWatch::judge(const results::Balance& balance, double round_off, double time) {
  constexpr double largest_gain = 0.5;  // of the energy scale; errors of resolved motions stay far below
  constexpr int long_enough = 10;       // steps, because the energy scale is small after a start from rest
  const bool gains = balance.last_energy_error() > largest_gain * balance.energy_scale() + round_off;
  gaining_steps_ = gains ? gaining_steps_ + 1 : 0;
  if (gaining_steps_ < long_enough) return std::nullopt;
  char text[160];
  std::snprintf(text, sizeof text,
                "up to time %.6g the energy grew by %.3g J more than the work of loads and drives explains: ", time,
                balance.last_energy_error());
  return text + std::string(undamped);
}

}  // namespace bough::run
