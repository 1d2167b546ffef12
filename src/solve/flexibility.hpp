#pragma once
/// The interface flexibility of a sub-domain, F = s^2 (S + P)^-1: what is common to the forms and to reports. All in
/// scaled variables. Internal to solve.
#include <Eigen/LU>

namespace bough::solve {

/// The last block of the factor of an augmented sub-domain A = K + B^T P B, which belongs to its boundary.
struct StiffenedInterface {
  Eigen::VectorXd penalty;                      ///< the diagonal of P
  Eigen::PartialPivLU<Eigen::MatrixXd> factor;  ///< of S + P
};

/// P is penalty_factor times the interface's own stiffness |diag S|, or times 1, the size of a diagonal in scaled
/// variables, where only joints of other sub-domains hold an unknown. It is doubled where it cancels a negative
/// stiffness.
StiffenedInterface stiffen(const Eigen::MatrixXd& S, double penalty_factor);

/// Condition number of P^1/2 F P^1/2 (2-norm); 1 without unknowns.
double condition_of_flexibility(const Eigen::VectorXd& penalty, const Eigen::MatrixXd& flexibility);

/// Whether the symmetric part of S has no negative eigenvalue beyond round-off.
bool is_definite(const Eigen::MatrixXd& S);

}  // namespace bough::solve
