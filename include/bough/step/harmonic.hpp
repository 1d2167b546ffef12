#pragma once
/// Steady vibrations of the linearised equations of a plan under harmonic forces.
#include <complex>
#include <memory>
#include <span>
#include <vector>

#include "bough/step/linearisation.hpp"
#include "bough/tree/tree.hpp"

namespace bough::step {

/// Solves  (K + i w C - w^2 M) x + G^T y = f,  G x = 0  directly, one factorization a frequency. The solver is real: it
/// factors
///   [A, -B; B, A] (Re x; Im x) = (Re f; Im f),   A = K - w^2 M, B = w C, with G in A
/// on a graph in which every block has a twin, so that its fronts have twice the rows, and a solution takes four times
/// the work of one with complex numbers. Allocates.
class Harmonic {
 public:
  using Vector = std::vector<std::complex<double>>;  ///< by unknown

  /// Keeps the reference; K, C and M are those that it has when factor() is called.
  explicit Harmonic(const Linearisation& linear);

  [[nodiscard]] solve::FactorStatus factor(double angular_frequency);
  /// Solves with the factors, and corrects the solution once by its residual. Returns what is left of the equations,
  /// |A x - f| over the sum of the magnitudes of their terms: of forces and moments together, of constraints together, and
  /// of each signal; the largest. Not finite: there is no solution.
  double solve(std::span<const double> f, Vector& x);

 private:
  void residual(std::span<const double> f, const Vector& x, Vector& left, std::vector<double>& size) const;
  bool correct(const Vector& left, Vector& x);

  const Linearisation& linear_;
  double w_ = 0.0;
  blocks::BlockGraph graph_;
  tree::Tree tree_;
  solve::Hierarchical factored_;
  std::vector<double> rhs_, solution_;
};

}  // namespace bough::step
