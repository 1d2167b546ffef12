#include "lane_scales.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <string_view>

namespace bough::solve {

namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }
constexpr int wide = lanes_wide;

std::size_t hash_of(const double* values, std::int64_t count) {
  const std::string_view bytes(reinterpret_cast<const char*>(values), at(count) * sizeof(double));
  return std::hash<std::string_view>{}(bytes);
}

/// Of its row and inverse column scales.
std::int64_t size_of(const LaneFront& f) { return static_cast<std::int64_t>(f.size() + f.eliminated) * wide; }

/// Row scales, then inverse column scales of one front.
void fill(const LaneFront& f, const LanePlan& lanes, const tree::Tree& tree, const Scales& scales, double* row) {
  double* column = row + f.size() * wide;
  for (int k = 0; k < f.eliminated * wide; ++k) {
    const int u = lanes.unknowns[at(f.unknown + k)];
    if (u < 0) continue;
    row[k] = scales.row[at(u)];
    column[k] = 1.0 / scales.column[at(u)];
  }
  for (int l = 0; l < wide; ++l) {
    if (f.front[at(l)] == tree::none) continue;
    double* to = row + f.eliminated * wide + l;
    for (const int b : tree.boundary_blocks(tree.fronts[at(f.front[at(l)])]))
      for (auto u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u, to += wide)
        *to = scales.row[at(u)];
  }
}

}  // namespace

LaneScales::LaneScales(const LanePlan& lanes)
    : begin_(lanes.fronts.size(), 0), table_(std::bit_ceil(2 * lanes.fronts.size() + 1), -1) {
  std::int64_t most = 0;
  for (const LaneFront& f : lanes.fronts) most += size_of(f);
  values_.reserve(at(most));
}

void LaneScales::set(const LanePlan& lanes, const tree::Tree& tree, const Scales& scales) {
  std::fill(table_.begin(), table_.end(), -1);
  values_.clear();
  for (std::size_t front = 0; front < lanes.fronts.size(); ++front) {
    const std::int64_t first = static_cast<std::int64_t>(values_.size()), count = size_of(lanes.fronts[front]);
    values_.resize(at(first + count), 1.0);
    fill(lanes.fronts[front], lanes, tree, scales, values_.data() + first);
    begin_[front] = first;
    std::size_t slot = hash_of(values_.data() + first, count) & (table_.size() - 1);
    for (; table_[slot] >= 0; slot = (slot + 1) & (table_.size() - 1)) {
      const auto other = at(table_[slot]);
      if (size_of(lanes.fronts[other]) != count || lanes.fronts[other].eliminated != lanes.fronts[front].eliminated ||
          std::memcmp(values_.data() + begin_[other], values_.data() + first, at(count) * sizeof(double)) != 0)
        continue;
      begin_[front] = begin_[other];
      values_.resize(at(first));
      break;
    }
    if (begin_[front] == first) table_[slot] = static_cast<int>(front);
  }
}

std::int64_t LaneScales::memory_bytes() const {
  return static_cast<std::int64_t>(values_.size() * sizeof(double) + begin_.size() * sizeof(std::int64_t) +
                                   table_.size() * sizeof(int));
}

}  // namespace bough::solve
