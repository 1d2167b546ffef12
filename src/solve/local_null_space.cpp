/// Dependent rows that are decided in a front below the root, or in the root like in any other front: null vectors,
/// which have few entries, and what is checked before they count.
#include <algorithm>
#include <cmath>

#include "bough/blocks/at.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {

constexpr int most = NullVectors::most;

/// Entries below this share of the largest one of their vector are round-off. Left in, they would couple every null
/// vector with the whole subtree.
constexpr double round_off = 4e-16;

}  // namespace

/// Condensed entries of multipliers up to this may be what the precision of the data leaves over of rows that depend on
/// each other: it grows in the elimination. Whether rows depend is asked of the rows themselves, in
/// are_dependent_rows(). 0: the data are exact.
double Hierarchical::State::uncertain_entry() const {
  constexpr double growth = 1e3, largest = 1e-3;
  return std::min(largest, growth * options.data_precision);
}

/// Decides rows and columns of multipliers that are negligible in what remains of the front. They are complete, since
/// only descendants take part in them, so they depend on rows below for any values of the matrix elsewhere.
void Hierarchical::State::decide_dependent(tree::FrontId f) {
  FrontData& d = data(f);
  if (d.pivots == d.full || leaves_to_root[at(f)] != 0) return;
  // Couplings with the boundary are of first order in what keeps rows from depending.
  constexpr double round_off_of_couplings = 1e-12;
  const double uncertain = uncertain_entry(), coupling = std::max(round_off_of_couplings, uncertain);
  FrontMatrix matrix = d.matrix();
  d.dependent = move_negligible_last(matrix, d.pivots, {std::max(options.rank_tolerance, uncertain), coupling},
                                     is_constraint.get());
  // The root takes singular values of all that remains if some of it is not negligible.
  if (f + 1 == tree.num_fronts() && d.num_delayed() > 0) d.dependent = 0;
}

/// Right null vectors of all rows decided in fronts. False if a front's rows do not count as dependent: they are then
/// left to the root, and the matrix must be factored once more.
bool Hierarchical::State::find_local_null_vectors() {
  NullSpace& s = null_space;
  s.local_right.clear();
  s.local_left.clear();
  s.has_left = false;
  s.dependent_fronts.clear();
  for (tree::FrontId f = 0; f < tree.num_fronts(); ++f)
    if (is_scalar(f) && data(f).dependent > 0) s.dependent_fronts.push_back(f);
  if (s.dependent_fronts.empty()) return true;
  bool holds = true;
  const auto leave_to_root = [&](tree::FrontId f) {
    // All fronts above delay them too. Fronts elsewhere are not affected, so their decisions hold again.
    for (; f != tree::none; f = front(f).parent) leaves_to_root[at(f)] = 1;
    holds = false;
  };
  for (const tree::FrontId f : s.dependent_fronts)
    if (!add_local_vectors(f, NullSide::right)) leave_to_root(f);
  if (holds && !s.local_right.factor())  // vectors of nested fronts that nearly agree
    for (const tree::FrontId f : s.dependent_fronts) leave_to_root(f);
  s.took_vectors = true;  // right-hand sides are made consistent before they are condensed
  return holds;
}

/// Left null vectors, when a right-hand side is given.
void Hierarchical::State::find_local_left_vectors() {
  NullSpace& s = null_space;
  if (s.has_left) return;
  s.has_left = true;
  for (const tree::FrontId f : s.dependent_fronts) add_local_vectors(f, NullSide::left);
  s.local_left.factor();
}

bool Hierarchical::State::add_local_vectors(tree::FrontId f, NullSide side) {
  NullSpace& s = null_space;
  NullVectors& vectors = side == NullSide::right ? s.local_right : s.local_left;
  s.rows.resize(tree.num_unknowns());
  s.forces.resize(tree.num_unknowns());
  s.group_of_front.resize(at(tree.num_fronts()));
  const FrontData& d = data(f);
  bool holds = true;
  const auto first_group = static_cast<int>(vectors.groups().size());
  for (int first = d.full - d.dependent; first < d.full; first += most) {
    const int count = std::min(most, d.full - first);
    spread_null_vectors(f, first, count, side);
    if (side == NullSide::right) holds = holds && are_dependent_rows(count);
    // Vectors found before at the fronts passed: only these may have entries at the same unknowns.
    s.overlapping.clear();
    for (const tree::FrontId g : s.passed) {
      if (!is_scalar(g) || data(g).dependent == 0) continue;
      const int begin = g == f ? first_group : s.group_of_front[at(g)];
      for (int k = begin; k < static_cast<int>(vectors.groups().size()) && vectors.groups()[at(k)].front == g; ++k)
        s.overlapping.push_back(k);
    }
    const std::vector<double>& scale = side == NullSide::right ? scales.column : scales.row;
    for (std::size_t k = 0; k < s.rows.unknowns().size(); ++k)
      for (int v = 0; v < count; ++v) s.rows.values()[k * most + at(v)] /= scale[at(s.rows.unknowns()[k])];
    vectors.add(f, count, s.rows, side == NullSide::right ? scales.weight.data() : nullptr, s.overlapping);
  }
  s.group_of_front[at(f)] = first_group;
  return holds;
}

/// Vectors (unscaled) whose entry is 1 (scaled) in one of the front's remaining columns, or rows, from `first` on, and
/// 0 in the others and outside of the front's subtree: from the front down as far as they have entries.
void Hierarchical::State::spread_null_vectors(tree::FrontId top, int first, int count, NullSide side) {
  NullSpace& s = null_space;
  const std::vector<double>& scale = side == NullSide::right ? scales.column : scales.row;
  s.rows.clear();
  s.passed.clear();
  s.largest.fill(1.0);
  for (int v = 0; v < count; ++v) {
    const int u = side == NullSide::right ? data(top).columns[first + v] : data(top).rows[first + v];
    s.rows.at(u)[v] = scale[at(u)];
  }
  s.waiting.assign(1, top);
  while (!s.waiting.empty()) {
    const tree::FrontId f = s.waiting.back();
    s.waiting.pop_back();
    s.passed.push_back(f);
    substitute_null_vectors(f, count, side);
    for (const tree::FrontId c : tree.children(front(f))) {
      const auto boundary = tree.boundary_blocks(front(c));
      bool has_entries = std::any_of(boundary.begin(), boundary.end(), [&](int b) {
        for (auto u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u)
          if (s.rows.find(static_cast<int>(u)) != nullptr) return true;
        return false;
      });
      if (!has_entries && is_scalar(c) && data(c).num_delayed() > 0) {
        const FrontData& d = data(c);
        const int* delayed = side == NullSide::right ? d.columns : d.rows;
        for (int i = d.pivots; i < d.pivots + d.num_delayed(); ++i) has_entries |= s.rows.find(delayed[i]) != nullptr;
      }
      if (has_entries) s.waiting.push_back(c);
    }
  }
}

/// The entries of the unknowns that a front has eliminated, from those of its boundary and remaining unknowns.
void Hierarchical::State::substitute_null_vectors(tree::FrontId f, int count, NullSide side) {
  NullSpace& s = null_space;
  const bool is_right = side == NullSide::right;
  const std::vector<double>& scale = is_right ? scales.column : scales.row;
  const auto take = [&](std::size_t u, double factor, double* to, std::size_t step) {
    const double* row = s.rows.find(static_cast<int>(u));
    for (std::size_t v = 0; v < at(count); ++v) to[v * step] = row == nullptr ? 0.0 : row[v] * factor;
  };
  const auto put = [&](std::size_t u, double factor, const double* from, std::size_t step) {
    const double inverse = 1.0 / scale[u];  // a power of two
    double* row = nullptr;
    for (std::size_t v = 0; v < at(count); ++v) {
      const double value = from[v * step] * factor, size = std::abs(value) * inverse;
      if (!(size > round_off * s.largest[v])) continue;
      s.largest[v] = std::max(s.largest[v], size);
      if (row == nullptr) row = s.rows.at(static_cast<int>(u));
      row[v] = value;
    }
  };
  if (!is_scalar(f)) {
    const int index = lanes.lane_front[at(f)], lane = lanes.lane[at(f)];
    const LaneFront& packed = lanes.fronts[at(index)];
    const std::size_t step = at(packed.size()) * lanes_wide;
    s.values.assign(step * at(count), 0.0);
    double* z = s.values.data();
    for_boundary(f, [&](int i, std::size_t u) { take(u, 1.0, z + (packed.eliminated + i) * lanes_wide + lane, step); });
    for (std::size_t v = 0; v < at(count); ++v)
      (is_right ? (packed.is_symmetric ? backward_lanes_symmetric : backward_lanes) : backward_left_lanes)(
          factor_of(packed), packed.size(), packed.eliminated, z + v * step);
    for (int k = 0; k < packed.eliminated; ++k) {
      const int u = lanes.unknowns[at(packed.unknown + k * lanes_wide + lane)];
      if (u >= 0) put(at(u), 1.0, z + k * lanes_wide + lane, step);
    }
    return;
  }
  FrontData& d = data(f);
  const int* unknowns = is_right ? d.columns : d.rows;
  const std::size_t step = at(d.size);
  s.values.assign(step * at(count), 0.0);
  double* z = s.values.data();
  for (int i = d.pivots; i < d.full; ++i) take(at(unknowns[i]), 1.0 / scale[at(unknowns[i])], z + i, step);
  for_boundary(f, [&](int i, std::size_t u) { take(u, 1.0 / scale[u], z + d.full + i, step); });
  for (std::size_t v = 0; v < at(count); ++v)
    (is_right ? static_cast<void (*)(const FrontMatrix&, int, double*)>(substitute_backward)
              : static_cast<void (*)(const FrontMatrix&, int, double*)>(substitute_backward_left))(d.matrix(), d.pivots,
                                                                                                   z + v * step);
  for (int i = 0; i < d.pivots; ++i) put(at(unknowns[i]), scale[at(unknowns[i])], z + i, step);
}

/// Whether the present right vectors are multipliers alone whose constraint forces cancel at every node, as in
/// decide_rank(). Their combinations are at least as long as their coefficients, since each has an entry 1 of its own.
bool Hierarchical::State::are_dependent_rows(int count) {
  NullSpace& s = null_space;
  double motion = 0.0;
  for (std::size_t k = 0; k < s.rows.unknowns().size(); ++k) {
    const auto u = at(s.rows.unknowns()[k]);
    for (int v = 0; v < count && !is_constraint[u]; ++v)
      motion += std::pow(s.rows.values()[k * most + at(v)] / scales.column[u], 2);
  }
  if (!(std::sqrt(motion) <= options.null_motion_tolerance)) return false;
  // Elements of multipliers with entries are assembled in the fronts passed.
  s.forces.clear();
  for (const tree::FrontId f : s.passed)
    for (int p = front(f).element_begin; p < front(f).element_end; ++p)
      add_constraint_forces(tree.element_order[at(p)], count);
  std::array<double, most> largest{};
  const std::span<const double> forces = s.forces.values();
  for (std::size_t k = 0; k < s.forces.unknowns().size(); ++k)
    for (std::size_t v = 0; v < at(count); ++v) largest[v] = std::max(largest[v], forces[k * 2 * most + most + v]);
  for (std::size_t k = 0; k < s.forces.unknowns().size(); ++k)
    for (std::size_t v = 0; v < at(count); ++v) {
      const double sum = forces[k * 2 * most + v], magnitude = forces[k * 2 * most + most + v];
      if (!(std::abs(sum) <= passing_force * std::max(magnitude, insignificant_force * largest[v]))) return false;
      if (options.data_precision > 0.0 && !(std::abs(sum) <= units_of_precision * options.data_precision * largest[v]))
        return false;
    }
  return true;
}

/// Adds G^T y and |G|^T |y| of an element, y the present right vectors.
void Hierarchical::State::add_constraint_forces(int e, int count) {
  NullSpace& s = null_space;
  const ConstElementView a = elements.view(e);
  const std::int64_t n = elements.size_of(e);
  const auto for_unknowns = [&](auto&& visit) {  // visit(row of the element, unknown)
    std::int64_t k = 0;
    for (int p = 0; p < elements.num_blocks_of(e); ++p) {
      const auto block = at(elements.blocks_of(e)[p]);
      for (auto u = tree.unknown_begin[block]; u < tree.unknown_begin[block + 1]; ++u) visit(k++, static_cast<int>(u));
    }
  };
  s.columns_with_entries.clear();
  for_unknowns([&](std::int64_t j, int u) {
    const double* y = is_constraint[at(u)] ? s.rows.find(u) : nullptr;
    if (y != nullptr) s.columns_with_entries.emplace_back(j, y);
  });
  if (s.columns_with_entries.empty()) return;
  for_unknowns([&](std::int64_t i, int to) {
    if (is_constraint[at(to)]) return;
    double* sum = s.forces.at(to);
    for (const auto& [j, y] : s.columns_with_entries) {
      const double entry = a[i * n + j];
      for (int v = 0; v < count; ++v) {
        sum[v] += entry * y[v];
        sum[most + v] += std::abs(entry * y[v]);
      }
    }
  });
}

/// residual += E x, E the entries that were taken to be zero in the fronts. Returns the largest |E x|, scaled.
double Hierarchical::State::add_negligible_part() {
  double largest = 0.0;
  std::vector<int>&columns = null_space.remaining_columns, &rows = null_space.remaining_rows;
  std::vector<double>& values = null_space.remaining_values;  // x, scaled
  for (const tree::FrontId f : null_space.dependent_fronts) {
    const FrontData& d = data(f);
    const FrontParts parts(d.matrix());
    columns.assign(d.columns + d.pivots, d.columns + d.full);
    rows.assign(d.rows + d.pivots, d.rows + d.full);
    for_boundary(f, [&](int, std::size_t u) {
      columns.push_back(static_cast<int>(u));
      rows.push_back(static_cast<int>(u));
    });
    values.clear();
    for (const int u : columns) values.push_back(x[u] / scales.column[at(u)]);
    // Of what remains, unknowns [first, full) are dependent.
    const int m = d.size - d.pivots, full = d.full - d.pivots, first = full - d.dependent;
    const auto entry = [&](int i, int j) {
      return i < full ? parts.top(d.pivots + j)[d.pivots + i] : parts.bottom(d.pivots + j)[i - full];
    };
    const auto add = [&](int i, double part) {
      residual[at(rows[at(i)])] += part / scales.row[at(rows[at(i)])];
      largest = std::max(largest, std::abs(part));
    };
    for (int k = first; k < full; ++k) {
      double sum = 0.0;  // of row k; symmetric: only the lower triangle is stored
      for (int j = 0; j < m; ++j) sum += (d.is_symmetric() && j > k ? entry(j, k) : entry(k, j)) * values[at(j)];
      add(k, sum);
      for (int i = 0; i < first; ++i) add(i, (d.is_symmetric() ? entry(k, i) : entry(i, k)) * values[at(k)]);
      for (int i = full; i < m; ++i) add(i, entry(i, k) * values[at(k)]);
    }
  }
  return largest;
}

}  // namespace bough::solve
