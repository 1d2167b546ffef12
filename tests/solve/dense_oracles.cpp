/// Dense decompositions with which tests compare the solver: a file of their own, since each takes seconds to compile.
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "solving.hpp"
#include "support/untrapped.hpp"

namespace bough::test {

Eigen::VectorXd singular_values(const Eigen::MatrixXd& A) {
  const Untrapped untrapped;
  return Eigen::BDCSVD<Eigen::MatrixXd>(A).singularValues();
}

Eigen::VectorXd least_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> cod(A);
  cod.setThreshold(threshold);
  return cod.solve(b);
}

int rank_of(const Eigen::MatrixXd& A, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> cod(A);
  cod.setThreshold(threshold);
  return static_cast<int>(cod.rank());
}

Eigen::VectorXd solve_with_full_pivoting(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return Eigen::FullPivLU<Eigen::MatrixXd>(A).solve(b);
}

}  // namespace bough::test
