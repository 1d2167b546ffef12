#include "bough/step/growing_vibration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bough/step/linearisation.hpp"

namespace bough::step {

namespace {

constexpr double fewest = 3.0, most = 12.0;  ///< steps per period of vibrations that grow
constexpr double least_damping = 0.07;       ///< cos(86 degrees), relative to critical damping
constexpr int applications =
    24;  ///< of 4 P (1 - P): vibrations outside the band fall below a thousandth of those inside

class Filter {
 public:
  using Part = Linearisation::Part;
  Filter(System& system, double shift) : linear_(system), shift_(shift), forces_(linear_.size()) {}

  bool prepare(const State& state) {
    return !linear_.take(state) && linear_.factor({.mass = shift_}, solve::Symmetry::general).ok();
  }
  /// y = P x.
  bool apply(const std::vector<double>& x, std::vector<double>& y) {
    linear_.multiply(Part::mass, x, forces_);
    for (double& f : forces_) f *= shift_;
    y.resize(x.size());
    return linear_.solve(forces_, y);
  }
  /// x^T A x
  double form(Part part, const std::vector<double>& x) {
    linear_.multiply(part, x, forces_);
    return std::inner_product(x.begin(), x.end(), forces_.begin(), 0.0);
  }
  const Linearisation& linear() const { return linear_; }

 private:
  Linearisation linear_;
  double shift_;
  std::vector<double> forces_;
};

/// A fixed pseudo-random vector, which has a component in every vibration.
std::vector<double> any_vector(std::size_t size) {
  std::vector<double> x(size);
  unsigned long long seed = 20;
  for (double& value : x) {
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    value = static_cast<double>(seed >> 11) * 0x1p-52 - 1.0;
  }
  return x;
}

}  // namespace

std::optional<GrowingVibration> find_growing_vibration(System& system, const State& state, double h) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const double lowest = turn / (most * h), highest = turn / (fewest * h), shift = lowest * highest;
  const auto passed = [shift](double frequency) {
    const double p = shift / (frequency * frequency + shift);
    return 4.0 * p * (1.0 - p);
  };
  Filter filter(system, shift);
  if (!filter.prepare(state)) return std::nullopt;
  const Linearisation& linear = filter.linear();
  std::vector<double> x = any_vector(system.places().size()), once, twice;
  double ratio = 0.0;
  for (int k = 0; k < applications; ++k) {
    const double before = std::sqrt(linear.inner(x, x));
    if (!(before > 0.0 && std::isfinite(before))) return std::nullopt;
    for (double& value : x) value /= before;
    if (!filter.apply(x, once) || !filter.apply(once, twice)) return std::nullopt;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 4.0 * (once[i] - twice[i]);
    ratio = std::sqrt(linear.inner(x, x));
  }
  if (!(ratio >= passed(lowest))) return std::nullopt;
  if (!filter.apply(x, once)) return std::nullopt;
  const double p = linear.inner(once, x) / linear.inner(x, x);
  if (!(p > 0.0 && p < 1.0)) return std::nullopt;
  const double frequency = std::sqrt(shift * (1.0 - p) / p), mass = filter.form(Filter::Part::mass, x);
  if (!(filter.form(Filter::Part::damping, x) < 2.0 * least_damping * frequency * mass)) return std::nullopt;
  return GrowingVibration{frequency, turn / (frequency * h), linear.largest_node(x)};
}

}  // namespace bough::step
