#pragma once
/// Errors of sampled quantities, their norms, and their orders of convergence.
#include <vector>

#include "bough/io/study_spec.hpp"
#include "bough/study/sweep.hpp"

namespace bough::study {

/// Values of one quantity at the sample times; an empty entry means that there is no value.
using Samples = std::vector<std::vector<double>>;

/// Distance of a value from the reference: Euclidean, or |log(R_ref^T R)| [rad] of rotations, which are 3 numbers
/// (rotation vector) or 4 (quaternion, scalar first, of any length but 0) on either side.
double distance(io::QuantityKind kind, const std::vector<double>& value, const std::vector<double>& reference);

/// Reference magnitude of errors: the largest Euclidean norm of the reference (1 where that is 0); 1 for rotations.
double error_scale(io::QuantityKind kind, const Samples& reference);

/// Norms over the samples that both have; `end` is the error at the last sample, NaN where one of them has no value
/// there.
ErrorNorms eval_errors(io::QuantityKind kind, const Samples& values, const Samples& reference, double scale);

/// Richardson's extrapolation of a quantity with errors of order p from steps h and 2 h,  u_h + (u_h - u_2h) / (2^p - 1),
/// of rotations R_h exp(log(R_2h^T R_h) / (2^p - 1)), which are told as quaternions. Empty where one has no value.
Samples extrapolated(io::QuantityKind kind, const Samples& fine, const Samples& coarse, double order);

/// Slope of log y over log x by least squares. x, y: positive. Fewer than two different x: NaN.
double log_slope(const std::vector<double>& x, const std::vector<double>& y);

/// Fits an order to errors at step sizes h, from coarse to fine, NaN where a run failed. It uses up to `fitted_points`
/// consecutive errors above round-off (1e-13): the finest ones for which  uncertainty / e_fine <= largest_doubt
/// log(h_coarse / h_fine).  `runs` gets their indices in h.
OrderFit fit_order(const std::vector<double>& h, const std::vector<double>& error, double uncertainty);

/// Sets the verdict of a fit from its order and the expected order.
void judge(OrderFit& fit);

}  // namespace bough::study
