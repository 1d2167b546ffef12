#pragma once
/// The interface flexibility of a sub-domain, F = s^2 (S + P)^-1: what is common to the forms and to reports. All in
/// scaled variables. Internal to solve.
#include <Eigen/LU>

#include "bough/solve/report.hpp"

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

/// Completes a report: the singular values of P^1/2 F P^1/2, their ratio, whether the symmetric part of S has no negative
/// eigenvalue beyond round-off, and the matrices, if they are kept (with s = 1).
void report_flexibility(const Eigen::MatrixXd& S, const Eigen::VectorXd& penalty, const Eigen::MatrixXd& flexibility,
                        bool keeps_matrices, InterfaceReport& report);

}  // namespace bough::solve
