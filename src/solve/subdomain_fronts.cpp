#include "subdomain_fronts.hpp"

#include <algorithm>

#include "bough/blocks/at.hpp"

namespace bough::solve {

SubdomainFronts::SubdomainFronts(const ElementStore& elements, const tree::Tree& tree, bool has_copies)
    : elements_(elements), tree_(tree), fronts_(at(tree.num_fronts())) {
  if (has_copies) find_own_places();
}

void SubdomainFronts::find_own_places() {
  std::vector<int> place(at(tree_.num_unknowns()), -1);
  for (const tree::Subdomain& sub : tree_.subdomains) {
    int count = 0;
    const auto boundary = tree_.boundary_blocks(tree_.fronts[at(sub.top())]);
    for (const int b : boundary)
      for (auto u = tree_.unknown_begin[at(b)]; u < tree_.unknown_begin[at(b) + 1]; ++u) place[at(u)] = count++;
    for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f)
      for (const int b : tree_.boundary_blocks(tree_.fronts[at(f)]))
        for (auto u = tree_.unknown_begin[at(b)]; u < tree_.unknown_begin[at(b) + 1]; ++u)
          fronts_[at(f)].own_place.push_back(place[at(u)]);
    for (const int b : boundary)
      for (auto u = tree_.unknown_begin[at(b)]; u < tree_.unknown_begin[at(b) + 1]; ++u) place[at(u)] = -1;
  }
}

/// Calls add(child, row of this front for each row that the child passes up).
template <class Add>
void SubdomainFronts::for_children(tree::FrontId f, Add&& add) const {
  const tree::Front& shape = tree_.fronts[at(f)];
  const int delayed_in = fronts_[at(f)].full - shape.num_eliminated;
  std::vector<int> place;
  int delayed = 0;
  for (const tree::FrontId c : tree_.children(shape)) {
    const Numbers& child = fronts_[at(c)];
    const tree::Front& child_shape = tree_.fronts[at(c)];
    place.clear();
    for (int i = child.pivots; i < child.full; ++i) place.push_back(delayed++);
    for (auto k = child_shape.block_begin + child_shape.num_eliminated_blocks; k < child_shape.block_end; ++k)
      for (int i = 0; i < elements_.graph().block_size[at(tree_.front_blocks[at(k)])]; ++i)
        place.push_back(delayed_in + tree_.parent_row[at(k)] + i);
    add(child, place);
  }
}

void SubdomainFronts::assemble(tree::FrontId f, const Scales& scales) {
  const tree::Front& shape = tree_.fronts[at(f)];
  Numbers& d = fronts_[at(f)];
  const auto& first = tree_.unknown_begin;
  d.rows.clear();
  d.columns.clear();
  for (const tree::FrontId c : tree_.children(shape)) {
    const Numbers& child = fronts_[at(c)];
    d.rows.insert(d.rows.end(), child.rows.begin() + child.pivots, child.rows.end());
    d.columns.insert(d.columns.end(), child.columns.begin() + child.pivots, child.columns.end());
  }
  const int delayed_in = static_cast<int>(d.rows.size());
  for (const int b : tree_.blocks(shape).first(at(shape.num_eliminated_blocks)))
    for (auto u = first[at(b)]; u < first[at(b) + 1]; ++u) {
      d.rows.push_back(static_cast<int>(u));
      d.columns.push_back(static_cast<int>(u));
    }
  d.full = static_cast<int>(d.rows.size());
  d.size = delayed_in + shape.size();
  d.row_from.resize(at(d.full));
  for (int i = 0; i < d.full; ++i) d.row_from[at(i)] = i;
  d.a.assign(at(d.size) * at(d.size), 0.0);
  d.load.assign(at(d.size), 0.0);
  d.work.assign(at(d.size), 0.0);
  std::vector<int> place, unknown;
  std::vector<double> local;
  for (int p = shape.element_begin; p < shape.element_end; ++p) {
    const int e = tree_.element_order[at(p)];
    place.clear();
    unknown.clear();
    for (int q = 0; q < elements_.num_blocks_of(e); ++q) {
      const int b = elements_.blocks_of(e)[q];
      for (int i = 0; i < elements_.graph().block_size[at(b)]; ++i) {
        place.push_back(delayed_in + tree_.scatter[at(tree_.scatter_begin[at(p)] + q)] + i);
        unknown.push_back(static_cast<int>(first[at(b)]) + i);
      }
    }
    const ConstElementView a = elements_.view(e);
    const std::size_t n = place.size();
    local.resize(n * n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        local[i * n + j] =
            scales.row[at(unknown[i])] * a[static_cast<std::int64_t>(i * n + j)] * scales.column[at(unknown[j])];
    if (change_) change_(e, local);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) d.a[at(place[i]) + at(place[j]) * at(d.size)] += local[i * n + j];
  }
  for_children(f, [&](const Numbers& child, const std::vector<int>& to) {
    for (std::size_t j = 0; j < to.size(); ++j)
      for (std::size_t i = 0; i < to.size(); ++i)
        d.a[at(to[i]) + at(to[j]) * at(d.size)] +=
            child.a[at(child.pivots) + i + (at(child.pivots) + j) * at(child.size)];
  });
}

bool SubdomainFronts::factor(tree::SubdomainId s, const Scales& scales, const PivotRule& rule) {
  const tree::Subdomain& sub = tree_.subdomains[at(s)];
  for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f) {
    assemble(f, scales);
    Numbers& d = fronts_[at(f)];
    FrontMatrix matrix{d.a.data(), d.size, d.full, d.rows.data(), d.columns.data(), d.row_from.data()};
    d.pivots = eliminate_with_threshold(matrix, rule);
    if (d.pivots < 0) {
      d.pivots = 0;
      return false;
    }
  }
  return true;
}

double SubdomainFronts::condensed(tree::SubdomainId s, int i, int j) const {
  const Numbers& d = top(s);
  return d.a[at(d.pivots + i) + at(d.pivots + j) * at(d.size)];
}

double& SubdomainFronts::condensed(tree::SubdomainId s, int i, int j) {
  Numbers& d = top(s);
  return d.a[at(d.pivots + i) + at(d.pivots + j) * at(d.size)];
}

void SubdomainFronts::eliminate_completely(tree::SubdomainId s, int all_but, double least) {
  Numbers& d = top(s);
  FrontMatrix matrix{d.a.data(), d.size, d.full, d.rows.data(), d.columns.data(), d.row_from.data()};
  d.pivots = solve::eliminate_completely(matrix, d.pivots, d.full - all_but, least);
}

double* SubdomainFronts::forward(tree::SubdomainId s, const double* b) {
  const tree::Subdomain& sub = tree_.subdomains[at(s)];
  for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f) {
    Numbers& d = fronts_[at(f)];
    std::fill(d.work.begin(), d.work.end(), 0.0);
    int i = d.full - tree_.fronts[at(f)].num_eliminated;
    for (const int blk : tree_.blocks(tree_.fronts[at(f)]).first(at(tree_.fronts[at(f)].num_eliminated_blocks)))
      for (auto u = tree_.unknown_begin[at(blk)]; u < tree_.unknown_begin[at(blk) + 1]; ++u) d.work[at(i++)] = b[u];
    for_children(f, [&](const Numbers& child, const std::vector<int>& to) {
      for (std::size_t k = 0; k < to.size(); ++k) d.work[at(to[k])] += child.load[at(child.pivots) + k];
    });
    for (int k = 0; k < d.size; ++k) d.load[at(k)] = d.work[at(k < d.full ? d.row_from[at(k)] : k)];
    substitute_forward(d.a.data(), d.size, d.pivots, d.load.data());
  }
  return top(s).load.data() + top(s).pivots;
}

void SubdomainFronts::clear_load(tree::SubdomainId s) {
  const tree::Subdomain& sub = tree_.subdomains[at(s)];
  for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f)
    std::fill(fronts_[at(f)].load.begin(), fronts_[at(f)].load.end(), 0.0);
}

void SubdomainFronts::backward(tree::SubdomainId s, double* x, const double* own) {
  const tree::Subdomain& sub = tree_.subdomains[at(s)];
  for (tree::FrontId f = sub.front_end; f-- > sub.front_begin;) {
    Numbers& d = fronts_[at(f)];
    double* z = d.work.data();
    std::copy(d.load.begin(), d.load.begin() + d.pivots, z);
    for (int i = d.pivots; i < d.full; ++i) z[i] = x[d.columns[at(i)]];
    double* boundary = z + d.full;
    for (const int b : tree_.boundary_blocks(tree_.fronts[at(f)]))
      boundary = std::copy(x + tree_.unknown_begin[at(b)], x + tree_.unknown_begin[at(b) + 1], boundary);
    if (own != nullptr)
      for (std::size_t k = 0; k < d.own_place.size(); ++k)
        if (d.own_place[k] >= 0) z[at(d.full) + k] = own[d.own_place[k]];
    substitute_backward(d.a.data(), d.size, d.pivots, z);
    for (int i = 0; i < d.pivots; ++i) x[d.columns[at(i)]] = z[i];
  }
}

void SubdomainFronts::backward_left(tree::SubdomainId s, double* y) {
  const tree::Subdomain& sub = tree_.subdomains[at(s)];
  for (tree::FrontId f = sub.front_end; f-- > sub.front_begin;) {
    Numbers& d = fronts_[at(f)];
    double* z = d.work.data();
    for (int i = 0; i < d.full; ++i) z[i] = i < d.pivots ? 0.0 : y[d.rows[at(i)]];
    double* boundary = z + d.full;
    for (const int b : tree_.boundary_blocks(tree_.fronts[at(f)]))
      boundary = std::copy(y + tree_.unknown_begin[at(b)], y + tree_.unknown_begin[at(b) + 1], boundary);
    substitute_backward_left(d.a.data(), d.size, d.pivots, z);
    for (int i = 0; i < d.pivots; ++i) y[d.rows[at(i)]] = z[i];
  }
}

std::size_t SubdomainFronts::num_doubles() const {
  std::size_t count = 0;
  for (const Numbers& d : fronts_) count += d.a.capacity() + d.load.capacity() + d.work.capacity();
  return count;
}

}  // namespace bough::solve
