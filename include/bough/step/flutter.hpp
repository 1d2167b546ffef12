#pragma once
#include <optional>

#include "bough/step/system.hpp"

namespace bough::step {

/// A vibration about an equilibrium that grows.
struct Flutter {
  bool is_there = false;
  double frequency = 0.0;  ///< [rad/s]; 0: the equilibrium is left without vibrating
  double growth = 0.0;     ///< of its amplitude [1/s]
  int node = 0;            ///< that moves most
};

/// The vibrations M x'' + K x = 0, G x = 0 about an equilibrium under loads without a potential, whose K is not
/// symmetric. `system` is one with inertia, at the time of the state, which is at rest. Eigenvalues of K^-1 M, 1 over
/// squared frequencies, by Arnoldi's method: those of the slowest vibrations, which are the first to flutter. Dampers
/// are left out. A shift by M takes the place of K alone where that is not factored soundly. Nothing if K is singular, or
/// where nothing has mass. Allocates.
std::optional<Flutter> find_flutter(System& system, const State& state);

}  // namespace bough::step
