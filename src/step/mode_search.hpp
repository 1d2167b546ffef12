#pragma once
/// What searches for modes have in common. Internal to step.
#include "bough/step/modes.hpp"

namespace bough::step {

inline constexpr double converged = 1e-10;  ///< relative residual of an eigenvalue: its own error is of second order

/// A fixed vector that has a part in every mode, in units in which all unknowns are alike; zero for multipliers.
std::vector<double> random_vector(const Linearisation& linear, unsigned seed);
/// A vector without its multipliers.
std::vector<double> motion_of(const Linearisation& linear, const std::vector<double>& x);
std::vector<double> real_part(const std::vector<std::complex<double>>& x);
std::vector<double> imaginary_part(const std::vector<std::complex<double>>& x);
/// Mode::residual.
double residual_of(const Linearisation& linear, const Mode& mode, bool with_damping);

}  // namespace bough::step
