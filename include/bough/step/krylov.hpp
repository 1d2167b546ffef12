#pragma once
/// Krylov spaces of an operator that solves with a factored matrix, for eigenvalues.
#include <cmath>
#include <complex>
#include <functional>
#include <span>
#include <vector>

namespace bough::step {

/// Arnoldi's method with every vector orthogonalised against all others, twice:
///   A V_m = V_m H_m + h_{m+1,m} v_{m+1} e_m^T,   V_m^T B V_m = 1
/// For A that is symmetric with respect to B, H is tridiagonal but for round-off (Lanczos). B may be semi-definite if
/// the first vector lies in the range of A. The vectors may have entries that B does not see, as multipliers.
class Krylov {
 public:
  using Vector = std::vector<double>;
  /// y = A x or y = B x; false: it failed.
  using Operation = std::function<bool(const Vector& x, Vector& y)>;

  Krylov(Operation apply, Operation weigh) : apply_(std::move(apply)), weigh_(std::move(weigh)) {}

  /// Keeps vectors orthogonal to this one, which has unit length with respect to B, from now on.
  void lock(const Vector& x);
  /// Removes what lies along locked vectors and scales x to unit length. False: nothing is left.
  bool normalise(Vector& x);
  /// With respect to B; 0 where that fails.
  double length(const Vector& x) { return std::sqrt(square(x)); }
  /// |A v| of the first vector of the space, which has been extended.
  double stretch() const;
  /// A new space from A A x. False: it is empty, or an operation failed.
  bool begin(const Vector& x);
  /// Adds vectors until there are so many, or the space is invariant. False: an operation failed.
  bool extend(int size);
  int size() const { return static_cast<int>(columns_.size()); }
  bool is_invariant() const { return is_invariant_; }

  /// Eigenvalues of H and their vectors, as combinations of the basis.
  struct Ritz {
    std::complex<double> value;
    std::vector<std::complex<double>> combination;  ///< of unit length
    double residual = 0.0;                          ///< |A x - value x| with respect to B
  };
  /// symmetric: A is symmetric with respect to B, and values are real. The largest values come first,
  /// and those that are zero to round-off are left out.
  std::vector<Ritz> eigenvalues(bool symmetric) const;
  std::vector<std::complex<double>> vector_of(const Ritz& ritz) const;

 private:
  double square(const Vector& x);

  Operation apply_, weigh_;
  std::vector<Vector> locked_, basis_;
  std::vector<Vector> columns_;  ///< of H, each with its entry below the diagonal
  Vector weighed_;
  double largest_ = 0.0;  ///< |A v| so far
  bool is_invariant_ = false;
};

}  // namespace bough::step
