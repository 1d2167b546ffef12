#pragma once
/// The tangent of a scene's first step as a dense matrix, for independent checks.
#include <Eigen/Dense>

#include "bough/scene/scene.hpp"

namespace bough::stress {

struct TangentMatrix {
  Eigen::MatrixXd matrix;  ///< in the scene's units
  Eigen::MatrixXd scaled;  ///< D_r A D_c with the scales of the solver
  Eigen::VectorXd row_scale, column_scale;
  Eigen::VectorXd rhs, solution;  ///< of the first Newton iteration
  double backward_error = 0.0;
};

/// Throws std::runtime_error where the run fails before that step. For hierarchical solvers and matrices of some
/// hundred unknowns.
TangentMatrix tangent_matrix(const scene::Scene& scene);

/// 2-norm condition number.
double condition_of(const Eigen::MatrixXd& matrix);

/// Condition |A| |A^-1| of the unscaled matrix in Frobenius norms. The inverse is computed as D_c (D_r A D_c)^-1 D_r,
/// since A itself may be singular to working precision.
double condition_without_scaling(const TangentMatrix& tangent);

/// Row and column scales that bring the largest entries of rows and columns near one (Ruiz 2001): independent of the
/// solver's.
void equilibrate(const Eigen::MatrixXd& matrix, Eigen::VectorXd& row, Eigen::VectorXd& column);

}  // namespace bough::stress
