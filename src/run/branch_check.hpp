#pragma once
/// Whether a load step followed the path of equilibria on which it began.
#include "bough/step/advance.hpp"

namespace bough::run {

/// Whether the corrections of a load step moved the structure farther than the first of them, along the tangent at its
/// start, foretold: a jump to another branch does so, and so do large steps of strongly nonlinear structures.
bool may_have_jumped(const step::StepReport& report);

/// Halves the load step from `from` to `to`, equilibria at their load factors, again and again, each time in the half
/// that moves more. On a path motions shrink with the steps. Returns whether they do not, an equilibrium in between is
/// not found, or smaller steps end elsewhere: then `to` is on another branch. Leaves the tangents and the factor of
/// `to` in the system.
bool has_jumped(step::System& system, const step::StepOptions& options, const step::State& from, const step::State& to,
                long& iterations);

}  // namespace bough::run
