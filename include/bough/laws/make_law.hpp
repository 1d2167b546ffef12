#pragma once

#include <string>
#include <vector>

#include "bough/laws/law.hpp"
#include "bough/laws/law_error.hpp"

namespace bough::laws {

/// Limits of integrals by quadrature; an integral that exceeds one of them is NaN, because the law varies too fast to
/// be integrated. max_breaks: breakpoints within one panel (panels are 1/64 s long or longer). max_evaluations:
/// evaluations of the integrand from the start to the time requested; a smooth law takes 2000 per second of the first
/// minute, fewer later.
inline constexpr std::size_t max_breaks = 20'000, max_evaluations = 10'000'000;

// All factories throw LawError where a number is not finite or a precondition fails. u is the unit of the law.

/// f = c.
Law make_constant(double c);

/// v0 before t0, v1 after t1, straight between:  f = v0 + (v1 - v0) s,  s = (t - t0) / (t1 - t0).  t0 < t1 [s].
/// The rate jumps at t0 and t1.
Law make_ramp(double t0, double t1, double v0, double v1);

/// v0 before t0, v1 after t1, between them a quintic with no jump up to the second derivative:
///   f = v0 + (v1 - v0) (10 s^3 - 15 s^4 + 6 s^5),  s = (t - t0) / (t1 - t0).  t0 < t1 [s].
Law make_smooth_ramp(double t0, double t1, double v0, double v1);

/// v0 before t0, v1 after t1, between them a cycloid with no jump up to the second derivative:
///   f = v0 + (v1 - v0) (s - sin(2 pi s) / (2 pi)),  s = (t - t0) / (t1 - t0).  t0 < t1 [s].
/// Its rate is one full wave of 1 - cos: as an angle, a turn that starts and ends at rest.
Law make_cycloidal(double t0, double t1, double v0, double v1);

/// f = offset + amplitude sin(omega t + phase).  omega [rad/s], phase [rad].
Law make_harmonic(double amplitude, double omega, double phase = 0.0, double offset = 0.0);

enum class Interpolation {
  linear,  ///< straight lines: the rate jumps at the knots
  cubic,   ///< cubic spline with not-a-knot ends: reproduces cubics, no jump inside; 3 knots a parabola, 2 a line
  /// Cubics with slopes at the knots that keep the data's monotonicity (Fritsch, Carlson 1980): no overshoot; the
  /// second derivative jumps at inner knots, the rate at the ends.
  monotone
};

/// Through the points (times[i], values[i]), held constant outside. times [s]: at least one, strictly increasing.
Law make_table(const std::vector<double>& times, const std::vector<double>& values, Interpolation interpolation);

struct Segment {
  double start = 0.0;  ///< [s]
  Law law;             ///< in the absolute time t, not in the time since start
};

/// The law of the last segment whose start is not after t; before the first start, the law of the first segment.
/// starts strictly increasing, at least one. Every start but the first counts as a breakpoint.
Law make_piecewise(const std::vector<Segment>& segments);

/// f = sum of terms; none: zero.
Law make_sum(const std::vector<Law>& terms);

/// f = a b.
Law make_product(const Law& a, const Law& b);

/// f = factor * law.
Law make_scaled(double factor, const Law& law);

/// f = dg/dt of a law g, with g' and g'' as exact as those are; f'' is a difference of g'' over 1e-6 s (or that part of
/// t) within the smooth branch on the side asked for. Where the value of g jumps, f has no impulse.
Law make_rate(const Law& law);

/// The law given by a formula in t [s], with exact derivatives.
///   numbers 2  0.5  1e-3;  t  pi  e;  + - * / ^ and parentheses (^ binds to the right and before a sign: -2^2 = -4);
///   sin cos tan asin acos atan sinh cosh tanh exp log (natural) sqrt abs sign step pow(x, y), min and max of two or
///   more.  step(x) = 0 for x < 0, else 1.  At most 64 levels of nesting.
/// Throws LawError with the position; a misspelt name comes with the nearest known one.
/// breakpoints(): the places where an abs, min, max, sign or step changes branch, isolated by interval arithmetic.
/// Two changes closer than 1e-14 of the window may be missed, and so may some where an argument stays within round-off
/// of zero over a stretch. Poles are no breakpoints: they are not finite and reported as such.
Law make_expression(const std::string& text);

}  // namespace bough::laws
