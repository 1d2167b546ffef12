#include "bough/step/harmonic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/blocks/at.hpp"

namespace bough::step {

namespace {

using Part = Linearisation::Part;

/// Every block of a graph, then its twin; elements couple all of their blocks, then the twins of these.
blocks::BlockGraph with_twins(const blocks::BlockGraph& graph) {
  blocks::BlockGraph both;
  const int n = graph.num_blocks();
  for (int copy = 0; copy < 2; ++copy) {
    both.block_size.insert(both.block_size.end(), graph.block_size.begin(), graph.block_size.end());
    both.block_kind.insert(both.block_kind.end(), graph.block_kind.begin(), graph.block_kind.end());
    both.multiplier_measure.insert(both.multiplier_measure.end(), graph.multiplier_measure.begin(),
                                   graph.multiplier_measure.end());
  }
  for (int e = 0; e < graph.num_elements(); ++e) {
    for (int copy = 0; copy < 2; ++copy)
      for (std::int64_t k = graph.element_begin[at(e)]; k < graph.element_begin[at(e) + 1]; ++k)
        both.element_blocks.push_back(graph.element_blocks[at(k)] + copy * n);
    both.element_begin.push_back(static_cast<std::int64_t>(both.element_blocks.size()));
  }
  return both;
}

}  // namespace

Harmonic::Harmonic(const Linearisation& linear)
    : linear_(linear),
      graph_(with_twins(linear.system().plan().graph)),
      tree_(tree::make_tree(graph_, {.in_lockstep = false, .loops_in_one = linear.system().plan().took("small")})),
      factored_(graph_, tree_,
                solve::SolveOptions{.symmetry = solve::Symmetry::general,
                                    .lanes = false,
                                    .data_precision = linear.system().plan().precision,
                                    .check = solve::SolveCheck::none}) {
  rhs_.resize(2 * linear.size());
  solution_.resize(2 * linear.size());
}

solve::FactorStatus Harmonic::factor(double angular_frequency) {
  w_ = angular_frequency;
  for (int e = 0; e < linear_.num_elements(); ++e) {
    const std::span<const std::int64_t> unknowns = linear_.unknowns_of(e);
    const std::span<const double> K = linear_.matrix_of(Part::stiffness, e), C = linear_.matrix_of(Part::damping, e),
                                  M = linear_.matrix_of(Part::mass, e);
    const std::size_t n = unknowns.size();
    const solve::ElementView to = factored_.element(e);
    const auto put = [&](std::size_t i, std::size_t j, double value) {
      to[static_cast<std::int64_t>(i * 2 * n + j)] = value;
    };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        const std::size_t k = i * n + j;
        const bool is_of_rows = linear_.is_multiplier(at(unknowns[i])) || linear_.is_multiplier(at(unknowns[j]));
        const double re = is_of_rows ? K[k] : K[k] - w_ * w_ * M[k], im = is_of_rows ? 0.0 : w_ * C[k];
        put(i, j, re);
        put(n + i, n + j, re);
        put(i, n + j, -im);
        put(n + i, j, im);
      }
  }
  factored_.rescale();
  return factored_.factor(linear_.system().walker());
}

void Harmonic::residual(std::span<const double> f, const Vector& x, Vector& left, std::vector<double>& size) const {
  const std::size_t n = linear_.size();
  std::vector<double> re(n), im(n), a(n), b(n);
  for (std::size_t i = 0; i < n; ++i) {
    re[i] = x[i].real();
    im[i] = x[i].imag();
    left[i] = f[i];
    size[i] = std::abs(f[i]);
  }
  const std::complex<double> factors[] = {1.0, {0.0, w_}, -w_ * w_};
  for (const Part part : {Part::stiffness, Part::damping, Part::mass}) {
    const std::complex<double> factor = factors[static_cast<std::size_t>(part)];
    linear_.multiply(part, re, a);
    linear_.multiply(part, im, b);
    for (std::size_t i = 0; i < n; ++i)
      if (part == Part::stiffness || !linear_.is_multiplier(i)) left[i] -= factor * std::complex<double>(a[i], b[i]);
    linear_.multiply_magnitudes(part, re, a);
    linear_.multiply_magnitudes(part, im, b);
    for (std::size_t i = 0; i < n; ++i) size[i] += std::abs(factor) * (a[i] + b[i]);
    if (part == Part::stiffness)  // those that follow see motions alone
      for (std::size_t i = 0; i < n; ++i)
        if (linear_.is_multiplier(i)) re[i] = im[i] = 0.0;
  }
}

bool Harmonic::correct(const Vector& left, Vector& x) {
  const std::size_t n = x.size();  // twins follow, in the same order
  for (std::size_t i = 0; i < n; ++i) {
    rhs_[i] = left[i].real();
    rhs_[n + i] = left[i].imag();
  }
  static_cast<void>(factored_.solve(linear_.system().walker(), rhs_.data(), solution_.data()));
  for (std::size_t i = 0; i < n; ++i) x[i] += std::complex<double>(solution_[i], solution_[n + i]);
  return std::all_of(solution_.begin(), solution_.end(), [](double value) { return std::isfinite(value); });
}

double Harmonic::solve(std::span<const double> f, Vector& x) {
  const std::size_t n = linear_.size();
  Vector left(f.begin(), f.end());
  std::vector<double> size(n);
  x.assign(n, 0.0);
  for (int pass = 0; pass < 2; ++pass) {
    if (!correct(left, x)) return std::numeric_limits<double>::infinity();
    residual(f, x, left, size);
  }
  // Forces and moments together, in units of one another, and each signal by its own terms.
  double of_motions = 0.0, forces = 0.0, of_rows = 0.0, gaps = 0.0, of_signals = 0.0, motion = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double weight = linear_.weights()[i];
    if (linear_.is_multiplier(i)) {
      of_rows += std::norm(left[i]);
      gaps += size[i] * size[i];
    } else {
      motion = std::max(motion, weight * std::norm(x[i]));
      of_motions += std::norm(left[i]) / weight;
      forces += size[i] * size[i] / weight;
    }
  }
  // What a signal that is zero misses of it is round-off of the input, and what a coordinate at rest does of other motions.
  const double length = linear_.system().plan().length_scale;
  gaps += motion * length * length;
  const double input = std::abs(*std::max_element(f.begin(), f.end()));
  for (const std::size_t i : linear_.system().places().signals())
    of_signals = std::max(of_signals, std::abs(left[i]) / (size[i] + input));
  const auto share = [](double rest, double whole) { return whole > 0.0 ? std::sqrt(rest / whole) : 0.0; };
  return std::max({of_signals, share(of_motions, forces), share(of_rows, gaps)});
}

}  // namespace bough::step
