#pragma once
/// Options of the linear solvers.
#include <string>
#include <vector>

namespace bough::solve {

/// Check of a solution in solve().
enum class SolveCheck {
  none,  ///< the backward error is not computed (NaN in the report).
  /// Normwise, by one more product with the element matrices, which must still be the factored ones. |A| is that of the
  /// matrix from which the scales were computed.
  backward_error,
};

/// Properties of the values that the caller declares.
enum class Symmetry {
  general,    ///< structure symmetric, values not: L U.
  symmetric,  ///< every element matrix is symmetric, definite or not: L D L^T.
};

struct SolveOptions {
  /// Symmetric: half the work, less memory. Every factorization checks every element matrix
  /// (unless Hierarchical::trust_symmetry() is set). If one differs from its transpose, the solver permanently changes
  /// to general and reports it in Hierarchical::symmetry().
  Symmetry symmetry = Symmetry::general;
  /// The root's front is stored as assembled, for Hierarchical::inertia().
  bool inertia = false;
  /// Equal sub-domains are factored in lockstep, eight per pack.
  bool lanes = true;
  /// Bytes of matrices and factors in lanes above which a factorization prefetches its input and writes
  /// factors past the caches. Results have the same bits. 0: an eighth of the last cache, which other programs use as
  /// well, but at least 16 MB.
  std::int64_t near_bytes = 0;
  double penalty_factor =
      1.0;  ///< P = factor x the interface's own stiffness |diag S| [-], > 0. Hierarchical: of reports alone.
  double multiplier_scale = 1.0;  ///< Augmented: s of the local multipliers [-], > 0, in scaled variables.
  double pivot_threshold =
      1e-2;  ///< u [-], 0 < u <= 1: a pivot of at least u times its column's largest entry is accepted.
  double tiny_pivot = 1e-10;  ///< [-] in scaled variables: smaller pivots are delayed to the parent front.
  double rank_tolerance =
      1e-10;  ///< [-] scaled distance to a singular matrix below which constraint rows are dependent.
  /// Relative precision of the entries of constraint rows [-]; 0: they have none but round-off. Rows that depend on each
  /// other within it count as dependent.
  double data_precision = 0.0;
  double singular_tolerance =
      2e-16;  ///< [-] the same if motion is part of the null vector: the matrix is singular. (Observed: 1e-16 / 4.)
  double null_motion_tolerance =
      1e-5;  ///< [-] largest motion part of a unit null vector that still counts as multipliers only.
  SolveCheck check = SolveCheck::backward_error;
  /// Largest number of refinement steps, >= 0; each is taken only if the backward error is above refinement_above.
  int refinement_steps = 1;
  double refinement_above =
      1e-14;  ///< normwise backward error [-] above which a refinement step is taken (needs check = backward_error).
};

/// Describes what is wrong with the options; empty if nothing is.
std::vector<std::string> problems_in(const SolveOptions& options);

}  // namespace bough::solve
