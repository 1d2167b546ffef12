#pragma once

#include <vector>

#include "node.hpp"

namespace bough::laws {

/// A wave  offset + amplitude sin(theta),  theta(t) = omega (t - start) + phase.  omega != 0 [rad/s].
/// start keeps the digits of theta where the wave belongs to a time far from zero.
struct Wave {
  double amplitude;
  double omega;
  double phase;
  double offset;
  double start;
};

Law make_wave(const Wave& wave);

}  // namespace bough::laws
