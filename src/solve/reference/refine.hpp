#pragma once
/// Solution with iterative refinement by the element matrices, for the solvers other than the hierarchical one.
/// Internal to solve.
#include <algorithm>
#include <cmath>
#include <vector>

#include "bough/solve/options.hpp"
#include "bough/solve/report.hpp"
#include "bough/tree/walker.hpp"
#include "element_store.hpp"

namespace bough::solve {

/// The first block with an entry that is not finite, or -1.
inline int find_not_finite_block(const ElementStore& elements) {
  for (int e = 0; e < elements.graph().num_elements(); ++e) {
    const ConstElementView a = elements.view(e);
    for (int i = 0; i < elements.size_of(e) * elements.size_of(e); ++i)
      if (!std::isfinite(a[i])) return elements.blocks_of(e)[0];
  }
  return -1;
}

/// Scaled x, right-hand side and scratch of refinement; sized once.
struct RefineBuffers {
  explicit RefineBuffers(std::size_t n) : scaled_rhs(n), scaled(n), rhs(n), x(n), trial(n), residual(n) {}
  std::vector<double> scaled_rhs, scaled, rhs, x, trial, residual;
};

/// x = A^-1 rhs by apply(scaled right-hand side, scaled solution), then at most `most` steps of refinement while they
/// reduce the error and the normwise backward error is above refinement_above. Fills the report's backward error,
/// steps, growth.
template <class Apply>
void solve_and_refine(const tree::Walker& walker, ElementStore& elements, const Scales& scales,
                      const SolveOptions& options, int most, bool check, RefineBuffers& w, const double* rhs, double* x,
                      SolveReport& report, Apply&& apply) {
  const std::size_t n = w.x.size();
  std::copy(rhs, rhs + n, w.rhs.begin());
  const auto run = [&](const std::vector<double>& b, std::vector<double>& solution) {
    for (std::size_t i = 0; i < n; ++i) w.scaled_rhs[i] = scales.row[i] * b[i];
    apply(w.scaled_rhs.data(), w.scaled.data());
    for (std::size_t i = 0; i < n; ++i) solution[i] = scales.column[i] * w.scaled[i];
  };
  run(w.rhs, w.x);
  double rhs_size = 0.0, size = 0.0;
  std::size_t largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    rhs_size = std::max(rhs_size, std::abs(w.scaled_rhs[i]));
    if (std::abs(w.scaled[i]) <= size) continue;
    size = std::abs(w.scaled[i]);
    largest = i;
  }
  if (rhs_size > 0.0 && size > 0.0) {
    report.growth = size / rhs_size;
    report.growth_block = elements.tree().block_of_unknown(static_cast<std::int64_t>(largest));
  }
  if (check) {
    auto errors = elements.eval_residual(walker, scales, w.x.data(), w.rhs.data(), w.residual.data());
    while (errors.finite && errors.normwise > options.refinement_above && report.refinement_steps < most) {
      run(w.residual, w.trial);
      for (std::size_t i = 0; i < n; ++i) w.trial[i] += w.x[i];
      const auto refined = elements.eval_residual(walker, scales, w.trial.data(), w.rhs.data(), w.residual.data());
      if (!(refined.normwise < errors.normwise)) break;  // no further improvement: keep the better one
      errors = refined;
      std::swap(w.x, w.trial);
      ++report.refinement_steps;
    }
    report.backward_error = errors.normwise;
    report.finite = errors.finite;
  }
  std::copy(w.x.begin(), w.x.end(), x);
}

}  // namespace bough::solve
