#pragma once
/// Independent references: equations of motion in minimal coordinates, integrated by a high-order rule at a fine step.
#include <functional>
#include <vector>

namespace bough::stress {

/// y' = slope(t, y) from 0 to `end` by the Runge-Kutta rule of order four in `steps` steps.
std::vector<double> integrate(const std::function<std::vector<double>(double, const std::vector<double>&)>& slope,
                              std::vector<double> y, double end, int steps);

struct PendulumState {
  double angle = 0.0;  ///< about z, from the x axis [rad]
  double rate = 0.0;
};
/// angle'' = -(g m c / J) cos(angle), gravity along -y; from rest at angle_0. ratio = g m c / J [1/s^2].
PendulumState physical_pendulum(double ratio, double angle_0, double end, double rate_0 = 0.0);

}  // namespace bough::stress
