#include "bough/plan/small_inverse.hpp"

#include <Eigen/LU>

namespace bough::plan {

bool invert_small(double* a, int n, double least_pivot) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 6, 6>;
  Eigen::Map<Matrix> matrix(a, n, n);
  if (!matrix.allFinite()) return false;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> scale = matrix.rowwise().lpNorm<Eigen::Infinity>();
  if (!(scale.minCoeff() > 0.0)) return false;
  scale = scale.cwiseInverse();
  Eigen::FullPivLU<Matrix> lu(scale.asDiagonal() * matrix);
  lu.setThreshold(least_pivot);
  if (!lu.isInvertible()) return false;
  matrix = lu.inverse() * scale.asDiagonal();
  return true;
}

}  // namespace bough::plan
