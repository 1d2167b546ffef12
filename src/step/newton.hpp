#pragma once
/// The iteration shared by statics and dynamics.
#include "bough/step/advance.hpp"

namespace bough::step {

/// Whether a factor of an earlier iteration or step may serve again.
enum class Reuse { never, while_it_contracts };

/// A factor that contracts the changes less than this is made anew: four more solutions cost about as much as a tangent and its factor.
constexpr double slowest_contraction = 0.03;

/// Repeats: evaluate, stop when converged, factor, solve, apply. `follow` brings velocities and accelerations along with the positions.
template <class Follow>
StepReport iterate(System& system, State& state, const StepOptions& options, const elements::Slopes& slopes,
                   Reuse reuse, Follow&& follow);

/// Residual within the tolerance of what makes it, forces, moments, lengths and angles apart.
bool is_small(const ResidualSize& r, double tolerance, double length_scale, double moment_arm);

/// Names the part of the residual that is worst, for a message.
std::string describe(System& system, const ResidualSize& r, double tolerance);

}  // namespace bough::step

#include "newton_impl.hpp"
