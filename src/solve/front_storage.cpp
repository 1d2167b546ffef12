#include "front_storage.hpp"

#include <algorithm>
#include <array>

namespace bough::solve {

namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

constexpr int line = 8;       ///< doubles of a cache line
constexpr int alias = 512;    ///< columns this far apart fall on the same lines of the cache
constexpr int unpadded = 32;  ///< shorter columns of u stand without gaps

int leading_dimension(int rows) {
  const int padded = (rows + line - 1) / line * line;
  return padded > 0 && padded % alias == 0 ? padded + line : padded;
}

}  // namespace

FrontShape::FrontShape(int size, int full, bool symmetric) : is_symmetric(symmetric) {
  const int boundary = size - full;
  lda = std::max(leading_dimension(size), 1);
  ldu = full < unpadded ? full : leading_dimension(full);
  lds = leading_dimension(boundary);
  const auto to_line = [](std::int64_t n) { return (n + line - 1) / line * line; };
  a = static_cast<std::int64_t>(lda) * full;
  d = is_symmetric ? to_line(2 * full) : 0;
  u = is_symmetric ? 0 : to_line(static_cast<std::int64_t>(ldu) * boundary);
  s = static_cast<std::int64_t>(lds) * boundary;
}

std::int64_t plan_schur(const tree::Tree& tree, const std::vector<int>& in_lanes, bool keep_all,
                        std::vector<std::int64_t>& begin) {
  const std::size_t count = at(tree.num_fronts());
  const auto schur = [&](tree::FrontId f) {
    const tree::Front& front = tree.fronts[at(f)];
    return in_lanes[at(f)] >= 0 ? 0 : FrontShape(front.size(), front.num_eliminated, false).s;
  };
  begin.assign(count, 0);
  std::int64_t total = 0;
  if (keep_all) {
    for (tree::FrontId f = 0; f < tree.num_fronts(); ++f) {
      begin[at(f)] = total;
      total += schur(f);
    }
    return total;
  }
  // By front: [its own place and those of its descendants of the same parity of depth, those of the other parity]
  std::vector<std::array<std::int64_t, 2>> size(count), offset(count);
  const auto is_sequential = [&](tree::FrontId f) {
    for (tree::FrontId c : tree.children(tree.fronts[at(f)]))
      if (tree.fronts[at(c)].subdomain != tree.fronts[at(f)].subdomain) return false;
    return true;
  };
  for (tree::FrontId f = 0; f < tree.num_fronts(); ++f) {  // postorder
    std::int64_t same = 0, other = 0, waiting = 0;
    const bool sequential = is_sequential(f);
    for (tree::FrontId c : tree.children(tree.fronts[at(f)])) {
      const auto [own, below] = size[at(c)];
      if (sequential) {
        same = std::max(same, below);
        other = std::max(other, waiting + own);
        waiting += schur(c);
      } else {
        same += below;
        other += own;
      }
    }
    size[at(f)] = {std::max(same, schur(f)), other};
  }
  for (tree::FrontId f = tree.num_fronts(); f-- > 0;) {
    if (tree.fronts[at(f)].parent == tree::none) {
      offset[at(f)] = {total, total + size[at(f)][0]};
      total += size[at(f)][0] + size[at(f)][1];
    }
    begin[at(f)] = offset[at(f)][0];
    auto [same, other] = offset[at(f)];
    const bool sequential = is_sequential(f);
    for (tree::FrontId c : tree.children(tree.fronts[at(f)])) {
      offset[at(c)] = {other, same};
      other += sequential ? schur(c) : size[at(c)][0];
      same += sequential ? 0 : size[at(c)][1];
    }
  }
  return total;
}

}  // namespace bough::solve
