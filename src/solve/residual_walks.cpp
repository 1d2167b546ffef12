/// Residuals of solutions, in the visits of an upward walk.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "bough/blocks/at.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

void Hierarchical::State::residual_group(int index) {
  const LaneGroup& group = lanes.groups[at(index)];
  SolutionSizes& size = sizes[at(index)];
  size = {};
  if (group.in_lanes)
    return with_scratch(index, [&] {
      for (int f = group.front_begin; f < group.front_end; ++f) residual_lane_front(f, size);
    });
  const tree::Subdomain& s = tree.subdomains[at(group.subdomains.front())];
  double most[2] = {0.0, 0.0};
  for (tree::FrontId f = s.front_begin; f < s.front_end; ++f) {
    const auto own = tree.blocks(front(f)).first(at(front(f).num_eliminated_blocks));
    elements.eval_rows(scales, own, x, visit_rhs, residual.data(), most);
    for (int b : own)
      for (std::size_t u = at(tree.unknown_begin[at(b)]); u < at(tree.unknown_begin[at(b) + 1]); ++u) {
        size.x = larger(size.x, std::abs(x[u]) / scales.column[u]);
      }
  }
  size.residual = most[0];
  size.rhs = most[1];
}

/// b - A x in the rows eliminated here; the elements' part in the boundary is passed to the parent, like a condensed
/// right-hand side.
void Hierarchical::State::residual_lane_front(int index, SolutionSizes& most) {
  const LaneFront& f = lanes.fronts[at(index)];
  const int* unknown = lanes.unknowns.data() + f.unknown;
  alignas(64) double v[most_lane_rows * lanes_wide];
  std::memset(v, 0, sizeof(double) * lanes_wide * at(f.size()));
  for (int k = 0; k < f.eliminated * lanes_wide; ++k)
    if (unknown[k] >= 0) v[k] = x[at(unknown[k])];
  for (int l = 0; l < lanes_wide; ++l)
    if (f.front[at(l)] != tree::none)
      for_boundary(f.front[at(l)], [&](int i, std::size_t u) { v[(f.eliminated + i) * lanes_wide + l] = x[u]; });
  double* r = vector_of(f);
  std::fill_n(r, f.size() * lanes_wide, 0.0);
  add_children_vectors(f, r);
  for (int i = f.element_begin; i < f.element_end; ++i) {
    const LaneElement& element = lanes.elements[at(i)];
    const double* values = elements.values() + element.values;
    for (const Run& row : lanes.runs_of(element))
      for (const Run& column : lanes.runs_of(element))
        multiply_block_lanes(values + static_cast<std::int64_t>(row.from * element.size + column.from) * lanes_wide,
                             element.size, row.length, column.length, v + column.to * lanes_wide,
                             r + row.to * lanes_wide);
  }
  const double* scale = lane_scales.row(index);
  for (int k = 0; k < f.eliminated * lanes_wide; ++k) {
    const int u = unknown[k];
    if (u < 0) {
      r[k] = 0.0;
      continue;
    }
    r[k] = visit_rhs[u] - r[k];
    residual[at(u)] = r[k];
    most.rhs = larger(most.rhs, std::abs(visit_rhs[u]) * scale[k]);
  }
  most.residual = larger(most.residual, largest_scaled(r, scale, f.eliminated));
  most.x = larger(most.x, largest_scaled(v, lane_scales.inverse_column(f, index), f.eliminated));
}

}  // namespace bough::solve
