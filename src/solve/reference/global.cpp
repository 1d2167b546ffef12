/// Copies and ties of the forms with global multipliers, and the sub-domains between the ties.
#include <algorithm>

#include "bough/blocks/at.hpp"
#include "dual_state.hpp"

namespace bough::solve {

namespace {

/// Pivots of a sub-domain below this, scaled, are not eliminated: directions in which it floats or nearly does.
/// Accepted pivots amplify round-off at most by its inverse; the others are kept with their true matrix, so no accuracy
/// is lost in either case.
constexpr double floating_pivot = 1e-6;
}  // namespace

/// Finds the copies of every boundary block. A block of several leaves is in the interface mesh, or has m - 1 ties to
/// its first copy.
void Dual::State::tear(const blocks::BlockGraph& graph) {
  std::vector<std::vector<int>> leaves_of(at(graph.num_blocks()));
  std::vector<char> is_inside(at(graph.num_blocks()), 0);
  leaf_of_subdomain.assign(at(tree.num_subdomains()), -1);
  for (tree::SubdomainId s = 0; s < tree.num_subdomains(); ++s) {
    const tree::Subdomain& sub = tree.subdomains[at(s)];
    if (!sub.is_leaf()) continue;
    leaf_of_subdomain[at(s)] = static_cast<int>(leaves.size());
    for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f)
      for (const int b : tree.blocks(tree.fronts[at(f)]).first(at(tree.fronts[at(f)].num_eliminated_blocks)))
        is_inside[at(b)] = 1;
    for (const int b : tree.boundary_blocks(tree.fronts[at(sub.top())]))
      leaves_of[at(b)].push_back(static_cast<int>(leaves.size()));
    leaves.emplace_back().id = s;
  }
  const std::vector<char> is_local = choose_local(leaves_of);
  std::vector<int> place(at(tree.num_unknowns()), -1), first_tie(at(graph.num_blocks()), -1);
  copies.assign(at(tree.num_unknowns()), 1.0);
  for (int b = 0; b < graph.num_blocks(); ++b) {
    const auto& owners = leaves_of[at(b)];
    first_tie[at(b)] = num_ties();
    for (std::int64_t u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u) {
      if (is_local[at(b)] != 0 || (owners.empty() && is_inside[at(b)] == 0)) {
        place[at(u)] = static_cast<int>(mesh.size());
        if (owners.empty()) untouched.push_back(place[at(u)]);
        mesh.push_back(static_cast<int>(u));
      } else if (owners.size() > 1) {
        copies[at(u)] = 1.0 / static_cast<double>(owners.size());
      }
    }
    for (std::size_t c = 1; c < owners.size() && is_local[at(b)] == 0; ++c)
      for (std::int64_t u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u)
        ties.push_back({static_cast<int>(u), owners[0], owners[c]});
  }
  for (int l = 0; l < static_cast<int>(leaves.size()); ++l) {
    LeafInterface& leaf = leaves[at(l)];
    for (const int b : tree.boundary_blocks(tree.fronts[at(tree.subdomains[at(leaf.id)].top())])) {
      const int size = graph.block_size[at(b)], others = static_cast<int>(leaves_of[at(b)].size()) - 1;
      for (int i = 0; i < size; ++i) {
        const int u = static_cast<int>(tree.unknown_begin[at(b)]) + i, p = static_cast<int>(leaf.boundary.size());
        leaf.boundary.push_back({u, place[at(u)], leaves_of[at(b)][0] == l});
        for (int c = 0; c < others && place[at(u)] < 0; ++c) {
          const int tie = first_tie[at(b)] + c * size + i;
          if (ties[at(tie)].plus != l && ties[at(tie)].minus != l) continue;
          leaf.ties.emplace_back(tie, ties[at(tie)].plus == l ? 1.0 : -1.0);
          leaf.tie_boundary.push_back(p);
        }
      }
    }
  }
}

/// Condenses the leaf, then eliminates the part of its boundary that holds it and is not in the interface mesh.
void Dual::State::factor_leaf(LeafInterface& leaf) {
  leaf.failed =
      !fronts.factor(leaf.id, scales, {options.pivot_threshold, std::max(options.tiny_pivot, floating_pivot)});
  if (leaf.failed) return;
  const int refused = fronts.num_refused(leaf.id);
  leaf.size = fronts.num_kept(leaf.id);
  leaf.order.clear();
  for (int i = 0; i < refused; ++i) leaf.order.push_back(i);
  for (const bool is_mesh : {false, true}) {
    if (is_mesh) leaf.full = static_cast<int>(leaf.order.size());
    for (std::size_t p = 0; p < leaf.boundary.size(); ++p)
      if ((leaf.boundary[p].coarse >= 0) == is_mesh) leaf.order.push_back(refused + static_cast<int>(p));
  }
  leaf.a.resize(at(leaf.size) * at(leaf.size));
  for (int j = 0; j < leaf.size; ++j)
    for (int i = 0; i < leaf.size; ++i)
      leaf.a[at(i) + at(j) * at(leaf.size)] = fronts.condensed(leaf.id, leaf.order[at(i)], leaf.order[at(j)]);
  for (auto* v : {&leaf.rows, &leaf.columns, &leaf.row_from}) {
    v->resize(at(leaf.full));
    for (int i = 0; i < leaf.full; ++i) (*v)[at(i)] = i;
  }
  for (auto* v : {&leaf.load, &leaf.x, &leaf.work}) v->assign(at(leaf.size), 0.0);
  FrontMatrix front = leaf.front();
  leaf.pivots = eliminate_with_threshold(front, {0.1, leaf.full == leaf.size ? 1e-2 : floating_pivot});
  if (leaf.pivots >= 0 && leaf.full == leaf.size)
    leaf.pivots = eliminate_completely(front, leaf.pivots, leaf.full, floating_pivot);
  leaf.failed = leaf.pivots < 0;
  if (!leaf.failed) eval_responses(leaf);
}

/// H = A^+ at the ties, R and Q: one substitution for each tie and each unknown of w.
void Dual::State::eval_responses(LeafInterface& leaf) {
  const int count = static_cast<int>(leaf.ties.size()), kept = leaf.num_kept(), m = leaf.size;
  leaf.flexibility.resize(count, count);
  leaf.right.resize(count, kept);
  leaf.left.resize(count, kept);
  std::vector<int> local(at(m)), position(at(m)), row_of(at(m));  // kept -> local; local -> column, row after pivoting
  for (int i = 0; i < m; ++i) local[at(leaf.order[at(i)])] = i;
  for (int i = 0; i < m; ++i) {
    position[at(i < leaf.full ? leaf.columns[at(i)] : i)] = i;
    row_of[at(i < leaf.full ? leaf.row_from[at(i)] : i)] = i;
  }
  const int refused = fronts.num_refused(leaf.id);
  leaf.tie_row.resize(at(count));
  leaf.tie_column.resize(at(count));
  for (int t = 0; t < count; ++t) {
    const int unknown = local[at(refused + leaf.tie_boundary[at(t)])];
    leaf.tie_column[at(t)] = position[at(unknown)];
    leaf.tie_row[at(t)] = row_of[at(unknown)];
  }
  double* x = leaf.work.data();
  for (int t = 0; t < count; ++t) {
    std::fill(x, x + m, 0.0);
    x[leaf.tie_row[at(t)]] = 1.0;
    substitute_forward(leaf.a.data(), m, leaf.pivots, x);
    for (int k = 0; k < kept; ++k) leaf.left(t, k) = x[leaf.pivots + k];
    std::fill(x + leaf.pivots, x + m, 0.0);
    substitute_backward(leaf.a.data(), m, leaf.pivots, x);
    for (int s = 0; s < count; ++s) leaf.flexibility(s, t) = x[leaf.tie_column[at(s)]];
  }
  for (int k = 0; k < kept; ++k) {
    std::fill(x, x + m, 0.0);
    x[leaf.pivots + k] = 1.0;
    substitute_backward(leaf.a.data(), m, leaf.pivots, x);
    for (int s = 0; s < count; ++s) leaf.right(s, k) = x[leaf.tie_column[at(s)]];
  }
}

/// The load of the leaf's kept unknowns in local order: the condensed load of its interior, and that of the boundary if
/// this is its first leaf.
void Dual::State::condense_load(LeafInterface& leaf, const double* b) {
  const double* inside = fronts.forward(leaf.id, b);
  const int refused = fronts.num_refused(leaf.id);
  for (int i = 0; i < leaf.size; ++i) {
    const int kept = leaf.order[at(i)];
    leaf.load[at(i)] = inside[kept];
    if (kept < refused) continue;
    const BoundaryUnknown& u = leaf.boundary[at(kept - refused)];
    if (u.is_first) leaf.load[at(i)] += b[u.unknown];
  }
}

/// e and d of one leaf: its load condensed to w, and the effect of the load on the ties.
void Dual::State::add_interface_load(LeafInterface& leaf, Eigen::VectorXd& rhs) {
  double* x = leaf.work.data();
  for (int i = 0; i < leaf.size; ++i) x[i] = leaf.load[at(i < leaf.full ? leaf.row_from[at(i)] : i)];
  substitute_forward(leaf.a.data(), leaf.size, leaf.pivots, x);
  for (int k = 0; k < leaf.num_kept(); ++k) rhs(leaf.coarse[at(k)]) += x[leaf.pivots + k];
  std::fill(x + leaf.pivots, x + leaf.size, 0.0);
  substitute_backward(leaf.a.data(), leaf.size, leaf.pivots, x);
  for (std::size_t t = 0; t < leaf.ties.size(); ++t) {
    const auto [tie, sign] = leaf.ties[t];
    rhs(num_coarse + tie) += tie_scale[at(tie)] * sign * x[leaf.tie_column[t]];
  }
}

/// leaf.x = A^+ (load - B^T l) + R w, local order.
void Dual::State::recover_leaf(LeafInterface& leaf, const Eigen::VectorXd& solution) {
  double* x = leaf.work.data();
  for (int i = 0; i < leaf.size; ++i) x[i] = leaf.load[at(i < leaf.full ? leaf.row_from[at(i)] : i)];
  for (std::size_t t = 0; t < leaf.ties.size(); ++t) {
    const auto [tie, sign] = leaf.ties[t];
    x[leaf.tie_row[t]] -= sign * tie_scale[at(tie)] * solution(num_coarse + tie);
  }
  substitute_forward(leaf.a.data(), leaf.size, leaf.pivots, x);
  for (int k = 0; k < leaf.num_kept(); ++k) x[leaf.pivots + k] = solution(leaf.coarse[at(k)]);
  substitute_backward(leaf.a.data(), leaf.size, leaf.pivots, x);
  for (int i = 0; i < leaf.size; ++i) leaf.x[at(i < leaf.full ? leaf.columns[at(i)] : i)] = x[i];
}

/// The left vector y of the leaf with y^T A = y_l^T B in the eliminated columns and y_w in the rows of w.
void Dual::State::recover_leaf_left(LeafInterface& leaf, const Eigen::VectorXd& vector) {
  double* y = leaf.work.data();
  const int m = leaf.size, p = leaf.pivots;
  std::fill(y, y + m, 0.0);
  for (std::size_t t = 0; t < leaf.ties.size(); ++t) {
    const auto [tie, sign] = leaf.ties[t];
    if (leaf.tie_column[t] < p) y[leaf.tie_column[t]] += sign * tie_scale[at(tie)] * vector(num_coarse + tie);
  }
  for (int k = 0; k < p; ++k) {  // U^T
    const double* u = leaf.a.data() + at(k) * at(m);
    for (int i = 0; i < k; ++i) y[k] -= u[i] * y[i];
    y[k] /= u[k];
  }
  for (int k = 0; k < leaf.num_kept(); ++k) y[p + k] = vector(leaf.coarse[at(k)]);
  for (int k = p; k-- > 0;) {  // L^T
    const double* l = leaf.a.data() + at(k) * at(m);
    for (int i = k + 1; i < m; ++i) y[k] -= l[i] * y[i];
  }
  for (int i = 0; i < m; ++i) leaf.x[at(i < leaf.full ? leaf.rows[at(i)] : i)] = y[i];
}

}  // namespace bough::solve
