/// The interface mesh of the hybrid form, and the interface problem of both forms.
#include <algorithm>
#include <cmath>
#include <ctime>

#include "bough/blocks/at.hpp"
#include "decompositions.hpp"
#include "dual_state.hpp"

namespace bough::solve {

namespace {
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double coarse_pivot =
    1e-6;  ///< unknowns of the coarse problem with pivots below this, scaled, are eliminated with the multipliers
/// Flexibility of a tie, against the largest of its leaf, below which it is round-off: joints hold that direction.
/// Scaled to one, the round-off of a direction held on both sides (a dependent row) would be taken for stiffness.
constexpr double held = 1e-6;
constexpr double suspect_pivot_of_ties =
    1e-6;  ///< pivots of the interface problem below this are examined before they are used
}  // namespace

void DenseStage::reset(int new_size, int new_full) {
  size = new_size;
  full = new_full;
  pivots = 0;
  a.assign(at(size) * at(size), 0.0);
  work.assign(at(size), 0.0);
  for (auto* v : {&rows, &columns, &row_from}) {
    v->resize(at(full));
    for (int i = 0; i < full; ++i) (*v)[at(i)] = i;
  }
}

double DenseStage::flops() const {
  double sum = 0.0;
  for (int k = 0; k < pivots; ++k) sum += 2.0 * (size - k - 1.0) * (size - k - 1.0) + (size - k - 1.0);
  return sum;
}

/// By block: hybrid, whether it is in the interface mesh. Cross points are; then every leaf without one adds a motion
/// block, preferably one shared with another leaf without one.
std::vector<char> Dual::State::choose_local(const std::vector<std::vector<int>>& leaves_of_block) const {
  std::vector<char> is_local(leaves_of_block.size(), 0), has_local(leaves.size(), 0);
  if (form.form == DualForm::global) return is_local;
  std::vector<std::vector<int>> blocks_of(leaves.size());
  const auto choose = [&](std::size_t b) {
    is_local[b] = 1;
    for (const int l : leaves_of_block[b]) has_local[at(l)] = 1;
  };
  for (std::size_t b = 0; b < leaves_of_block.size(); ++b) {
    if (leaves_of_block[b].size() > 2) choose(b);
    if (elements.graph().block_kind[b] == blocks::BlockKind::motion && leaves_of_block[b].size() == 2)
      for (const int l : leaves_of_block[b]) blocks_of[at(l)].push_back(static_cast<int>(b));
  }
  for (std::size_t l = 0; l < leaves.size(); ++l) {
    if (has_local[l] != 0 || blocks_of[l].empty()) continue;
    int best = blocks_of[l].front();
    for (const int b : blocks_of[l])
      for (const int other : leaves_of_block[at(b)])
        if (at(other) != l && has_local[at(other)] == 0) best = b;
    choose(at(best));
  }
  return is_local;
}

/// Indices of w: the mesh, then the remaining unknowns of each leaf.
void Dual::State::number_coarse() {
  num_coarse = static_cast<int>(mesh.size());
  for (LeafInterface& leaf : leaves) {
    leaf.coarse.clear();
    for (int i = leaf.pivots; i < leaf.full; ++i) leaf.coarse.push_back(num_coarse++);
    for (int i = leaf.full; i < leaf.size; ++i)
      leaf.coarse.push_back(leaf.boundary[at(leaf.order[at(i)] - fronts.num_refused(leaf.id))].coarse);
  }
}

void Dual::State::assemble_interface() {
  const int n = num_coarse + num_ties();
  coarse.reset(n, form.form == DualForm::hybrid ? num_coarse : 0);
  tie_scale.assign(ties.size(), 0.0);
  for (const LeafInterface& leaf : leaves) {
    const auto flexibility = leaf.flexibility.diagonal().cwiseAbs();
    const double least = flexibility.size() > 0 ? held * flexibility.maxCoeff() : 0.0;
    for (std::size_t t = 0; t < leaf.ties.size(); ++t)
      tie_scale[at(leaf.ties[t].first)] += std::max(flexibility(static_cast<int>(t)), least);
  }
  for (double& s : tie_scale) s = s > 0.0 ? std::exp2(std::round(-0.5 * std::log2(s))) : 1.0;
  for (const LeafInterface& leaf : leaves) {
    const int kept = leaf.num_kept(), count = static_cast<int>(leaf.ties.size());
    for (int i = 0; i < kept; ++i)
      for (int j = 0; j < kept; ++j)
        coarse(leaf.coarse[at(i)], leaf.coarse[at(j)]) +=
            leaf.a[at(leaf.pivots + i) + at(leaf.pivots + j) * at(leaf.size)];
    for (int t = 0; t < count; ++t) {
      const auto [tie, sign] = leaf.ties[at(t)];
      const double scale = sign * tie_scale[at(tie)];
      for (int k = 0; k < kept; ++k) {
        coarse(leaf.coarse[at(k)], num_coarse + tie) += scale * leaf.left(t, k);
        coarse(num_coarse + tie, leaf.coarse[at(k)]) -= scale * leaf.right(t, k);
      }
      for (int s = 0; s < count; ++s)
        coarse(num_coarse + tie, num_coarse + leaf.ties[at(s)].first) +=
            scale * leaf.flexibility(t, s) * leaf.ties[at(s)].second * tie_scale[at(leaf.ties[at(s)].first)];
    }
  }
}

/// Eliminates w as far as possible (hybrid), then the others down to the pivots that decide_rank() must examine
/// (direct).
void Dual::State::factor_interface() {
  const double start = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  number_coarse();
  assemble_interface();
  const int n = coarse.size;
  if (coarse.full > 0) {
    FrontMatrix front = coarse.front();
    coarse.pivots = std::max(0, eliminate_with_threshold(front, {0.01, coarse_pivot}));
  }
  const int p = coarse.pivots;
  interface.reset(n - p, n - p);
  for (int j = p; j < n; ++j)
    for (int i = p; i < n; ++i) interface(i - p, j - p) = coarse(i, j);
  reduced = Eigen::Map<const Matrix>(interface.a.data(), n - p, n - p);
  iterations = 0;
  if (form.solution == InterfaceSolution::iterative) {
    is_symmetric = coarse.full == p && reduced.size() > 0 &&
                   (reduced - reduced.transpose()).cwiseAbs().maxCoeff() <= 1e-10 * reduced.cwiseAbs().maxCoeff();
    assemble_preconditioner();
  } else {
    FrontMatrix front = interface.front();
    interface.pivots = std::max(0, eliminate_with_threshold(front, {0.1, 1e-2}));
    interface.pivots = eliminate_completely(front, interface.pivots, interface.full, suspect_pivot_of_ties);
  }
  seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC - start;
}

/// From the unknowns of the last stage to (w, l).
void Dual::State::back_substitute(Vector& rest, Vector& x) {
  const int n = coarse.size, p = coarse.pivots;
  double* z = coarse.work.data();
  for (int i = p; i < n; ++i) z[i] = rest(i - p);
  substitute_backward(coarse.a.data(), n, p, z);
  for (int i = 0; i < n; ++i) x(i < coarse.full ? coarse.columns[at(i)] : i) = z[i];
}

void Dual::State::back_substitute_left(Vector& rest, Vector& y) {
  const int n = coarse.size, p = coarse.pivots;
  double* z = coarse.work.data();
  std::fill(z, z + p, 0.0);
  for (int i = p; i < n; ++i) z[i] = rest(i - p);
  substitute_backward_left(coarse.a.data(), n, p, z);
  for (int i = 0; i < n; ++i) y(i < coarse.full ? coarse.rows[at(i)] : i) = z[i];
}

void Dual::State::solve_interface(const Vector& rhs, Vector& x) {
  const int n = coarse.size, p = coarse.pivots, m = interface.size;
  double* z = coarse.work.data();
  for (int i = 0; i < n; ++i) z[i] = rhs(i < coarse.full ? coarse.row_from[at(i)] : i);
  substitute_forward(coarse.a.data(), n, p, z);
  const Vector load = Eigen::Map<const Vector>(z + p, m);
  std::vector<double> first(z, z + p);
  Vector rest = Vector::Zero(m);
  if (form.solution == InterfaceSolution::iterative) {
    converged = iterate(load, rest) && converged;
  } else {
    double* y = interface.work.data();
    for (int i = 0; i < m; ++i) y[i] = load(interface.row_from[at(i)]);
    substitute_forward(interface.a.data(), m, interface.pivots, y);
    std::fill(y + interface.pivots, y + m, 0.0);
    substitute_backward(interface.a.data(), m, interface.pivots, y);
    for (int i = 0; i < m; ++i) rest(interface.columns[at(i)]) = y[i];
  }
  std::copy(first.begin(), first.end(), z);
  back_substitute(rest, x);
}

/// Singular values of the flexibility with unit diagonal, on the forces that do no work on the remaining unknowns of w.
double Dual::State::eval_condition() const {
  const int waiting = coarse.full > 0 ? coarse.full - coarse.pivots : num_coarse;
  const int count = num_ties();
  if (count == 0) return 1.0;
  Matrix F = reduced.bottomRightCorner(count, count);
  if (waiting > 0) {
    const Matrix right = orthogonal_complement(reduced.topRightCorner(waiting, count).transpose(), 1e-10);
    const Matrix left = orthogonal_complement(reduced.bottomLeftCorner(count, waiting), 1e-10);
    if (right.cols() != left.cols()) return std::numeric_limits<double>::infinity();
    F = left.transpose() * F * right;
  }
  if (F.size() == 0 || !F.allFinite()) return 1.0;
  const Vector values = singular_values(F);
  Eigen::Index last = values.size() - 1;  // directions that joints hold on both sides have no flexibility
  while (last > 0 && values(last) <= 1e-13 * values(0)) --last;
  return values(last) > 0.0 ? values(0) / values(last) : 1.0;
}

}  // namespace bough::solve
