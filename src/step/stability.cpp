#include "bough/step/stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bough/blocks/at.hpp"

namespace bough::step {

using motion::Vec3;
using motion::Vec6;

namespace {

constexpr int most_iterations = 30;  ///< limit of inverse iterations with one shift
constexpr double settled = 1e-3;     ///< relative change of the curvature at convergence; the node is known earlier
constexpr int most_shifts = 60;      ///< limit of shifts, each four times the last
constexpr double round_offs = 64.0;  ///< a curvature below this many eps times its terms is taken as zero
constexpr double neutral = 1e-11;    ///< part of the diagonal that is added if the tangent is singular

}  // namespace

Stability::Stability(System& system) : system_(system) {
  const plan::Plan& plan = system.plan();
  const blocks::BlockGraph& g = plan.graph;
  const double of_length = 1.0 / (plan.length_scale * plan.length_scale);
  std::vector<char> seen(at(g.num_blocks()), 0);
  for (int b = 0; b < g.num_blocks(); ++b)
    if (g.block_kind[at(b)] == blocks::BlockKind::multiplier) num_rows_ += g.block_size[at(b)];
  for (int e = 0; e < g.num_elements(); ++e) {
    int size = 0, row = 0;
    for (std::int64_t k = g.element_begin[at(e)]; k < g.element_begin[at(e) + 1]; ++k)
      size += g.block_size[at(g.element_blocks[at(k)])];
    for (std::int64_t k = g.element_begin[at(e)]; k < g.element_begin[at(e) + 1]; ++k) {
      const int b = g.element_blocks[at(k)];
      const int n = g.block_size[at(b)];
      if (g.block_kind[at(b)] == blocks::BlockKind::motion && seen[at(b)]++ == 0)
        for (int i = 0; i < n; ++i)
          diagonal_.push_back({at(system.places().block_begin(b) + i), e,
                               static_cast<std::int64_t>(row + i) * size + row + i,
                               plan.unknowns.is_length(i) ? of_length : 1.0});
      row += n;
    }
  }
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
  return read(copy_->inertia(), copy_->last_status().deficiency);
}

void Stability::copy_tangents() {
  const plan::Plan& plan = system_.plan();
  const bool symmetric = is_conservative();
  if (!copy_)
    copy_ = std::make_unique<solve::Hierarchical>(
        plan.graph, system_.linear().tree(),
        solve::SolveOptions{.symmetry = symmetric ? solve::Symmetry::symmetric : solve::Symmetry::general,
                            .inertia = true,
                            .lanes = plan.took("lanes"),
                            .check = solve::SolveCheck::none});
  const blocks::BlockGraph& g = plan.graph;
  for (int e = 0; e < g.num_elements(); ++e) {
    int n = 0;
    for (std::int64_t k = g.element_begin[at(e)]; k < g.element_begin[at(e) + 1]; ++k)
      n += g.block_size[at(g.element_blocks[at(k)])];
    const solve::ConstElementView from = system_.linear().solver().element(e);
    const solve::ElementView to = copy_->element(e);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        to[i * n + j] = symmetric ? 0.5 * (from[i * n + j] + from[j * n + i]) : from[i * n + j];
  }
}

void Stability::add_to_diagonal(double shift, double relative_shift) {
  if (relative_shift > 0.0) {
    sizes_.assign(system_.places().size(), 0.0);
    const blocks::BlockGraph& g = system_.plan().graph;
    for (int e = 0; e < g.num_elements(); ++e) {
      std::int64_t n = 0, row = 0;
      for (std::int64_t k = g.element_begin[at(e)]; k < g.element_begin[at(e) + 1]; ++k)
        n += g.block_size[at(g.element_blocks[at(k)])];
      const solve::ConstElementView a = system_.linear().solver().element(e);
      for (std::int64_t k = g.element_begin[at(e)]; k < g.element_begin[at(e) + 1]; ++k) {
        const int b = g.element_blocks[at(k)];
        for (int i = 0; i < g.block_size[at(b)]; ++i, ++row)
          sizes_[at(system_.places().block_begin(b) + i)] += std::abs(a[row * n + row]);
      }
    }
  }
  for (const Diagonal& d : diagonal_)
    copy_->element(d.element)[d.entry] +=
        shift * d.weight + (relative_shift > 0.0 ? relative_shift * sizes_[d.unknown] : 0.0);
}

/// Factors a copy of the present tangents, K + shift N, where N is the diagonal of weights.
bool Stability::factor_copy(double shift, double relative_shift) {
  copy_tangents();
  if (shift > 0.0 || relative_shift > 0.0) add_to_diagonal(shift, relative_shift);
  copy_->rescale();
  return copy_->factor(system_.walker()).ok();
}

/// Inverse iteration from x with the factored copy: y = (K + shift N)^-1 N x on ker G. Returns the curvature y^T (K +
/// shift N) y / y^T N y. On return x is the direction, scaled to a largest entry of about one.
double Stability::iterate(std::vector<double>& x, std::vector<double>& y) {
  double curvature = 0.0;
  for (int k = 0; k < most_iterations; ++k) {
    std::vector<double> rhs(x.size(), 0.0);
    for (const Diagonal& d : diagonal_) rhs[d.unknown] = d.weight * x[d.unknown];
    static_cast<void>(copy_->solve(system_.walker(), rhs.data(), y.data()));
    double along = 0.0, square = 0.0, largest = 0.0;
    for (const Diagonal& d : diagonal_) {
      along += y[d.unknown] * rhs[d.unknown];
      square += y[d.unknown] * y[d.unknown] * d.weight;
      largest = std::max(largest, std::abs(y[d.unknown]));
    }
    if (!(largest > 0.0) || !std::isfinite(largest) || !(square > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    const double before = std::exchange(curvature, along / square);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = y[i] / largest;
    if (k > 2 && std::abs(curvature - before) <= settled * std::abs(curvature)) break;
  }
  return curvature;
}

/// Round-off of x^T K x: round_offs eps sum |x_i| |K_ij| |x_j| over all elements, without multipliers.
double Stability::round_off(const std::vector<double>& x) const {
  const blocks::BlockGraph& g = system_.plan().graph;
  std::vector<double> own;
  double sum = 0.0;
  for (int e = 0; e < g.num_elements(); ++e) {
    own.clear();
    for (std::int64_t k = g.element_begin[at(e)]; k < g.element_begin[at(e) + 1]; ++k) {
      const int b = g.element_blocks[at(k)];
      const bool moves = g.block_kind[at(b)] == blocks::BlockKind::motion;
      for (int i = 0; i < g.block_size[at(b)]; ++i)
        own.push_back(moves ? std::abs(x[at(system_.places().block_begin(b) + i)]) : 0.0);
    }
    const solve::ConstElementView a = system_.linear().solver().element(e);
    for (std::size_t i = 0; i < own.size(); ++i)
      for (std::size_t j = 0; j < own.size(); ++j)
        sum += own[i] * std::abs(a[static_cast<std::int64_t>(i * own.size() + j)]) * own[j];
  }
  return round_offs * std::numeric_limits<double>::epsilon() * sum;
}

/// The first shift is zero. Once the shift is large enough, the smallest eigenvalues of K + shift N belong to the most
/// negative ones of K, to which inverse iteration then converges.
std::optional<UnstableMode> Stability::find_mode(const State& state) {
  std::vector<double> x(system_.places().size(), 0.0), y(x.size(), 0.0);
  double shift = 0.0;
  bool is_stable = false;
  for (int k = 0; k < most_shifts && !is_stable; ++k) {
    if (!factor_copy(shift, 0.0) && !factor_copy(shift, neutral)) return std::nullopt;
    const StabilityLook look = read(copy_->inertia(), copy_->last_status().deficiency);
    is_stable = k > 0 && look.is_known && look.unstable == 0;
    for (std::size_t i = 0; i < diagonal_.size(); ++i)  // the start has a component in every direction
      x[diagonal_[i].unknown] = 1.0 + std::sin(static_cast<double>(7 * i + 1));
    const double shifted = iterate(x, y), curvature = shifted - shift;
    double square = 0.0;
    for (const Diagonal& d : diagonal_) square += x[d.unknown] * x[d.unknown] * d.weight;
    if (std::isfinite(curvature) && curvature * square < -round_off(x)) return mode_of(state, x);
    if (!is_conservative()) return mode_of(state, x);  // the eigenvalue nearest to zero changed its sign
    shift = shift == 0.0 ? 1.5 * std::abs(curvature) : 4.0 * shift;
    if (!(shift > 0.0) || !std::isfinite(shift)) return std::nullopt;
  }
  return std::nullopt;
}

UnstableMode Stability::mode_of(const State& state, const std::vector<double>& x) const {
  UnstableMode moves, turns;
  double most_moved = 0.0, most_turned = 0.0;
  const plan::Plan& plan = system_.plan();
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const Vec6<double> eta = system_.places().node_part(x.data(), static_cast<int>(n));
    const motion::Mat3<double>& R = nodes_in_space(system_.plan(), state)[n].R;
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

}  // namespace bough::step
