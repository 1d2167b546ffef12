#pragma once
#include <cmath>

#include "bough/motion/types.hpp"

namespace bough::motion {

/// Length of a vector, without overflow of its square.
inline double norm(const Vec3<double>& a) { return std::hypot(a[0], a[1], a[2]); }

}  // namespace bough::motion
