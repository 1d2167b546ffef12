#pragma once
/// What a law can do at most within a time.
#include "bough/laws/law.hpp"

namespace bough::laws {

/// A bound of |d2f/dt2| over [t_begin, t_end] without its jumps: the error of the trapezoidal rule over steps of size h
/// that end at breakpoints is at most h^2 / 12 times it and the duration. By interval arithmetic, so that no narrow
/// pulse escapes. It may be too large, and infinite, but approaches the largest value as the interval shrinks.
double largest_acceleration(const Law& law, double t_begin, double t_end);

}  // namespace bough::laws
