#include "lane_scales.hpp"

#include <algorithm>

#include "bough/blocks/at.hpp"

namespace bough::solve {

namespace {

/// Size of its row and inverse column scales.
std::int64_t size_of(const LaneFront& f) { return static_cast<std::int64_t>(f.size() + f.eliminated) * lanes_wide; }

/// Row scales, then inverse column scales of one front.
void fill(const LaneFront& f, const LanePlan& lanes, const tree::Tree& tree, const Scales& scales, double* row) {
  double* column = row + f.size() * lanes_wide;
  for (int k = 0; k < f.eliminated * lanes_wide; ++k) {
    const int u = lanes.unknowns[at(f.unknown + k)];
    if (u < 0) continue;
    row[k] = scales.row[at(u)];
    column[k] = 1.0 / scales.column[at(u)];
  }
  for (int l = 0; l < lanes_wide; ++l) {
    if (f.front[at(l)] == tree::none) continue;
    double* to = row + f.eliminated * lanes_wide + l;
    for (const int b : tree.boundary_blocks(tree.fronts[at(f.front[at(l)])]))
      for (auto u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u, to += lanes_wide)
        *to = scales.row[at(u)];
  }
}

}  // namespace

LaneScales::LaneScales(const LanePlan& lanes) : begin_(1, 0) {
  for (const LaneFront& f : lanes.fronts) begin_.push_back(begin_.back() + size_of(f));
  values_.resize(at(begin_.back()));
}

void LaneScales::set(const LanePlan& lanes, const tree::Tree& tree, const Scales& scales) {
  std::fill(values_.begin(), values_.end(), 1.0);
  for (std::size_t f = 0; f < lanes.fronts.size(); ++f)
    fill(lanes.fronts[f], lanes, tree, scales, values_.data() + begin_[f]);
}

}  // namespace bough::solve
