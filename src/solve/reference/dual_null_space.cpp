/// Remaining unknowns of the interface problem: null vectors of the whole matrix, or unknowns that can be eliminated.
#include <algorithm>
#include <limits>

#include "bough/blocks/at.hpp"
#include "dual_state.hpp"

namespace bough::solve {

namespace {
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

}  // namespace

/// Vectors that the whole matrix maps nearly to zero, with the remaining columns (rows) of the interface problem set to
/// one unit vector after the other.
void Dual::State::eval_candidates(const tree::Walker& walker, Matrix& right, Matrix* left) {
  const int m = interface.size, k = m - interface.pivots;
  const auto n = static_cast<Eigen::Index>(tree.num_unknowns());
  right.setZero(n, k);
  if (left != nullptr) left->setZero(n, k);
  for (LeafInterface& leaf : leaves) {
    fronts.clear_load(leaf.id);
    std::fill(leaf.load.begin(), leaf.load.end(), 0.0);
  }
  Vector rest(m), solution(coarse.size);
  double* z = interface.work.data();
  for (int v = 0; v < k; ++v) {
    std::fill(z, z + m, 0.0);
    z[interface.pivots + v] = 1.0;
    substitute_backward(interface.a.data(), m, interface.pivots, z);
    for (int i = 0; i < m; ++i) rest(interface.columns[at(i)]) = z[i];
    std::fill(coarse.work.begin(), coarse.work.end(), 0.0);
    back_substitute(rest, solution);
    recover(walker, solution, right.col(v).data());
    if (left == nullptr) continue;
    std::fill(z, z + m, 0.0);
    z[interface.pivots + v] = 1.0;
    substitute_backward_left(interface.a.data(), m, interface.pivots, z);
    for (int i = 0; i < m; ++i) rest(interface.rows[at(i)]) = z[i];
    back_substitute_left(rest, solution);
    double* y = left->col(v).data();
    for (std::size_t i = 0; i < mesh.size(); ++i) y[mesh[i]] = solution(static_cast<int>(i));
    for (LeafInterface& leaf : leaves) recover_leaf_left(leaf, solution);
    for (LeafInterface& leaf : leaves) {
      const int refused = fronts.num_refused(leaf.id);
      for (int i = 0; i < leaf.size; ++i) {
        const int kept = leaf.order[at(i)];
        if (kept < refused) {
          y[fronts.refused_rows(leaf.id)[kept]] = leaf.x[at(i)];
        } else if (const BoundaryUnknown& u = leaf.boundary[at(kept - refused)]; u.coarse < 0) {
          y[u.unknown] += copies[at(u.unknown)] * leaf.x[at(i)];
        }
      }
    }
    for (LeafInterface& leaf : leaves) fronts.backward_left(leaf.id, y);
  }
}

void Dual::State::decide_rank(const tree::Walker& walker) {
  dependent.forget();
  if (interface.pivots == interface.size) return;
  const RemainingUnknowns remaining{[&](Matrix& right, Matrix* left) { eval_candidates(walker, right, left); },
                                    [&](const double* b, double* x) { solve_scaled(walker, b, x); },
                                    [&](int left) {
                                      FrontMatrix front = interface.front();
                                      interface.pivots =
                                          eliminate_completely(front, interface.pivots, interface.size - left,
                                                               std::numeric_limits<double>::min());
                                      return interface.size - interface.pivots;
                                    }};
  dependent.decide(walker, remaining, status);
}

}  // namespace bough::solve
