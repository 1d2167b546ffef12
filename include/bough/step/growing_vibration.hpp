#pragma once
/// Whether a scene has undamped vibrations that backward differences of order 3 make grow.
#include <optional>

#include "bough/step/system.hpp"

namespace bough::step {

struct GrowingVibration {
  double frequency = 0.0;       ///< [rad/s]
  double steps_a_period = 0.0;  ///< some 3 to 12
  int node = -1;                ///< that moves most in it
};

/// The rule of order 3 is stable within 86 degrees of the negative axis: vibrations whose damping is below cos(86
/// degrees) of the critical one grow where a step h is between 1/12 and 1/3 of their period. They are looked for at
/// `state`, which is consistent, with the linear filter
///   P = [K + s M, G^T; G, 0]^-1 (s M),   eigenvalues p = s / (omega^2 + s)
/// whose shift s lies in the middle of the band. 4 P (1 - P), applied again and again, leaves what is nearest to it;
/// the ratio of two such vectors in a row tells whether that is inside. One factorization and some 50 solutions.
/// Overwrites tangents, residual and right-hand side of `system`, whose factor serves no more. Nothing is found where
/// the solution fails.
std::optional<GrowingVibration> find_growing_vibration(System& system, const State& state, double h);

}  // namespace bough::step
