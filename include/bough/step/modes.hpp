#pragma once
/// Modes of the linearised equations of a plan at a state: motions x exp(lambda t).
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "bough/step/linearisation.hpp"

namespace bough::step {

struct Mode {
  std::complex<double> eigenvalue;          ///< lambda [1/s]; of a pair the one with a positive imaginary part
  std::vector<std::complex<double>> shape;  ///< x by unknown, with the multipliers that belong to it
  double residual = 0.0;                    ///< |(K + lambda C + lambda^2 M) x + G^T y| over the size of its terms [-]
  bool is_rigid = false;                    ///< it takes no energy: lambda is zero to round-off

  /// Of a vibration, undamped [rad/s].
  double frequency() const { return std::abs(eigenvalue); }
  bool vibrates() const { return !is_rigid && eigenvalue.imag() > 0.0; }
  bool grows() const { return !is_rigid && eigenvalue.real() > 1e-9 * frequency(); }  ///< by more than round-off
};

struct ModesWanted {
  int count = 10;      ///< of vibrations, the slowest or those nearest to the shift
  double shift = 0.0;  ///< [rad/s]
};

struct ModesFound {
  std::string cause;         ///< why there are none; empty: there are
  std::vector<Mode> modes;   ///< rigid ones, then by frequency
  bool is_symmetric = true;  ///< K and M are, and there is no C: modes are real
  /// How many modes that are not listed lie below the last one, or between the first and the last where there is a
  /// shift, by the inertia of factors; none: it is not known.
  std::optional<int> missing;
  /// Of complex modes: how many below the last one were found that meet the equations to 1e-3 only, and are not listed.
  int inexact = 0;
};

/// Undamped modes, C left out and K taken symmetric:  K x + G^T y = omega^2 M x,  G x = 0.  Lanczos' method for
///   [K - s M, G^T; G, 0]^-1 M
/// which has the eigenvalues 1 / (omega^2 - s) and no others that are not zero, so that massless motions and constraint
/// rows, also ones that depend on each other, leave no trace once the first vector lies in its range. The shift s is
/// zero, or a little below where something moves without resistance. Vectors of rigid motions and of modes that were
/// found are locked, and the method begins anew until their number is that which the inertia of a second factor proves:
/// modes of equal frequency are complete.
ModesFound find_undamped_modes(Linearisation& linear, const ModesWanted& wanted);

/// Modes of the whole equations, damped, gyroscopic, or with loads that follow:  (lambda^2 M + lambda C + K) x + G^T y =
/// 0,  G x = 0.  Arnoldi's method for the inverse of the companion form at one real shift s, with the factor of K + s C +
/// s^2 M:
///   x' = -(K + s C + s^2 M)^-1 (M z + (C + s M) x),  z' = x + s x'    eigenvalues 1 / (lambda - s),  z = lambda x
/// Nothing proves that none is missing; a second start has to find the same.
ModesFound find_complex_modes(Linearisation& linear, const ModesWanted& wanted);

}  // namespace bough::step
