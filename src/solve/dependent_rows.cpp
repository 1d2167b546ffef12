#include "dependent_rows.hpp"

#include <algorithm>
#include <cmath>

#include "bough/blocks/at.hpp"
#include "decompositions.hpp"
#include "reference/refine.hpp"

namespace bough::solve {

namespace {
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Distance to a singular matrix at which motion counts as free: round-off leaves up to some 1e-14 of a refined null
/// vector, since the remaining rows and columns are not an orthogonal basis. A structure that is so close to floating
/// (a static chain of two thousand beams) is rejected.
constexpr double free_motion = 1e-13;
constexpr double contradiction = 1e-10;  ///< share of the right-hand side above which dependent rows disagree
constexpr double takes_part = 1e-8;      ///< entry of a unit null vector above which a block takes part in it
}  // namespace

DependentRows::DependentRows(const ElementStore& elements, const Scales& scales, const SolveOptions& options)
    : elements_(elements), scales_(scales), options_(options) {
  const tree::Tree& tree = elements.tree();
  is_constraint_.assign(at(tree.num_unknowns()), 0);
  for (int b = 0; b < elements.graph().num_blocks(); ++b)
    for (std::int64_t u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u)
      is_constraint_[at(u)] = elements.graph().block_kind[at(b)] == blocks::BlockKind::multiplier ? 1 : 0;
}

/// One step of refinement: z <- z - A^+ A z, with A^+ the solution for fixed remaining unknowns. Small pivots reduce
/// the accuracy of z.
void DependentRows::sharpen(const tree::Walker& walker, const RemainingUnknowns& remaining, Matrix& candidates) const {
  const Eigen::Map<const Vector> row(scales_.row.data(), candidates.rows());
  const Eigen::Map<const Vector> column(scales_.column.data(), candidates.rows());
  Vector image(candidates.rows()), correction(candidates.rows());
  for (Eigen::Index v = 0; v < candidates.cols(); ++v) {
    const Vector x = column.cwiseProduct(candidates.col(v));
    elements_.multiply(walker, x.data(), image.data());
    image = row.cwiseProduct(image).eval();
    remaining.solve(image.data(), correction.data());
    candidates.col(v) -= correction;
  }
}

/// Number of directions in the span of the candidates that the matrix maps to zero, by |A z| / |z| with a product with
/// the element matrices.
int DependentRows::count(const tree::Walker& walker, const Matrix& candidates) const {
  const Matrix Q = orthonormal_basis(candidates.colwise().normalized());
  const Eigen::Map<const Vector> row(scales_.row.data(), Q.rows()), column(scales_.column.data(), Q.rows());
  Matrix image(Q.rows(), Q.cols());
  for (Eigen::Index j = 0; j < Q.cols(); ++j) {
    const Vector x = column.cwiseProduct(Q.col(j));
    elements_.multiply(walker, x.data(), image.col(j).data());
    image.col(j) = row.cwiseProduct(image.col(j));
  }
  const RightSingularVectors singular = right_singular_vectors(triangular_factor(image));
  int count = 0;
  for (Eigen::Index j = 0; j < Q.cols(); ++j) {
    const Vector z = Q * singular.vectors.col(j);
    double motion = 0.0;
    for (Eigen::Index i = 0; i < z.size(); ++i)
      if (is_constraint_[at(i)] == 0) motion += z(i) * z(i);
    const bool moves = std::sqrt(motion) > options_.null_motion_tolerance;
    if (!(singular.values(j) > (moves ? std::max(free_motion, options_.singular_tolerance) : options_.rank_tolerance)))
      ++count;
  }
  return count;
}

void DependentRows::decide(const tree::Walker& walker, const RemainingUnknowns& remaining, FactorStatus& status) {
  forget();
  Matrix candidates;
  remaining.candidates(candidates, nullptr);
  if (candidates.allFinite()) sharpen(walker, remaining, candidates);
  const int dependent = candidates.allFinite() ? count(walker, candidates) : 0;
  if (remaining.eliminate_all_but(dependent) > 0) find(walker, remaining, status);
}

/// Orthonormal null vectors, the right ones in exact scaling, and the verdict.
void DependentRows::find(const tree::Walker& walker, const RemainingUnknowns& remaining, FactorStatus& status) {
  Matrix right, left;  // the members stay empty meanwhile, since solutions are projected on them
  remaining.candidates(right, &left);
  sharpen(walker, remaining, right);
  const Eigen::Map<const Vector> weight(scales_.weight.data(), right.rows());
  right = weight.asDiagonal() * right;
  right_ = orthonormal_basis(right.colwise().normalized());
  left_ = orthonormal_basis(left.colwise().normalized());
  status.deficiency = static_cast<int>(right_.cols());
  double worst = 0.0;
  std::int64_t unknown = 0;
  for (Eigen::Index i = 0; i < right_.rows(); ++i) {
    if (is_constraint_[at(i)] != 0 || !(right_.row(i).squaredNorm() > worst)) continue;
    worst = right_.row(i).squaredNorm();
    unknown = i;
  }
  const tree::Tree& tree = elements_.tree();
  if (std::sqrt(worst) > options_.null_motion_tolerance) {
    status.outcome = FactorOutcome::singular;
    status.front = tree.num_fronts() - 1;
    status.block = tree.block_of_unknown(unknown);
    status.local = static_cast<int>(unknown - tree.unknown_begin[at(status.block)]);
    status.magnitude = std::sqrt(worst);
  }
  right_ = weight.cwiseInverse().asDiagonal() * right_;
}

/// A contradiction below its bound is round-off of the null vectors. Its removal would move parts that the load leaves
/// at rest (a planar mechanism out of its plane).
void DependentRows::make_consistent(double* b, SolveReport& report) const {
  if (left_.cols() == 0) return;
  Eigen::Map<Vector> load(b, left_.rows());
  const Eigen::Map<const Vector> row(scales_.row.data(), left_.rows());
  const Vector scaled = row.cwiseProduct(load), share = left_.transpose() * scaled;
  const Vector part = left_ * share;
  report.inconsistency = scaled.norm() > 0.0 ? share.norm() / scaled.norm() : 0.0;
  const auto& first_of = elements_.tree().unknown_begin;
  double worst = 0.0;
  for (int k = 0; k + 1 < static_cast<int>(first_of.size()); ++k) {
    const auto first = static_cast<Eigen::Index>(first_of[at(k)]);
    const auto size = static_cast<Eigen::Index>(first_of[at(k) + 1]) - first;
    if (part.segment(first, size).squaredNorm() <= worst) continue;
    worst = part.segment(first, size).squaredNorm();
    report.inconsistent_block = k;
    report.inconsistent_amount =
        part.segment(first, size).cwiseQuotient(row.segment(first, size)).cwiseAbs().maxCoeff();
  }
  if (report.inconsistency > contradiction) load -= part.cwiseQuotient(row);
}

void DependentRows::make_least(double* x) const {
  for (Eigen::Index v = 0; v < right_.cols(); ++v) {
    double sum = 0.0;
    for (std::size_t i = 0; i < is_constraint_.size(); ++i)
      sum += scales_.weight[i] * scales_.weight[i] * x[i] * right_(static_cast<Eigen::Index>(i), v);
    for (std::size_t i = 0; i < is_constraint_.size(); ++i)
      if (is_constraint_[i] != 0) x[i] -= sum * right_(static_cast<Eigen::Index>(i), v);
  }
}

void DependentRows::make_least_unscaled(double* x) const {
  if (right_.cols() == 0) return;
  for (std::size_t i = 0; i < is_constraint_.size(); ++i) x[i] /= scales_.column[i];
  make_least(x);
  for (std::size_t i = 0; i < is_constraint_.size(); ++i) x[i] *= scales_.column[i];
}

std::vector<int> DependentRows::blocks() const {
  std::vector<int> blocks;
  const auto& first_of = elements_.tree().unknown_begin;
  for (int b = 0; b < elements_.graph().num_blocks() && right_.cols() > 0; ++b) {
    const auto first = static_cast<Eigen::Index>(first_of[at(b)]);
    const auto size = static_cast<Eigen::Index>(first_of[at(b) + 1]) - first;
    if (right_.middleRows(first, size).cwiseAbs().maxCoeff() > takes_part) blocks.push_back(b);
  }
  return blocks;
}

}  // namespace bough::solve
