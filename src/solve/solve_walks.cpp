/// Forward substitution on the way up, back-substitution on the way down.
#include <algorithm>
#include <cmath>

#include "bough/blocks/at.hpp"
#include "dense_tiles.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

void Hierarchical::State::forward_front(tree::FrontId f) {
  FrontData& d = data(f);
  if (d.rows_in_order) {
    gather_rhs(f, d.vector);
  } else {
    with_vector(d, [&](double* gathered) {
      gather_rhs(f, gathered);
      for (int i = 0; i < d.full; ++i) d.vector[i] = gathered[d.row_from[i]];
      std::copy(gathered + d.full, gathered + d.size, d.vector + d.full);
    });
  }
  substitute_forward(d.matrix(), d.pivots, d.vector);
}

/// Prefetches what the substitutions of a front on the scalar path read. Most fronts are small: without it a
/// substitution waits for memory longer than it computes. Within a task, fronts are visited in order on the way up, and
/// in reverse order on the way down.
void Hierarchical::State::prefetch_front(tree::FrontId f) const {
  static constexpr std::int64_t most_packs = 256;
  const auto fetch = [](const void* first, std::int64_t doubles) {
    prefetch_packs(static_cast<const double*>(first),
                   static_cast<int>(std::min((doubles + lanes_wide - 1) / lanes_wide, most_packs)));
  };
  const FrontData& d = data(f);
  constexpr std::int64_t neighbour = sizeof(FrontData) / sizeof(double) + lanes_wide - 1;
  if (f > 0) fetch(&d - 1, neighbour);
  if (f + 1 < tree.num_fronts()) fetch(&d + 1, neighbour);
  fetch(d.a, static_cast<std::int64_t>(d.lda) * d.pivots);
  fetch(d.vector, d.size);
  fetch(d.columns, d.full);
}

/// Its right-hand side and the condensed parts of the children, with rows in the order of assembly.
void Hierarchical::State::gather_rhs(tree::FrontId f, double* gathered) {
  const tree::Front& shape = front(f);
  const FrontData& d = data(f);
  const int* own = row_unknowns.data() + row_begin[at(f)];
  for (int i = 0; i < d.delayed_in; ++i) gathered[i] = 0.0;
  for (int i = 0; i < shape.num_eliminated; ++i) {
    const std::size_t u = at(own[i]);
    gathered[d.delayed_in + i] = scales.row[u] * visit_rhs[u];
  }
  std::fill(gathered + d.full, gathered + d.size, 0.0);
  int delayed = 0;
  for (tree::FrontId child : tree.children(shape)) {
    if (!is_scalar(child)) {
      add_lane_vector(child, gathered, d);
      continue;
    }
    const FrontData& c = data(child);
    for (int i = 0; i < c.num_delayed(); ++i) gathered[delayed + i] += c.vector[c.pivots + i];
    delayed += c.num_delayed();
    for (std::int64_t r = run_begin[at(child)]; r < run_begin[at(child) + 1]; ++r) {
      const Run& run = runs[at(r)];
      double* to = gathered + d.delayed_in + run.to;
      const double* from = c.vector + c.full + run.from;
      tiles::add_to(run.length, from, to);
    }
  }
}

/// The solution at the boundary of a front, scaled: rows of its parent, whose vector has them in order unless columns
/// were exchanged.
void Hierarchical::State::gather_boundary(tree::FrontId f, double* boundary) const {
  const tree::FrontId parent = front(f).parent;
  if (parent == tree::none || !is_scalar(parent) || !data(parent).columns_in_order)
    return for_boundary(f, [&](int i, std::size_t u) { boundary[i] = x[u] * inverse_column[u]; });
  const double* from = data(parent).vector + data(parent).delayed_in;
  for (std::int64_t r = run_begin[at(f)]; r < run_begin[at(f) + 1]; ++r)
    std::copy_n(from + runs[at(r)].to, runs[at(r)].length, boundary + runs[at(r)].from);
}

/// In place of the condensed right-hand side, which nobody reads any more.
void Hierarchical::State::backward_front(tree::FrontId f) {
  FrontData& d = data(f);
  double* y = d.vector;
  gather_boundary(f, y + d.full);
  for (int i = d.full - d.dependent; i < d.full; ++i) x[at(d.columns[i])] = 0.0;
  for (int i = d.pivots; i < d.full; ++i) y[i] = x[at(d.columns[i])] * inverse_column[at(d.columns[i])];
  substitute_backward(d.matrix(), d.pivots, y);
  for (int i = 0; i < d.pivots; ++i) x[at(d.columns[i])] = scales.column[at(d.columns[i])] * y[i];
}

/// x = solution of A x = b, which may be the same array. Remaining unknowns of the root (dependent rows) are zero at
/// first; then the multipliers of least norm are computed.
void Hierarchical::State::solve_into_x(const tree::Walker& walker, const double* b) {
  visit_rhs = b;
  is_condensed = false;
  auto forward = [this](int group) { forward_group(group); };
  walker.walk_up(lanes.walk, tree::make_visit(forward, tree::Work::forward));
  back_substitute(walker);
}

/// after: runs in the same visits. Precondition: no rows are dependent, or there is none.
void Hierarchical::State::back_substitute(const tree::Walker& walker, const VisitWork& after) {
  const FrontData& root = fronts.back();
  for (int i = root.pivots; i < root.full; ++i) x[at(root.columns[i])] = 0.0;
  mark = walker.mark;
  auto backward = [this, &after](int group) {
    backward_group(group);
    mark(tree::Stage::substitute);
    if (after) after(group);
  };
  walker.walk_down(lanes.walk, tree::make_visit(backward, tree::Work::backward));
  if (null_space.deficiency() > 0) project_multipliers();
}

/// residual = b - A x of the last solution, and its size.
ElementStore::Errors Hierarchical::State::eval_residual(const tree::Walker& walker, const double* b,
                                                        SolveReport& report) {
  visit_rhs = b;
  auto visit = [this](int group) { residual_group(group); };
  walker.walk_up(lanes.walk, tree::make_visit(visit, tree::Work::residual));
  SolutionSizes most;
  for (const SolutionSizes& s : sizes) {
    most.residual = larger(most.residual, s.residual);
    most.rhs = larger(most.rhs, s.rhs);
    most.x = larger(most.x, s.x);
  }
  ElementStore::Errors errors;
  errors.finite = std::isfinite(most.residual) && std::isfinite(most.x);
  errors.size = norm * most.x + most.rhs;
  errors.set_normwise(most.residual);
  set_growth(most.x, most.rhs, report);
  return errors;
}

void Hierarchical::State::set_growth(double x_size, double rhs_size, SolveReport& report) const {
  if (rhs_size == 0.0 || x_size == 0.0) return;
  report.growth = x_size / rhs_size;
  constexpr double suspicious = 1e10;  // below it the largest unknown is not needed
  if (report.growth < suspicious) return;
  std::size_t largest = 0;
  for (std::size_t i = 0; i < residual.size(); ++i)
    if (std::abs(x[i]) / scales.column[i] > std::abs(x[largest]) / scales.column[largest]) largest = i;
  const auto next =
      std::upper_bound(tree.unknown_begin.begin(), tree.unknown_begin.end(), static_cast<std::int64_t>(largest));
  report.growth_block = static_cast<int>(next - tree.unknown_begin.begin()) - 1;
}

}  // namespace bough::solve
