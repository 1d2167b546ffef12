/// Forward substitution on the way up, back-substitution on the way down.
#include <algorithm>
#include <cmath>

#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {
std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }
}  // namespace

void Hierarchical::State::forward_front(tree::FrontId f) {
  const tree::Front& shape = front(f);
  FrontData& d = data(f);
  const bool is_enlarged = d.delayed_in > 0;
  double* gathered = is_enlarged ? d.vector + d.size : scratch_pool.data() + vector_begin[at(f)];
  const int* own = own_unknowns.data() + index_begin[at(f)] / 3;
  for (int i = 0; i < d.delayed_in; ++i) gathered[i] = 0.0;
  for (int i = 0; i < shape.num_eliminated; ++i) {
    const std::size_t u = at(own[i]);
    gathered[d.delayed_in + i] = scales.row[u] * visit_rhs[u];
  }
  std::fill(gathered + d.full, gathered + d.size, 0.0);
  int delayed = 0;
  for (tree::FrontId child : tree.children(shape)) {
    const FrontData& c = data(child);
    for (int i = 0; i < c.num_delayed(); ++i) gathered[delayed + i] += c.vector[c.pivots + i];
    delayed += c.num_delayed();
    for (std::int64_t r = run_begin[at(child)]; r < run_begin[at(child) + 1]; ++r) {
      const Run& run = runs[at(r)];
      double* to = gathered + d.delayed_in + run.to;
      const double* from = c.vector + c.full + run.from;
      for (int i = 0; i < run.length; ++i) to[i] += from[i];
    }
  }
  for (int i = 0; i < d.full; ++i) d.vector[i] = gathered[d.row_from[i]];
  std::copy(gathered + d.full, gathered + d.size, d.vector + d.full);
  substitute_forward(d.a, d.size, d.pivots, d.vector);
}

void Hierarchical::State::backward_front(tree::FrontId f) {
  const tree::Front& shape = front(f);
  FrontData& d = data(f);
  double* x = d.delayed_in > 0 ? d.vector + d.size : scratch_pool.data() + vector_begin[at(f)];
  std::copy(d.vector, d.vector + d.pivots, x);
  for (int i = d.pivots; i < d.full; ++i) x[i] = x_scaled[at(d.columns[i])];
  double* xb = x + d.full;
  for (int b : tree.boundary_blocks(shape)) {
    const std::int64_t begin = tree.unknown_begin[at(b)], end = tree.unknown_begin[at(b) + 1];
    xb = std::copy(x_scaled.data() + begin, x_scaled.data() + end, xb);
  }
  substitute_backward(d.a, d.size, d.pivots, x);
  for (int i = 0; i < d.pivots; ++i) x_scaled[at(d.columns[i])] = x[i];
}

/// x_scaled = scaled solution of A x = b; unknowns left over at the root (dependent rows) are zero, then multipliers are made least.
void Hierarchical::State::solve_scaled(const tree::Walker& walker, const double* b) {
  visit_rhs = b;
  auto forward = [this](tree::SubdomainId s) {
    const tree::Subdomain& sub = tree.subdomains[at(s)];
    for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f) forward_front(f);
    if (options.elimination == Elimination::plain && s != tree.root()) correct_forward(s);
  };
  walker.walk_up(tree, tree::make_visit(forward));
  const FrontData& root = fronts.back();
  for (int i = root.pivots; i < root.full; ++i) x_scaled[at(root.columns[i])] = 0.0;
  auto backward = [this](tree::SubdomainId s) {
    const tree::Subdomain& sub = tree.subdomains[at(s)];
    for (tree::FrontId f = sub.front_end; f-- > sub.front_begin;) backward_front(f);
  };
  walker.walk_down(tree, tree::make_visit(backward));
  if (null_space.dimension > 0) project_multipliers();
}

void Hierarchical::State::eval_growth(const double* b, SolveReport& report) const {
  double rhs_size = 0.0, size = 0.0;
  std::size_t largest = 0;
  for (std::size_t i = 0; i < x_scaled.size(); ++i) {
    rhs_size = std::max(rhs_size, std::abs(scales.row[i] * b[i]));
    if (std::abs(x_scaled[i]) <= size) continue;
    size = std::abs(x_scaled[i]);
    largest = i;
  }
  if (rhs_size == 0.0 || size == 0.0) return;
  report.growth = size / rhs_size;
  const auto next =
      std::upper_bound(tree.unknown_begin.begin(), tree.unknown_begin.end(), static_cast<std::int64_t>(largest));
  report.growth_block = static_cast<int>(next - tree.unknown_begin.begin()) - 1;
}

}  // namespace bough::solve
