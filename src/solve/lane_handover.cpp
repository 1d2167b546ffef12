/// Transfers between lanes and the scalar path: fronts that leave a lane, Schur complements, right-hand sides and
/// solutions.
#include <array>

#include "bough/blocks/at.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

/// Lanes with delayed unknowns, or with a failure below, which can be processed only on the scalar path.
LaneSet Hierarchical::State::lanes_to_leave(const LaneFront& f) const {
  unsigned leave = 0;
  for (int c = f.child_begin; c < f.child_end; ++c) {
    const LaneChild& child = lanes.children[at(c)];
    if (scalar_lanes[at(child.front)] == 0) continue;
    for (int l = 0; l < lanes_wide; ++l) {
      const int lane = child.from[at(l)];
      if (lane < 0 || (scalar_lanes[at(child.front)] >> lane & 1) == 0) continue;
      const FrontData& d = data(lanes.fronts[at(child.front)].front[at(lane)]);
      if (d.num_delayed() > 0 || d.failed) leave |= 1u << l;
    }
  }
  return static_cast<LaneSet>(leave);
}

/// Scalar elimination with pivoting for one lane. Its Schur complement returns to the lane if no unknown is delayed.
void Hierarchical::State::factor_lane_alone(int index, int lane) {
  const LaneFront& f = lanes.fronts[at(index)];
  const tree::FrontId id = f.front[at(lane)];
  size_front(id);
  assemble_front(id);
  eliminate_front(id);
  const FrontData& d = data(id);
  if (d.failed || d.num_delayed() > 0) return;
  double* schur = schur_of(f);
  for_boundary(id, [&](int j, std::size_t column) {
    for_boundary(id, [&](int i, std::size_t row) {
      if (d.is_symmetric() && i < j) return;
      schur[(static_cast<std::int64_t>(j) * f.boundary + i) * lanes_wide + lane] =
          d.s[static_cast<std::int64_t>(j) * d.lds + i] / (scales.row[row] * scales.column[column]);
    });
  });
}

/// Adds the condensed right-hand side of a lane to a front on the scalar path, scaled.
void Hierarchical::State::add_lane_vector(tree::FrontId child, double* gathered, const FrontData& parent) {
  const LaneFront& f = lanes.fronts[at(lanes.lane_front[at(child)])];
  const double* g = vector_of(f) + f.eliminated * lanes_wide + lanes.lane[at(child)];
  std::int64_t r = run_begin[at(child)];
  for_boundary(child, [&](int i, std::size_t u) {
    while (i >= runs[at(r)].from + runs[at(r)].length) ++r;
    gathered[parent.delayed_in + runs[at(r)].to + i - runs[at(r)].from] += scales.row[u] * g[i * lanes_wide];
  });
}

/// The solution at a front's boundary (and its own unknowns) into its lane.
void Hierarchical::State::fill_lane_vector(tree::FrontId id, bool with_own) {
  const LaneFront& f = lanes.fronts[at(lanes.lane_front[at(id)])];
  const int lane = lanes.lane[at(id)];
  double* v = vector_of(f);
  for_boundary(id, [&](int i, std::size_t u) { v[(f.eliminated + i) * lanes_wide + lane] = x[u]; });
  if (!with_own) return;
  for (int k = 0; k < f.eliminated; ++k) {
    const int u = lanes.unknowns[at(f.unknown + k * lanes_wide + lane)];
    if (u >= 0) v[k * lanes_wide + lane] = x[at(u)];
  }
}

/// From a front on the scalar path to its children in lanes.
void Hierarchical::State::hand_down(tree::FrontId f) {
  for (tree::FrontId c : tree.children(front(f)))
    if (lanes.lane_front[at(c)] >= 0) fill_lane_vector(c, false);
}

}  // namespace bough::solve
