/// Remaining unknowns of the interface problem: null vectors of the whole matrix, or unknowns that can be eliminated.
#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/blocks/at.hpp"
#include "decompositions.hpp"
#include "dual_state.hpp"

namespace bough::solve {

namespace {
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Distance to a singular matrix at which motion counts as free: round-off leaves up to some 1e-14 of a refined null
/// vector, since the remaining rows and columns are not an orthogonal basis. A structure that is so close to floating
/// (a static chain of two thousand beams) is rejected.
constexpr double free_motion = 1e-13;
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

/// One step of refinement: z <- z - A^+ A z, with A^+ the solution for fixed remaining unknowns. Pivots of sub-domains
/// down to 1e-6 reduce the accuracy of z.
void Dual::State::sharpen(const tree::Walker& walker, Matrix& candidates) {
  const Eigen::Map<const Vector> row(scales.row.data(), candidates.rows());
  const Eigen::Map<const Vector> column(scales.column.data(), candidates.rows());
  Vector image(candidates.rows()), correction(candidates.rows());
  for (Eigen::Index v = 0; v < candidates.cols(); ++v) {
    const Vector x = column.cwiseProduct(candidates.col(v));
    elements.multiply(walker, x.data(), image.data());
    image = row.cwiseProduct(image).eval();
    solve_scaled(walker, image.data(), correction.data());
    candidates.col(v) -= correction;
  }
}

/// Number of directions in the span of the candidates that the matrix maps to zero, by |A z| / |z| with a product with
/// the element matrices themselves.
int Dual::State::count_null_vectors(const tree::Walker& walker, const Matrix& candidates) {
  const Matrix Q = orthonormal_basis(candidates.colwise().normalized());
  const Eigen::Map<const Vector> row(scales.row.data(), Q.rows()), column(scales.column.data(), Q.rows());
  Matrix image(Q.rows(), Q.cols());
  for (Eigen::Index j = 0; j < Q.cols(); ++j) {
    const Vector x = column.cwiseProduct(Q.col(j));
    elements.multiply(walker, x.data(), image.col(j).data());
    image.col(j) = row.cwiseProduct(image.col(j));
  }
  const RightSingularVectors singular = right_singular_vectors(triangular_factor(image));
  int count = 0;
  for (Eigen::Index j = 0; j < Q.cols(); ++j) {
    const Vector z = Q * singular.vectors.col(j);
    double motion = 0.0;
    for (Eigen::Index i = 0; i < z.size(); ++i)
      if (is_constraint[at(i)] == 0) motion += z(i) * z(i);
    const bool moves = std::sqrt(motion) > options.null_motion_tolerance;
    if (!(singular.values(j) > (moves ? std::max(free_motion, options.singular_tolerance) : options.rank_tolerance)))
      ++count;
  }
  return count;
}

void Dual::State::decide_rank(const tree::Walker& walker) {
  null_right.resize(0, 0);
  null_left.resize(0, 0);
  if (interface.pivots == interface.size) return;
  Matrix candidates;
  eval_candidates(walker, candidates, nullptr);
  if (candidates.allFinite()) sharpen(walker, candidates);
  const int dependent = candidates.allFinite() ? count_null_vectors(walker, candidates) : 0;
  FrontMatrix front = interface.front();
  interface.pivots =
      eliminate_completely(front, interface.pivots, interface.size - dependent, std::numeric_limits<double>::min());
  if (interface.pivots < interface.size) find_null_vectors(walker);
}

/// Orthonormal null vectors, the right ones in exact scaling, and the verdict.
void Dual::State::find_null_vectors(const tree::Walker& walker) {
  Matrix right, left;  // the members stay empty meanwhile, since solutions are projected on them
  eval_candidates(walker, right, &left);
  sharpen(walker, right);
  null_right = right;
  null_left = left;
  const Eigen::Map<const Vector> weight(scales.weight.data(), null_right.rows());
  null_right = weight.asDiagonal() * null_right;
  null_right = orthonormal_basis(null_right.colwise().normalized());
  null_left = orthonormal_basis(null_left.colwise().normalized());
  status.deficiency = static_cast<int>(null_right.cols());
  double worst = 0.0;
  std::int64_t unknown = 0;
  for (Eigen::Index i = 0; i < null_right.rows(); ++i) {
    if (is_constraint[at(i)] != 0 || !(null_right.row(i).squaredNorm() > worst)) continue;
    worst = null_right.row(i).squaredNorm();
    unknown = i;
  }
  if (std::sqrt(worst) > options.null_motion_tolerance) {
    status.outcome = FactorOutcome::singular;
    status.front = tree.num_fronts() - 1;
    status.block = block_of_unknown(tree, unknown);
    status.local = static_cast<int>(unknown - tree.unknown_begin[at(status.block)]);
    status.magnitude = std::sqrt(worst);
  }
  null_right = weight.cwiseInverse().asDiagonal() * null_right;
}

}  // namespace bough::solve
