#include "bough/step/stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "bough/blocks/at.hpp"

namespace bough::step {

using motion::Vec3;
using motion::Vec6;

namespace {

constexpr int most_iterations = 30;  ///< limit of inverse iterations with one shift
constexpr double settled = 1e-3;     ///< relative change of the curvature at convergence; the node is known earlier
constexpr int most_shifts = 60;      ///< limit of shifts, each four times the last
constexpr double neutral = 1e-11;    ///< part of the diagonal that is added if the tangent is singular
constexpr double beside_neutral = 1e-14;  ///< the same of the largest entry, for what has no diagonal

}  // namespace

UnstableMode unstable_mode_of(const System& system, const State& state, const std::vector<double>& x) {
  UnstableMode moves, turns;
  double most_moved = 0.0, most_turned = 0.0;
  const plan::Plan& plan = system.plan();
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const Vec6<double> eta = system.places().node_part(x.data(), static_cast<int>(n));
    const motion::Mat3<double>& R = nodes_in_space(system.plan(), state)[n].R;
    const Vec3<double> u = R * lanes::linear_part(eta), w = R * lanes::angular_part(eta);
    if (length_of(u) > most_moved) {
      most_moved = length_of(u);
      moves = {static_cast<int>(n), (1.0 / most_moved) * u, false};
    }
    if (length_of(w) > most_turned) {
      most_turned = length_of(w);
      turns = {static_cast<int>(n), (1.0 / most_turned) * w, true};
    }
  }
  constexpr double still = 1e-6;  // relative to the size of the structure, or rad
  UnstableMode mode = most_moved > still * plan.length_scale * most_turned ? moves : turns;
  int largest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(mode.direction[i]) > std::abs(mode.direction[largest]) + still) largest = i;
  if (mode.direction[largest] < 0.0) mode.direction = -1.0 * mode.direction;
  return mode;
}

Stability::Stability(System& system) : system_(system) {
  const blocks::BlockGraph& g = system.plan().graph;
  for (int b = 0; b < g.num_blocks(); ++b)
    if (g.block_kind[at(b)] == blocks::BlockKind::multiplier) num_rows_ += g.block_size[at(b)];
}

StabilityLook Stability::read(const solve::Inertia& inertia, int deficiency) const {
  StabilityLook look;
  if (is_conservative()) {
    look.unstable = inertia.negative - (num_rows_ - std::max(0, deficiency));
    look.is_known = inertia.negative >= 0 && look.unstable >= 0;
  } else {
    look.is_known = inertia.determinant != 0;
    look.unstable = (inertia.determinant < 0) != (num_rows_ % 2 != 0) ? 1 : 0;
  }
  if (!look.is_known) look.unstable = 0;
  return look;
}

StabilityLook Stability::look() {
  StabilityLook look = read(system_.linear().solver().inertia(), system_.linear().solver().last_status().deficiency);
  if (!look.is_known || look.unstable != last_) look = look_closely();
  if (look.is_known) last_ = look.unstable;
  return look;
}

StabilityLook Stability::look_closely() {
  if (!factor_copy(0.0, 0.0) && !factor_copy(0.0, neutral)) return {};
  return read_copy();
}

StabilityLook Stability::read_copy() {
  return read(copy_->solver().inertia(), copy_->solver().last_status().deficiency);
}

/// Factors a copy of the present tangents, K + shift N + relative_shift |diag K|. Bodies that joints alone hold have no
/// diagonal of their own: where their factor is not sound, a part of the largest entry is added for them, too.
bool Stability::factor_copy(double shift, double relative_shift) {
  if (!copy_) copy_ = std::make_unique<Linearisation>(system_);
  copy_->take_tangents();
  const auto symmetry = is_conservative() ? solve::Symmetry::symmetric : solve::Symmetry::general;
  const auto factor = [&](double weights) {
    return copy_->factor({.weights = shift + weights, .of_diagonal = relative_shift}, symmetry).ok();
  };
  if (relative_shift == 0.0) return copy_->factor_soundly({.weights = shift}, symmetry);
  if (copy_->factor_soundly({.weights = shift, .of_diagonal = relative_shift}, symmetry)) return true;
  const double scale = system_.plan().length_scale;
  return factor(beside_neutral * copy_->largest(Linearisation::Part::stiffness) * scale * scale) || factor(0.0);
}

/// Inverse iteration from x with the factored copy: y = (K + shift N)^-1 N x on ker G. Returns the curvature y^T (K +
/// shift N) y / y^T N y. On return x is the direction, scaled to a largest entry of about one.
double Stability::iterate(std::vector<double>& x, std::vector<double>& y) {
  double curvature = 0.0;
  for (int k = 0; k < most_iterations; ++k) {
    const std::vector<double>& weights = copy_->weights();
    std::vector<double> rhs(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) rhs[i] = weights[i] * x[i];
    static_cast<void>(copy_->solve(rhs, y));
    const double along = std::inner_product(y.begin(), y.end(), rhs.begin(), 0.0), square = copy_->inner(y, y);
    double largest = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i)
      if (weights[i] > 0.0) largest = std::max(largest, std::abs(y[i]));
    if (!(largest > 0.0) || !std::isfinite(largest) || !(square > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    const double before = std::exchange(curvature, along / square);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = y[i] / largest;
    if (k > 2 && std::abs(curvature - before) <= settled * std::abs(curvature)) break;
  }
  return curvature;
}

/// The first shift is zero. Once the shift is large enough, the smallest eigenvalues of K + shift N belong to the most
/// negative ones of K, to which inverse iteration then converges.
std::optional<UnstableMode> Stability::find_mode(const State& state) {
  std::vector<double> x(system_.places().size(), 0.0), y(x.size(), 0.0);
  double shift = 0.0;
  bool is_stable = false;
  for (int k = 0; k < most_shifts && !is_stable; ++k) {
    if (!factor_copy(shift, 0.0) && !factor_copy(shift, neutral)) return std::nullopt;
    const StabilityLook look = read_copy();
    is_stable = k > 0 && look.is_known && look.unstable == 0;
    for (std::size_t i = 0; i < x.size(); ++i)  // the start has a component in every direction
      x[i] = copy_->weights()[i] > 0.0 ? 1.0 + std::sin(static_cast<double>(7 * i + 1)) : 0.0;
    const double shifted = iterate(x, y), curvature = shifted - shift;
    const double noise = copy_->round_off(Linearisation::Part::stiffness, x);
    if (std::isfinite(curvature) && curvature * copy_->inner(x, x) < -noise) return unstable_mode_of(system_, state, x);
    if (!is_conservative())
      return unstable_mode_of(system_, state, x);  // the eigenvalue nearest to zero changed its sign
    shift = shift == 0.0 ? 1.5 * std::abs(curvature) : 4.0 * shift;
    if (!(shift > 0.0) || !std::isfinite(shift)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace bough::step
