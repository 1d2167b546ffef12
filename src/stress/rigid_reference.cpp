#include "rigid_reference.hpp"

#include <cmath>

namespace bough::stress {

std::vector<double> integrate(const std::function<std::vector<double>(double, const std::vector<double>&)>& slope,
                              std::vector<double> y, double end, int steps) {
  const double h = end / steps;
  const auto moved = [&y](const std::vector<double>& direction, double by) {
    std::vector<double> z = y;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] += by * direction[i];
    return z;
  };
  for (int k = 0; k < steps; ++k) {
    const double t = k * h;
    const std::vector<double> a = slope(t, y), b = slope(t + 0.5 * h, moved(a, 0.5 * h)),
                              c = slope(t + 0.5 * h, moved(b, 0.5 * h)), d = slope(t + h, moved(c, h));
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
  }
  return y;
}

PendulumState physical_pendulum(double ratio, double angle_0, double end, double rate_0) {
  const int steps = static_cast<int>(std::ceil(2e3 * (1.0 + std::sqrt(ratio) * end)));
  const std::vector<double> y = integrate(
      [ratio](double, const std::vector<double>& z) {
        return std::vector<double>{z[1], -ratio * std::cos(z[0])};
      },
      {angle_0, rate_0}, end, steps);
  return {y[0], y[1]};
}

}  // namespace bough::stress
