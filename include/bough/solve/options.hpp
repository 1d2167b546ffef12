#pragma once
/// Options of the linear solvers.
#include <string>
#include <vector>

namespace bough::solve {

/// How a sub-domain is condensed to its interface.
enum class Elimination {
  flat,  ///< boundary last: S appears without the penalty ever having been added; no digit depends on the penalty.
  plain,  ///< through the interface flexibility, S = s^2 F^-1 - P: the textbook form, loses a digit for each decade of penalty.
};

/// What solve() checks afterwards.
enum class SolveCheck {
  none,            ///< backward errors are not computed (NaN in the report).
  backward_error,  ///< normwise, from the element matrices: one more product with the matrix. These must still be the factored ones. |A| is
                   ///< that of the matrix from which the scales were taken.
  componentwise,   ///< both, at the price of a second product.
};

/// What the caller knows of the values.
enum class Symmetry {
  general,    ///< structure symmetric, values not: L U.
  symmetric,  ///< every element matrix is symmetric, definite or not: L D L^T.
  definite,   ///< the same, and their sum is expected to be positive definite: L D L^T without a search for pivots.
};

struct SolveOptions {
  Elimination elimination = Elimination::flat;
  /// Symmetric: half the work, less memory (flat elimination only). Every factorization looks at every element matrix
  /// (unless Hierarchical::trust_symmetry()); where one differs from its transpose the solver goes over to general
  /// for good and says so in Hierarchical::symmetry(). Definite: a front with a pivot that is not positive, or below
  /// tiny_pivot, is factored as a symmetric one; the declaration stays (SolverCounters::indefinite_fronts).
  Symmetry symmetry = Symmetry::general;
  /// Schur complements of all sub-domains last, so that factor() may leave alone what has not changed; more memory.
  bool partial = false;
  /// The root's front is kept as it is assembled, for Hierarchical::inertia().
  bool inertia = false;
  bool lanes =
      true;  ///< equal sub-domains are factored in lockstep, eight to a pack, small leaves alone in registers (flat elimination only).
  /// Bytes of matrices and factors in lanes and registers above which a factorization asks for what it reads before
  /// it needs it, and writes factors past the caches. Bits are the same. 0: an eighth of the last cache, which others
  /// use as well, but 16 MB at least.
  std::int64_t near_bytes = 0;
  double penalty_factor =
      1.0;  ///< P = factor x the interface's own stiffness diagonal [-], > 0. Flat: only in what is reported.
  double multiplier_scale = 1.0;  ///< s of the local multipliers [-], > 0, in scaled variables.
  double pivot_threshold =
      1e-3;                   ///< u [-], 0 < u <= 1: a pivot of at least u times its column's largest entry is taken.
  double tiny_pivot = 1e-10;  ///< [-] in scaled variables: smaller pivots wait for the parent front.
  double rank_tolerance =
      1e-10;  ///< [-] scaled distance to a singular matrix below which constraint rows are dependent.
  double singular_tolerance =
      2e-16;  ///< [-] the same where motion is part of the null vector: the matrix is singular. (Found: 1e-16 / 4.)
  double null_motion_tolerance =
      1e-5;  ///< [-] largest motion part of a unit null vector that still counts as multipliers only.
  SolveCheck check = SolveCheck::backward_error;
  int refinement_steps =
      1;  ///< most steps of iterative refinement, >= 0; each only if the backward error is above refinement_above.
  double refinement_above =
      1e-14;  ///< normwise backward error [-] that calls for a refinement step (needs check = backward_error).
};

/// What is wrong with the options; empty when nothing is.
std::vector<std::string> problems_in(const SolveOptions& options);

}  // namespace bough::solve
