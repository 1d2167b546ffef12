#pragma once
/// Small questions about vectors and frames. Internal to plan.
#include <algorithm>

#include "bough/motion/types.hpp"

namespace bough::plan {

/// Largest relative gap, or relative velocity, of parts that start together: as large as a consistent start leaves it.
inline constexpr double closed = 1e-13;

inline bool is_identity(const motion::Frame<double>& H) {
  const motion::Mat3<double> one = motion::Mat3<double>::identity();
  return lanes::dot(H.x, H.x) == 0.0 && std::equal(H.R.m, H.R.m + 9, one.m);
}

}  // namespace bough::plan
