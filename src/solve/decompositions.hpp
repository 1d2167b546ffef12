/// Eigen's decompositions of small dense matrices, compiled once: each takes longer to compile than all the rest of a
/// file that uses it.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace bough::solve {

/// A^-1 by partial pivoting; not finite where a pivot is zero.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);

/// A^-1 B by full pivoting; nothing where A has not full rank.
std::optional<Eigen::MatrixXd> solve_if_regular(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// In falling order.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);

/// Of a symmetric matrix, its lower triangle; in rising order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

struct RightSingularVectors {
  Eigen::VectorXd values;   ///< in falling order
  Eigen::MatrixXd vectors;  ///< a column each
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
