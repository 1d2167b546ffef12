#pragma once
/// The iteration of a step in time, and what it shares with that of statics (equilibrate.cpp).
#include "bough/step/advance.hpp"

namespace bough::step {

/// A factor that contracts the changes less than this is made anew: four more solutions cost about as much as a tangent and its factor.
constexpr double slowest_contraction = 0.03;

/// The change that an iteration may leave, were its contraction to go on, relative to the tolerance: an old factor must come as near as a new
/// one, short steps turn small changes of positions into large ones of multipliers, and later contractions can be slower than early ones.
constexpr double left_open = 1e-6;

/// Changes whose ratio is above this no longer shrink: what is left may be round-off.
constexpr double shrinks = 0.3;

/// Repeats: evaluate, stop when converged, factor, solve, apply. `follow` brings velocities and accelerations along with the positions.
template <class Follow>
StepReport iterate(System& system, State& state, const StepOptions& options, const elements::Slopes& slopes,
                   Follow&& follow);

/// Residual within the tolerance of what makes it, forces, moments, lengths and angles apart.
bool is_small(const System& system, const ResidualSize& r, double tolerance);

/// Whether what is left of a residual above the tolerance may be round-off.
bool is_at_floor(const System& system, const State& state, const ResidualSize& r, double tolerance);

/// Names the part of the residual that is worst, for a message.
std::string describe(System& system, const ResidualSize& r, double tolerance);

}  // namespace bough::step

#include "newton_impl.hpp"
