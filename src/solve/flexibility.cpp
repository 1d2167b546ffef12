#include "flexibility.hpp"

#include <algorithm>
#include <limits>

#include "decompositions.hpp"

namespace bough::solve {

namespace {
constexpr double no_stiffness = 1e-12;  ///< a smaller one is round-off
constexpr double cancels = 1e-14;       ///< reciprocal condition of S + P below which P cancels S, at a factor of 1
constexpr int most_doublings = 8;
}  // namespace

StiffenedInterface stiffen(const Eigen::MatrixXd& S, double penalty_factor) {
  StiffenedInterface to;
  to.penalty = S.diagonal().cwiseAbs();
  for (double& p : to.penalty) p = penalty_factor * (p < no_stiffness ? 1.0 : p);
  if (S.size() == 0) return to;
  for (int k = 0;; ++k) {
    Eigen::MatrixXd stiffened = S;
    stiffened.diagonal() += to.penalty;
    to.factor.compute(stiffened);
    // rcond() says nothing of a factor with a pivot of zero.
    const bool is_regular = to.factor.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0 &&
                            to.factor.rcond() >= cancels * std::min(1.0, penalty_factor);
    if (k == most_doublings || is_regular) return to;
    to.penalty *= 2.0;
  }
}

void report_flexibility(const Eigen::MatrixXd& S, const Eigen::VectorXd& penalty, const Eigen::MatrixXd& flexibility,
                        bool keeps_matrices, InterfaceReport& report) {
  if (penalty.size() == 0) return;
  const Eigen::VectorXd root = penalty.cwiseSqrt();
  const Eigen::MatrixXd scaled = root.asDiagonal() * flexibility * root.asDiagonal();
  if (scaled.allFinite()) {
    const Eigen::VectorXd values = singular_values(scaled);
    report.spectrum.assign(values.begin(), values.end());
    report.condition = values(0) / values(values.size() - 1);
  } else {
    report.condition = std::numeric_limits<double>::infinity();
  }
  constexpr double round_off = 1e-12;
  const Eigen::VectorXd stiffnesses = symmetric_eigenvalues(0.5 * (S + S.transpose()));
  report.is_definite = stiffnesses(0) >= -round_off * stiffnesses.cwiseAbs().maxCoeff();
  if (!keeps_matrices) return;
  report.matrices.stiffness.assign(S.data(), S.data() + S.size());
  report.matrices.penalty.assign(penalty.begin(), penalty.end());
  report.matrices.flexibility.assign(flexibility.data(), flexibility.data() + flexibility.size());
}

}  // namespace bough::solve
