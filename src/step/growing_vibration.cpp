#include "bough/step/growing_vibration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace bough::step {

namespace {

using motion::Vec6;

constexpr double fewest = 3.0, most = 12.0;  ///< steps per period of vibrations that grow
constexpr double least_damping = 0.07;       ///< cos(86 degrees), relative to critical damping
constexpr int applications =
    24;  ///< of 4 P (1 - P): vibrations outside the band fall below a thousandth of those inside

class Filter {
 public:
  Filter(System& system, const State& state, double shift)
      : system_(system), state_(state), moved_(state), shift_(shift) {}

  bool prepare() {
    const elements::Slopes slopes{0.0, shift_, false};
    return !system_.evaluate(state_, slopes, true) && !system_.linear().factor(true, slopes);
  }
  /// y = M x or y = C x in the unknowns of the solver, by differences of residuals; constraint rows are zero.
  bool multiply(bool by_mass, const std::vector<double>& x, std::vector<double>& y) {
    y.assign(x.size(), 0.0);
    if (system_.evaluate(state_, {}, false)) return false;
    y = system_.right_hand_side();
    moved_.change_all([&]<class G>(NodesOn<G>& nodes) {
      nodes.motion = state_.on<G>().motion;
      for (std::size_t n = 0; n < nodes.motion.size(); ++n)
        (by_mass ? nodes.motion[n].a : nodes.motion[n].v) += system_.places().part_on<G>(x.data(), static_cast<int>(n));
    });
    if (system_.evaluate(moved_, {}, false)) return false;
    for (std::size_t i = 0; i < y.size(); ++i) y[i] -= system_.right_hand_side()[i];
    return true;
  }
  /// y = P x.
  bool apply(const std::vector<double>& x, std::vector<double>& y) {
    if (!multiply(true, x, rhs_)) return false;
    for (double& r : rhs_) r *= shift_;
    y.resize(x.size());
    return !system_.linear().solve(rhs_.data(), y.data());
  }

 private:
  System& system_;
  const State& state_;
  State moved_;
  double shift_;
  std::vector<double> rhs_;
};

/// Inner product of the motions of all nodes. The moment arm converts rotations to lengths; multipliers do not count.
double inner(const System& system, const std::vector<double>& a, const std::vector<double>& b) {
  const double arm = system.moment_arm();
  double sum = 0.0;
  for (std::size_t n = 0; n < system.plan().nodes.size(); ++n) {
    const Vec6<double> u = system.places().node_part(a.data(), static_cast<int>(n)),
                       w = system.places().node_part(b.data(), static_cast<int>(n));
    sum += lanes::dot(lanes::linear_part(u), lanes::linear_part(w)) +
           arm * arm * lanes::dot(lanes::angular_part(u), lanes::angular_part(w));
  }
  return sum;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

int largest_node(const System& system, const std::vector<double>& x) {
  const double arm = system.moment_arm();
  int found = -1;
  double largest = 0.0;
  for (std::size_t n = 0; n < system.plan().nodes.size(); ++n) {
    const Vec6<double> u = system.places().node_part(x.data(), static_cast<int>(n));
    const double size = lanes::dot(lanes::linear_part(u), lanes::linear_part(u)) +
                        arm * arm * lanes::dot(lanes::angular_part(u), lanes::angular_part(u));
    if (size > largest) {
      largest = size;
      found = static_cast<int>(n);
    }
  }
  return found;
}

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
  Filter filter(system, state, shift);
  if (!filter.prepare()) return std::nullopt;
  std::vector<double> x = any_vector(system.places().size()), once, twice;
  double ratio = 0.0;
  for (int k = 0; k < applications; ++k) {
    const double before = std::sqrt(inner(system, x, x));
    if (!(before > 0.0 && std::isfinite(before))) return std::nullopt;
    for (double& value : x) value /= before;
    if (!filter.apply(x, once) || !filter.apply(once, twice)) return std::nullopt;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 4.0 * (once[i] - twice[i]);
    ratio = std::sqrt(inner(system, x, x));
  }
  if (!(ratio >= passed(lowest))) return std::nullopt;
  if (!filter.apply(x, once)) return std::nullopt;
  const double p = inner(system, once, x) / inner(system, x, x);
  if (!(p > 0.0 && p < 1.0)) return std::nullopt;
  const double frequency = std::sqrt(shift * (1.0 - p) / p);
  std::vector<double> product;
  if (!filter.multiply(true, x, product)) return std::nullopt;
  const double mass = dot(x, product);
  if (!filter.multiply(false, x, product)) return std::nullopt;
  if (!(dot(x, product) < 2.0 * least_damping * frequency * mass)) return std::nullopt;
  return GrowingVibration{frequency, turn / (frequency * h), largest_node(system, x)};
}

}  // namespace bough::step
