#pragma once
/// The iteration shared by statics and dynamics.
#include "bough/step/advance.hpp"

namespace bough::step {

/// Repeats: evaluate, stop when converged, factor, solve, apply. `follow` brings velocities and accelerations along with the positions.
template <class Follow>
StepReport iterate(System& system, State& state, const StepOptions& options, const elements::Slopes& slopes, bool rescale,
                   Follow&& follow);

/// Residual within the tolerance of what makes it, forces, moments, lengths and angles apart.
bool is_small(const ResidualSize& r, double tolerance, double length_scale);

/// Names the part of the residual that is worst, for a message.
std::string describe(const System& system, const ResidualSize& r, double tolerance);

}  // namespace bough::step

#include "newton_impl.hpp"
