#include "front_storage.hpp"

#include <algorithm>
#include <utility>

#include "bough/blocks/at.hpp"

namespace bough::solve {

namespace {

constexpr int line = 8;       ///< doubles of a cache line
constexpr int alias = 512;    ///< columns with this distance are on the same lines of the cache
constexpr int unpadded = 32;  ///< shorter columns of u are stored without gaps

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

namespace {

/// A front with those of its descendants whose depth has the same parity needs one region, those of the other parity
/// another.
class SchurPlanner {
 public:
  SchurPlanner(const tree::Tree& tree, const std::vector<int>& in_lanes, bool is_symmetric)
      : tree_(tree), schur_(at(tree.num_fronts()), 0), room_(schur_.size(), 0), need_(schur_.size()) {
    for (tree::FrontId f = 0; f < tree.num_fronts(); ++f) {
      if (in_lanes[at(f)] >= 0) continue;
      schur_[at(f)] = FrontShape(front(f).size(), front(f).num_eliminated, false).s;
      room_[at(f)] = FrontShape(front(f).size(), front(f).num_eliminated, is_symmetric).factor_size();
    }
    places_.begin.assign(schur_.size(), 0);
    places_.host.assign(schur_.size(), tree::none);
  }

  SchurPlaces share() {
    for (tree::FrontId f = 0; f < tree_.num_fronts(); ++f) measure(f);  // postorder
    for (tree::FrontId f = tree_.num_fronts(); f-- > 0;) place(f);
    return std::move(places_);
  }

 private:
  struct Place {
    tree::FrontId host = tree::none;
    std::int64_t begin = 0;
  };
  struct Need {
    std::int64_t own = 0, other = 0;  ///< sizes of its region and of that of the other parity
    Place own_place, other_place;
    bool is_hosted = false;  ///< its own region is in the factor of its grandparent
  };

  const tree::Front& front(tree::FrontId f) const { return tree_.fronts[at(f)]; }
  auto children(tree::FrontId f) const { return tree_.children(front(f)); }
  bool is_sequential(tree::FrontId f) const {
    for (tree::FrontId c : children(f))
      if (front(c).subdomain != front(f).subdomain) return false;
    return true;
  }

  /// Places regions of grandchildren in the factor, the largest first: their contents have been read when the factor is
  /// written.
  void host_grandchildren(tree::FrontId f) {
    std::vector<tree::FrontId> grandchildren;
    for (tree::FrontId c : children(f))
      for (tree::FrontId g : children(c)) grandchildren.push_back(g);
    std::stable_sort(grandchildren.begin(), grandchildren.end(),
                     [&](tree::FrontId a, tree::FrontId b) { return need_[at(a)].own > need_[at(b)].own; });
    std::int64_t taken = 0;
    for (tree::FrontId g : grandchildren) {
      Need& need = need_[at(g)];
      if (need.own == 0 || taken + need.own > room_[at(f)]) continue;
      need.is_hosted = true;
      need.own_place = {f, taken};
      taken += need.own;
    }
  }

  /// Calls visit(child, begin of its own region in the region of children) and returns the length of that region.
  template <class Visit>
  std::int64_t for_children(tree::FrontId f, Visit&& visit) const {
    const bool sequential = is_sequential(f);
    std::int64_t size = 0, waiting = 0;
    for (tree::FrontId c : children(f)) {
      visit(c, waiting);
      const Need& need = need_[at(c)];
      if (need.is_hosted) continue;
      size = std::max(size, waiting + need.own);
      waiting += sequential ? schur_[at(c)] : need.own;
    }
    return size;
  }

  std::int64_t region_of_children(tree::FrontId f) const {
    return for_children(f, [](tree::FrontId, std::int64_t) {});
  }

  /// Computes the size of its own region, and of the other region of each child.
  void measure(tree::FrontId f) {
    host_grandchildren(f);
    const bool sequential = is_sequential(f);
    std::int64_t below = 0;
    for (tree::FrontId c : children(f)) {
      const std::int64_t other = need_[at(c)].other =
          region_of_children(c);  // without those in the factor of their grandparent
      below = sequential ? std::max(below, other) : below + other;
    }
    need_[at(f)].own = std::max(schur_[at(f)], below);
  }

  void place(tree::FrontId f) {
    Need& need = need_[at(f)];
    if (front(f).parent == tree::none) {
      need.other = region_of_children(f);
      need.own_place = {tree::none, places_.pool};
      need.other_place = {tree::none, places_.pool + need.own};
      places_.pool += need.own + need.other;
    }
    places_.host[at(f)] = need.own_place.host;
    places_.begin[at(f)] = need.own_place.begin;
    const bool sequential = is_sequential(f);
    Place below = need.own_place;
    for_children(f, [&](tree::FrontId c, std::int64_t begin) {
      Need& child = need_[at(c)];
      if (!child.is_hosted) child.own_place = {need.other_place.host, need.other_place.begin + begin};
      child.other_place = below;
      if (!sequential) below.begin += child.other;
    });
  }

  const tree::Tree& tree_;
  std::vector<std::int64_t> schur_, room_;  ///< by front: sizes of Schur complement and factor
  std::vector<Need> need_;                  ///< by front
  SchurPlaces places_;
};

}  // namespace

SchurPlaces plan_schur(const tree::Tree& tree, const std::vector<int>& in_lanes, bool is_symmetric) {
  return SchurPlanner(tree, in_lanes, is_symmetric).share();
}

}  // namespace bough::solve
