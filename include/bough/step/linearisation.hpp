#pragma once
/// The linearised equations of a plan at a state, in the unknowns of the linear solver:
///   M x'' + C x' + K x + G^T dlambda = f,   G x = 0
/// x are increments of nodes in their own axes and changes of signals, dlambda changes of multipliers. The matrices are
/// those of the exact tangent: K holds second derivatives of constraint rows times multipliers, loads that follow, and
/// what velocities and accelerations of the state contribute to inertia; C gyroscopic terms as well as dampers.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bough/step/system.hpp"

namespace bough::step {

/// The matrix  stiffness K + damping C + mass M + weights N + of_diagonal |diag K|,  with G as it is. N is the diagonal
/// of Linearisation::weights().
struct Combination {
  double stiffness = 1.0, damping = 0.0, mass = 0.0;
  double weights = 0.0, of_diagonal = 0.0;
};

/// Copies of the matrices by element, and one factored combination of them. Allocates.
class Linearisation {
 public:
  enum class Part : std::uint8_t { stiffness, damping, mass };
  using Vector = std::vector<double>;  ///< by unknown

  /// `system` must outlive it.
  explicit Linearisation(System& system);

  /// Evaluates K, C and M at a state, to whose time the system is set. The tangents in the system are overwritten.
  [[nodiscard]] std::optional<Trouble> take(const State& state);
  /// Copies the tangents that are present in the system as K. There are no C and M then.
  void take_tangents();
  /// Adds  factor (K - K_other)  to C or M, between motions: entries of constraint rows stay zero. `other` is of the same
  /// system.
  void add_difference(Part to, double factor, const Linearisation& other);
  /// Puts (A + A^T) / 2 in place of a matrix.
  void take_symmetric_part(Part part);
  /// Puts (C - C^T) / 2 in place of C for elements that dissipate energy.
  void leave_out_dampers();
  /// Removes what motions and signals do to each other: signals then stay as they are.
  void leave_out_signals();
  /// Describes motions from axes that stand still at the velocities of the state. With v the velocity of a node, H = H_0
  /// exp(x) exp(v t), so that
  ///   C <- C - M ad(v),  ad(v) x = (w_v x u + u_v x w; w_v x w)   for v = (u_v; w_v), x = (u; w).
  /// Where the parts that turn are symmetric about their axes, K, C and M are then the same at all times. Requires
  /// nodes in space, as the next.
  void describe_from_ground(const State& state);
  /// Describes motions from the nodes' own axes, which move on: H = H_0 exp(v t) exp(x), so that
  ///   K <- K + C ad(v),  C <- C + M ad(v)
  /// Where the whole structure turns as one, K, C and M are then the same at all times.
  void describe_from_parts(const State& state);

  System& system() const { return system_; }
  std::size_t size() const { return weights_.size(); }
  /// Of squares of unknowns, for inner products without units: 1 / L^2 of displacements, L the size of the structure, 1
  /// of rotations and signals, 0 of multipliers.
  const Vector& weights() const { return weights_; }
  double inner(std::span<const double> x, std::span<const double> y) const;
  /// The node that moves most.
  int largest_node(std::span<const double> x) const;
  int num_rows() const { return num_rows_; }  ///< of constraints, of which the solver knows

  /// y = A x; multipliers count in K alone, as G^T and G.
  void multiply(Part part, std::span<const double> x, std::span<double> y) const;
  /// y = |A| |x|, entry by entry of the matrices of elements: what rounds the product.
  void multiply_magnitudes(Part part, std::span<const double> x, std::span<double> y) const;
  /// x^T A y of one element, multipliers left out.
  double form(Part part, int element, std::span<const double> x, std::span<const double> y) const;
  /// Round-off of x^T A x, multipliers left out: 64 eps sum |x_i| |A_ij| |x_j| over all elements.
  double round_off(Part part, std::span<const double> x) const;
  /// Entries of the matrix of an element, row after row, in the order of unknowns_of.
  std::span<const double> matrix_of(Part part, int element) const;
  bool is_multiplier(std::size_t unknown) const { return is_row_[unknown] != 0; }
  int num_elements() const { return static_cast<int>(unknown_begin_.size()) - 1; }
  /// The unknowns of an element, in the order of its rows.
  std::span<const std::int64_t> unknowns_of(int element) const;
  /// Largest entry of (A - A^T) y over (|A| + |A^T|) |y| for a vector y without zeros, row by row: 0 for a matrix that
  /// is symmetric as a sum over all elements.
  double asymmetry(Part part) const;
  double largest(Part part) const;  ///< magnitude of an entry
  /// Largest K_ii / M_ii, sums over elements, of unknowns that have mass: a bound of squared frequencies as to its
  /// order. 0: there is no mass, or no stiffness.
  double fastest() const;

  /// Factors a combination. symmetric: the symmetric parts of the matrices of elements are factored.
  [[nodiscard]] solve::FactorStatus factor(const Combination& of, solve::Symmetry symmetry);
  /// The same, with a trial: the solution under the forces of known motions and multipliers has these forces again, to
  /// 1e-9. Where bodies have no stiffness of their own and rows of constraints depend on each other, it does not always,
  /// although the factorization tells of no fault. False: it failed.
  [[nodiscard]] bool factor_soundly(const Combination& of, solve::Symmetry symmetry);
  /// x = A^-1 rhs, may be the same. False: it is not finite.
  [[nodiscard]] bool solve(std::span<const double> rhs, std::span<double> x);
  solve::Hierarchical& solver() { return *factored_; }  ///< of the combination that was factored last
  /// Negative eigenvalues on the motions that the constraints allow, by those of [A G^T; G 0] less the rank of G; -1:
  /// not known. The combination was factored symmetrically.
  int num_negative();
  long factorizations() const { return factorizations_; }
  long solutions() const { return solutions_; }

 private:
  const Vector& of(Part part) const { return parts_[static_cast<std::size_t>(part)]; }
  std::size_t size_of(int element) const { return unknowns_of(element).size(); }
  void copy_tangents(Vector& to, bool beside_stiffness) const;
  void mix_with_transpose(Part part, int element, double sign);
  void add_product(Part to, double factor, Part of, const State& state);
  template <class Entry>
  void multiply_entries(Part part, std::span<double> y, Entry&& entry) const;
  Vector diagonal_of(Part part) const;
  void write(const Combination& of, bool symmetric);

  System& system_;
  std::vector<std::int64_t> unknown_begin_, unknowns_, matrix_begin_;  ///< by element
  std::vector<char> is_row_;                                           ///< by unknown: a multiplier
  Vector weights_;
  int num_rows_ = 0;
  std::array<Vector, 3> parts_;  ///< matrices of elements one after the other, row-major
  solve::Symmetry symmetry_ = solve::Symmetry::general;
  std::unique_ptr<solve::Hierarchical> factored_;  ///< made when first needed
  long factorizations_ = 0, solutions_ = 0;
};

}  // namespace bough::step
