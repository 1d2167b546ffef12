#pragma once
/// Nodes that joints move as prescribed (Plan::driven), eliminated before the linear solver: internal to step. With h such nodes, W the columns and
/// V^T the rows of the joints that move them (V = W but for integrators that take them at different times), o the multipliers of other joints,
///   [K_ff G_of^T K_fh 0; G_of 0 G_oh 0; K_hf G_oh^T K_hh W; 0 0 V^T 0] (x_f, mu_o, eta_h, mu_h) = (r_f, r_o, r_h, r_rows)
///   eta_h = V^-T r_rows,   [K_ff G_of^T; G_of 0] (x_f, mu_o) = (r_f - K_fh eta_h, r_o - G_oh eta_h),
///   mu_h = W^-1 (r_h - K_hf x_f - G_oh^T mu_o - K_hh eta_h)
/// V and W are square, 6 x 6 at most, one of each a node. The solution is that of the whole system, so nothing else knows a difference.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "held_nodes.hpp"

namespace bough::step {

class DrivenNodes {
 public:
  /// trims: learns where the matrices of elements at driven nodes are kept whole.
  DrivenNodes(const System& system, HeldNodes& trims);

  /// Whether the matrix of an element is kept whole here, and that matrix, row-major; unknowns: by its rows, -1: of a node at rest.
  bool has(std::size_t element) const { return place_[element] >= 0; }
  solve::ElementView matrix(std::size_t element) { return {values_.data() + kept(element).values, 1}; }
  std::span<const std::int64_t> unknowns(std::size_t element) const { return unknowns_of(kept(element)); }

  /// (A + A^T) / 2 in place of an element's matrix.
  void symmetrise(std::size_t element);

  /// V^-T and W^-1 of the matrices now present; a node (index in Plan::driven) whose rows depend on each other, if there is one.
  [[nodiscard]] std::optional<std::size_t> factor();
  /// Sets eta_h in x and returns the right-hand side of the others, in the order of the solver.
  const double* reduce(const double* rhs, double* x);
  /// Sets mu_h in x, in which all else is known.
  void complete(const double* rhs, double* x) const;
  /// y, whose part of the solver is K_ff x_f of its own matrix, becomes the product of the whole.
  void add_product(const double* x, double* y) const;

 private:
  /// Kinds of unknowns: of the solver, of the motion of a driven node, of the rows that move it.
  enum Kind { of_free, of_motion, of_row, num_kinds };
  struct Kept {
    std::size_t element;
    int size;
    std::size_t unknowns;              ///< first in unknowns_
    std::size_t values;                ///< first in values_
    std::size_t local[num_kinds + 1];  ///< by kind, and the end: ranges in local_
  };
  Kind kind_of(std::int64_t unknown) const;
  const Kept& kept(std::size_t element) const { return kept_[static_cast<std::size_t>(place_[element])]; }
  std::span<const std::int64_t> unknowns_of(const Kept& k) const {
    return {unknowns_.data() + k.unknowns, static_cast<std::size_t>(k.size)};
  }
  /// Rows of an element's matrix whose unknowns are of these kinds.
  std::span<const int> local(const Kept& k, Kind first, Kind last) const {
    return {local_.data() + k.local[first], k.local[last + 1] - k.local[first]};
  }
  /// Sum over the columns of these kinds of a_ij x_j.
  double product(const Kept& k, int row, Kind first, Kind last, const double* x) const;
  /// First unknown of a driven node; its rows follow, as many.
  std::int64_t first_of(std::size_t driven) const { return num_free_ + 2 * n_ * static_cast<std::int64_t>(driven); }

  std::int64_t num_free_;  ///< unknowns of the solver, which come first
  std::int64_t n_;         ///< unknowns of a node
  std::size_t num_driven_;
  std::vector<int> place_;  ///< by element: index in kept_, or -1
  std::vector<Kept> kept_;
  std::vector<std::int64_t> unknowns_;
  std::vector<int> local_;
  std::vector<double> values_;
  std::vector<double> inverse_rows_, inverse_columns_;  ///< by driven node, row-major: V^-T, W^-1
  std::vector<double> rest_;                            ///< right-hand side of the solver
};

}  // namespace bough::step
