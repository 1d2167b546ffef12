#pragma once
/// The tangent of an element that reads signals, in its own unknowns and the signals. Internal to step.
#include <algorithm>
#include <array>
#include <span>

#include "bough/elements/law_slope.hpp"
#include "element_parts.hpp"

namespace bough::step {

/// Extends the tangent K of an element, in its own n unknowns, by a column for each signal, which slope(s, column)
/// writes. The rows of signals are zero, for their equations are elements of their own, but for entries of multipliers.
template <class Slope>
void add_signal_columns(int n, int num_signals, const double* K, double* extended, Slope&& slope) {
  const int all = n + num_signals;
  std::array<double, most_unknowns> column;
  std::fill(extended, extended + all * all, 0.0);
  for (int i = 0; i < n; ++i) std::copy(K + i * n, K + (i + 1) * n, extended + i * all);
  for (int s = 0; s < num_signals; ++s) {
    slope(s, column.data());
    for (int i = 0; i < n; ++i) extended[i * all + n + s] = column[static_cast<std::size_t>(i)];
  }
}

}  // namespace bough::step
