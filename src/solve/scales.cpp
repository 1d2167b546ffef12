/// Scales of unknowns and rows from the element matrices.
#include <algorithm>
#include <cmath>

#include "bough/blocks/at.hpp"
#include "element_store.hpp"

namespace bough::solve {

/// An unknown with a small or zero diagonal may be held through a constraint by unknowns with a larger one (the
/// rotation of a massless bar with a mass at its end). A row g then gives it the diagonal g_u^2 / sum_{v != u} g_v^2 /
/// a_v, which is used if its own diagonal is smaller by the factor `weak`. Scaled by round-off instead, such an unknown
/// would dominate the others in its rows and make them look dependent. strict: only rows of which all other unknowns
/// have a diagonal are used, and with their given diagonals; otherwise the rows of many hinges on one body, which
/// couple its unknowns in different ratios, would raise these without limit. bare: a node with only joints, to which no
/// such row leads, takes the sum over the unknowns with a diagonal in the row's other blocks, and the largest of its
/// rows; motions of its own block are held by its other joints, or not at all. Diagonals given in a bare sweep are
/// negative until its end and are not passed on in it. Returns whether a diagonal was given.
bool ElementStore::lend_diagonals(Lending lending, const std::vector<double>& given,
                                  std::vector<double>& diagonal) const {
  constexpr double weak = 1e-6;
  bool has_lent = false;
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (graph_.block_kind[at(b)] == blocks::BlockKind::motion) continue;
    for (std::int64_t t = touch_begin_[at(b)]; t < touch_begin_[at(b) + 1]; ++t) {
      const Touch touch = touches_[at(t)];
      const std::int64_t ne = size_of(touch.element);
      const auto for_motion = [&](auto&& visit) {
        std::int64_t j = 0;
        for (int p = 0; p < num_blocks_of(touch.element); ++p) {
          const int other = blocks_of(touch.element)[p];
          for (std::int64_t u = tree_.unknown_begin[at(other)]; u < tree_.unknown_begin[at(other) + 1]; ++u, ++j)
            if (graph_.block_kind[at(other)] == blocks::BlockKind::motion) visit(at(u), j, other);
        }
      };
      for (int i = 0; i < graph_.block_size[at(b)]; ++i) {
        const ConstElementView g = view(touch.element).from((touch.offset + i) * ne);
        double largest = 0.0;
        for_motion([&](std::size_t, std::int64_t j, int) { largest = std::max(largest, std::abs(g[j])); });
        // Entries that are round-off do not couple unknowns: the mobility behind them would be amplified a thousand
        // times.
        const auto couples = [&](std::int64_t j) { return std::abs(g[j]) > 1e-8 * largest; };
        for_motion([&](std::size_t u, std::int64_t j, int own) {
          if (!couples(j)) return;
          // A joint to the ground that is slightly misaligned with the node's axes holds u, and couples it weakly to
          // its neighbours. If these are not stiffer than u, they give no information about it.
          const auto is_dragged = [&](std::size_t v, std::int64_t k, int other) {
            constexpr double tiny_share = 1e-3;
            return other == own && std::abs(g[k]) < tiny_share * std::abs(g[j]) && given[u] >= weak * given[v];
          };
          double others = 0.0;  // mobility of the row's other unknowns; one without a diagonal moves freely
          bool held = true;
          for_motion([&](std::size_t v, std::int64_t k, int other) {
            if (v == u || !couples(k)) return;
            if (lending == Lending::strict && is_dragged(v, k, other)) return;
            if (lending == Lending::bare && (other == own || !(diagonal[v] > 0.0))) return;
            // What v has borrowed in this sweep, it may have from u.
            const bool takes_own = lending == Lending::strict && (given[v] > 0.0 || given[u] > 0.0);
            const double own_one = takes_own ? given[v] : diagonal[v];
            held = held && own_one > 0.0;
            if (held) others += g[k] * g[k] / own_one;
          });
          if (!held || others == 0.0) return;
          const double lent = g[j] * g[j] / others;
          if (lending == Lending::strict) {
            if (!(diagonal[u] < weak * lent)) return;
            diagonal[u] = lent;
          } else {
            if (!(diagonal[u] <= 0.0 && lent > -diagonal[u])) return;
            diagonal[u] = -lent;
          }
          has_lent = true;
        });
      }
    }
  }
  if (lending == Lending::bare && has_lent)
    for (double& d : diagonal) d = std::abs(d);
  return has_lent;
}

/// given: the sums of |diagonal| before any are added. The strict sweep is done once, since rows with different
/// coupling ratios would raise each other without limit. Bare nodes have no diagonal before, so each gets one only once
/// and passes it on in later sweeps.
void ElementStore::lift_weak_diagonals(std::vector<double>& given, std::vector<double>& diagonal) const {
  given = diagonal;
  lend_diagonals(Lending::strict, given, diagonal);
  while (lend_diagonals(Lending::bare, given, diagonal)) {
  }
}

/// A diagonal of round-off is none: a scale made from it would be up to 1e8 times too large, and rows that contain its
/// unknown would seem to depend on each other (rods without inertia about their axes, while they turn).
void ElementStore::drop_round_off(double precision, std::vector<double>& diagonal) const {
  const double round_off = std::max(2e-15, 16.0 * precision);  // of the largest diagonal of the node
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (graph_.block_kind[at(b)] != blocks::BlockKind::motion) continue;
    const auto begin = diagonal.begin() + tree_.unknown_begin[at(b)],
               end = diagonal.begin() + tree_.unknown_begin[at(b) + 1];
    const double most = begin == end ? 0.0 : *std::max_element(begin, end);
    std::replace_if(
        begin, end, [&](double d) { return d < round_off * most; }, 0.0);
  }
}

void ElementStore::eval_scales(Scales& s, std::vector<double>& scratch, double precision) const {
  const std::size_t n = at(tree_.num_unknowns());
  std::vector<double>& exact_row = s.row;
  std::vector<double>& exact_column = s.column;
  std::fill(exact_row.begin(), exact_row.end(), 0.0);
  std::fill(exact_column.begin(), exact_column.end(), 0.0);
  std::fill(s.weight.begin(), s.weight.end(), 0.0);
  const auto is_motion = [&](std::int64_t b) { return graph_.block_kind[at(b)] == blocks::BlockKind::motion; };
  // Motion: row sums |diagonal|, column has the largest entry of the row, weight that of the column.
  double probe = 0.0;  // NaN as soon as something is not finite
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (!is_motion(b)) continue;
    for (std::int64_t t = touch_begin_[at(b)]; t < touch_begin_[at(b) + 1]; ++t) {
      const Touch touch = touches_[at(t)];
      const std::int64_t ne = size_of(touch.element);
      const ConstElementView a = view(touch.element);
      for (int i = 0; i < graph_.block_size[at(b)]; ++i) {
        const std::size_t row = at(tree_.unknown_begin[at(b)] + i);
        const std::int64_t k = touch.offset + i;
        exact_row[row] += std::abs(a[k * ne + k]);
        for (std::int64_t j = 0; j < ne; ++j) {
          exact_column[row] = std::max(exact_column[row], std::abs(a[k * ne + j]));
          s.weight[row] = std::max(s.weight[row], std::abs(a[j * ne + k]));
        }
      }
    }
  }
  drop_round_off(precision, exact_row);
  s.diagonal = exact_row;
  lift_weak_diagonals(scratch, exact_row);
  s.empty_unknown = -1;
  const auto empty = [&](std::size_t i) {
    if (s.empty_unknown < 0 || static_cast<std::int64_t>(i) < s.empty_unknown)
      s.empty_unknown = static_cast<std::int64_t>(i);
  };
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (!is_motion(b)) continue;
    for (std::size_t i = at(tree_.unknown_begin[at(b)]); i < at(tree_.unknown_begin[at(b) + 1]); ++i) {
      if (exact_column[i] == 0.0 || s.weight[i] == 0.0) empty(i);
      const double value = exact_row[i] > 0.0 ? exact_row[i] : std::max(exact_column[i], s.weight[i]);
      probe += value * 0.0;
      exact_row[i] = exact_column[i] = value > 0.0 ? 1.0 / std::sqrt(value) : 1.0;
      s.weight[i] = 1.0;
    }
  }
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (is_motion(b)) continue;
    for (int i = 0; i < graph_.block_size[at(b)]; ++i) {
      double row = 0.0, column = 0.0, diagonal = 0.0;
      for (std::int64_t t = touch_begin_[at(b)]; t < touch_begin_[at(b) + 1]; ++t) {
        const Touch touch = touches_[at(t)];
        const std::int64_t ne = size_of(touch.element), k = touch.offset + i;
        const ConstElementView a = view(touch.element);
        diagonal += std::abs(a[k * ne + k]);
        std::int64_t j = 0;
        for (int p = 0; p < num_blocks_of(touch.element); ++p) {
          const int other = blocks_of(touch.element)[p];
          for (std::int64_t u = tree_.unknown_begin[at(other)]; u < tree_.unknown_begin[at(other) + 1]; ++u, ++j) {
            if (!is_motion(other)) continue;
            row += std::pow(a[k * ne + j] * exact_column[at(u)], 2);
            column += std::pow(a[j * ne + k] * exact_row[at(u)], 2);
          }
        }
      }
      const std::size_t u = at(tree_.unknown_begin[at(b)] + i);
      probe += (row + column) * 0.0;
      if (row == 0.0) row = column > 0.0 ? column : diagonal;  // a row switched off by a diagonal, or an empty one
      if (column == 0.0) column = row;
      exact_row[u] = row > 0.0 ? 1.0 / std::sqrt(row) : 1.0;
      exact_column[u] = column > 0.0 ? 1.0 / std::sqrt(column) : 1.0;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto rounded = [](double x) { return std::exp2(std::round(std::log2(x))); };
    const double column = rounded(exact_column[i]);
    s.weight[i] = column / exact_column[i];
    s.row[i] = rounded(exact_row[i]);
    s.column[i] = column;
  }
  s.finite = probe == 0.0;
  if (!graph_.multiplier_measure.empty()) measure_multipliers(s);
}

/// Weights with which scaled multipliers have the norm that the graph asks for, up to a common factor that makes them
/// one on average.
void ElementStore::measure_multipliers(Scales& s) const {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (graph_.block_kind[at(b)] == blocks::BlockKind::motion) continue;
    for (int i = 0; i < graph_.block_size[at(b)]; ++i) {
      const std::size_t u = at(tree_.unknown_begin[at(b)] + i);
      s.weight[u] = graph_.multiplier_measure[count++] * s.column[u];
      sum += std::log(s.weight[u]);
    }
  }
  const double mean = count > 0 ? std::exp(sum / static_cast<double>(count)) : 1.0;
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (graph_.block_kind[at(b)] == blocks::BlockKind::motion) continue;
    for (auto u = tree_.unknown_begin[at(b)]; u < tree_.unknown_begin[at(b) + 1]; ++u) s.weight[at(u)] /= mean;
  }
}

}  // namespace bough::solve
