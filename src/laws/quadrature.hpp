#pragma once

#include <functional>

#include "node.hpp"

namespace bough::laws {

/// int_a^b f(t) dt by adaptive Gauss-Kronrod (7, 15) to round-off of int |f|; f smooth inside (a, b), b < a allowed.
/// Work is bounded: at most 2000 halvings, at most 48 deep. The result is NaN if a relative error of 1e-6 is not
/// reached (a pole, an oscillation that is too fast), and not finite if f is not finite at a point used. No allocation.
/// Source: Piessens 1983 (QUADPACK), rule and error estimate of QK15.
double eval_quadrature(const std::function<double(double)>& f, double a, double b);

/// The law  F(t) = int_t0^t f ds  by quadrature, cut at every break of f.
/// Sums over fixed panels are stored, so an evaluation costs one panel; the panels and the order in which they are
/// added depend on t0 alone, so the value does not depend on earlier calls or on threads. The first visit to a panel
/// allocates.
Law make_quadrature_integral(const Law& integrand, double t0);

}  // namespace bough::laws
