#pragma once
#include <span>
#include <string>
#include <vector>

#include "bough/records/errors.hpp"

namespace bough::run {

/// Differences of one quantity between the members of a family of runs with sizes of 1 : 2 : 4, at common times.
/// A number has `width` 1; a rotation 3, the rotation vector of R_coarser^T R_finer [rad].
struct MemberDifferences {
  std::size_t width = 1;
  std::vector<double> fine;    ///< finest minus middle, times x width
  std::vector<double> coarse;  ///< middle minus coarsest; empty: there are two members only
};

/// What a family of runs tells about one of them.
struct Extrapolation {
  records::ErrorPart part;
  std::vector<double> error;  ///< limit minus run, times x width; empty unless the part is_known and above round-off
};

/// Theory that errors are compared with.
struct ErrorTheory {
  double order = 0.0;      ///< 0: members differ in what results do not depend on
  double round_off = 0.0;  ///< below which differences are round-off, whatever their order
  double floor = 0.0;      ///< what the tolerance of Newton's method and round-off leave open
};

/// Richardson's extrapolation of one quantity. With d = fine, D = coarse and q = 2^p, errors of order p have D = q d at
/// all times, and the limit is the finest member plus d / (q - 1). The error is resolved where D / d is near q; a single
/// time at which it is not, measured against the largest d of all times, makes it unresolved.
/// run: which member's error is told, 0 the finest, 1 the middle one, 2 the coarsest.
/// times: one for each entry of the differences; of a figure a single one.
Extrapolation extrapolate(const MemberDifferences& d, std::span<const double> times, int run,
                          const ErrorTheory& theory);

}  // namespace bough::run
