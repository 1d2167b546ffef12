/// Eigen's decompositions of small dense matrices, compiled once, since each takes longer to compile than the rest of a
/// file that uses it.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace bough::solve {

/// A^-1 B by full pivoting; no value if A does not have full rank.
std::optional<Eigen::MatrixXd> solve_if_regular(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Singular values in descending order.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);

/// Eigenvalues of a symmetric matrix, from its lower triangle, in ascending order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

struct RightSingularVectors {
  Eigen::VectorXd values;   ///< in descending order
  Eigen::MatrixXd vectors;  ///< one per column
};
RightSingularVectors right_singular_vectors(const Eigen::MatrixXd& a);

/// R of A = Q R, square; A has at least as many rows as columns.
Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& a);
/// R^-1 B, R^-T B and B R^-1.
Eigen::MatrixXd solve_triangular(const Eigen::MatrixXd& r, const Eigen::MatrixXd& b);
Eigen::MatrixXd solve_triangular_transposed(const Eigen::MatrixXd& r, const Eigen::MatrixXd& b);
Eigen::MatrixXd divide_by_triangular(const Eigen::MatrixXd& b, const Eigen::MatrixXd& r);

/// As many orthonormal vectors as there are columns, which span the columns where these are independent.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns);
/// Orthonormal, and orthogonal to all columns; pivots below `threshold` of the largest count as dependence.
Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& columns, double threshold);

}  // namespace bough::solve
