#pragma once
/// Errors of sampled quantities, their norms, and the orders with which they fall.
#include <vector>

#include "bough/io/study_spec.hpp"
#include "bough/study/sweep.hpp"

namespace bough::study {

/// Values of one quantity at the sample times; an empty one: not there.
using Samples = std::vector<std::vector<double>>;

/// Distance of a value from the reference: Euclidean, or |log(R_ref^T R)| [rad] of rotations, which are 3 numbers
/// (rotation vector) or 4 (quaternion, scalar first, of any length but 0) on either side.
double distance(io::QuantityKind kind, const std::vector<double>& value, const std::vector<double>& reference);

/// What errors are relative to: the largest Euclidean norm of the reference (1 where that is 0); 1 of rotations.
double error_scale(io::QuantityKind kind, const Samples& reference);

/// Norms over the samples that both have; `end` is that of the last sample, NaN where one of them lacks it.
ErrorNorms eval_errors(io::QuantityKind kind, const Samples& values, const Samples& reference, double scale);

/// Slope of log y over log x by least squares. x, y: positive. Fewer than two different x: NaN.
double log_slope(const std::vector<double>& x, const std::vector<double>& y);

/// h, error: from coarse to fine, NaN where a run failed. Fits up to `fitted_points` errors in a row above round-off
/// (1e-13): the finest for which  uncertainty / e_fine <= largest_doubt log(h_coarse / h_fine).  `runs` gets their
/// positions in h.
OrderFit fit_order(const std::vector<double>& h, const std::vector<double>& error, double uncertainty);

/// Sets the verdict of a fit from its order and what is expected of it.
void judge(OrderFit& fit);

}  // namespace bough::study
