#include "mode_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace bough::run {

void draw_modes(Recording& recording, const step::System& system, const step::State& about,
                const std::vector<step::Mode>& modes) {
  const plan::Plan& plan = system.plan();
  constexpr double whole_turn = 2.0 * std::numbers::pi;
  constexpr double far = 0.06, most_turn = 0.4;
  constexpr std::size_t most_pictures = 300;
  const std::size_t pictures = std::clamp<std::size_t>(most_pictures / std::max<std::size_t>(modes.size(), 1), 8, 24);
  for (std::size_t k = 0; k < modes.size() && k * pictures < most_pictures; ++k) {
    double moves = 0.0, turns = 0.0;
    std::vector<double> re(modes[k].shape.size()), rate(re.size());
    for (const double phase : {0.0, 0.25}) {
      for (std::size_t i = 0; i < re.size(); ++i)
        re[i] = (modes[k].shape[i] * std::polar(1.0, whole_turn * phase)).real();
      for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
        const motion::Vec6<double> eta = system.places().node_part(re.data(), static_cast<int>(n));
        moves = std::max(moves, length_of(lanes::linear_part(eta)) / plan.length_scale);
        turns = std::max(turns, length_of(lanes::angular_part(eta)));
      }
    }
    const double largest = std::max(moves / far, turns / most_turn);
    if (!(largest > 0.0)) continue;
    for (std::size_t p = 0; p <= pictures; ++p) {
      if (p == pictures && k + 1 < modes.size()) break;  // the next mode begins there
      if (p == 0 && k == 0) continue;                    // the state itself was recorded
      const double phase = static_cast<double>(p) / static_cast<double>(pictures);
      // A sine of real shapes: every mode begins and ends in the state that it is about.
      const std::complex<double> swing = std::polar(1.0 / largest, whole_turn * (phase - 0.25)),
                                 speed = swing * whole_turn * std::complex<double>(0.0, 1.0);
      for (std::size_t i = 0; i < re.size(); ++i) {
        re[i] = (modes[k].shape[i] * swing).real();
        rate[i] = (modes[k].shape[i] * speed).real();
      }
      step::State shown = about;
      shown.time = static_cast<double>(k) + phase;
      for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
        step::move_node(plan, shown, n, system.places().node_part(re.data(), static_cast<int>(n)));
        step::set_velocity(plan, shown, n, system.places().node_part(rate.data(), static_cast<int>(n)));
      }
      recording.draw_shape(shown);
    }
  }
}

}  // namespace bough::run
