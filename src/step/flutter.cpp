#include "bough/step/flutter.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "bough/step/krylov.hpp"
#include "bough/step/linearisation.hpp"

namespace bough::step {

namespace {

constexpr int most_vectors = 40;       ///< of the Krylov space
constexpr double is_found = 1e-6;      ///< relative residual of an eigenvalue that counts
constexpr double least_growth = 1e-3;  ///< relative to the frequency: below this it may be round-off of a double one
constexpr double slowest = 1e-6;       ///< eigenvalues below this part of the largest are not looked at
constexpr double beside_zero =
    1e-9;  ///< least shift where K alone is not factored soundly, over the largest K_ii / M_ii

/// The node that moves most in a vibration.
int largest_node(const Linearisation& linear, const std::vector<std::complex<double>>& shape) {
  std::vector<double> amplitude(shape.size());
  std::transform(shape.begin(), shape.end(), amplitude.begin(), [](const auto& x) { return std::abs(x); });
  return linear.largest_node(amplitude);
}

}  // namespace

std::optional<Flutter> find_flutter(System& system, const State& state) {
  using Part = Linearisation::Part;
  Linearisation linear(system);
  if (linear.take(state)) return std::nullopt;
  // Bodies that joints alone hold have no stiffness of their own: K + s M has no pivots of zero.
  double shift = 0.0;
  for (double part = beside_zero; !linear.factor_soundly({.mass = shift}, solve::Symmetry::general); part *= 1e3) {
    shift = part * linear.fastest();
    if (!(shift > 0.0) || part > 1.0) return std::nullopt;
  }
  std::vector<double> forces(linear.size()), start(linear.size());
  Krylov space(
      [&](const std::vector<double>& x, std::vector<double>& y) {
        linear.multiply(Part::mass, x, forces);
        y.resize(x.size());
        return linear.solve(forces, y);
      },
      [&](const std::vector<double>& x, std::vector<double>& y) {
        y.resize(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) y[i] = linear.weights()[i] * x[i];
        return true;
      });
  for (std::size_t i = 0; i < start.size(); ++i)
    if (const double w = linear.weights()[i]; w > 0.0)
      start[i] = (1.0 + std::sin(static_cast<double>(7 * i + 1))) / std::sqrt(w);
  if (!space.begin(start) || !space.extend(most_vectors)) return std::nullopt;
  const std::vector<Krylov::Ritz> found = space.eigenvalues(false);
  Flutter worst;
  for (const Krylov::Ritz& one : found) {  // 1 / (squared frequencies + shift)
    const double size = std::abs(one.value);
    if (size < slowest * std::abs(found.front().value) || one.residual > is_found * size) continue;
    const std::complex<double> frequency = std::sqrt(1.0 / one.value - shift);
    const double growth = std::abs(frequency.imag());
    if (growth <= least_growth * std::abs(frequency) || growth <= worst.growth) continue;
    worst = {true, std::abs(frequency.real()), growth, largest_node(linear, space.vector_of(one))};
    if (worst.frequency < 1e-6 * growth) worst.frequency = 0.0;
  }
  return worst;
}

}  // namespace bough::step
