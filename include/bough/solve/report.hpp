#pragma once
/// Reports of factorizations and solutions. Failures are values, never exceptions.
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "bough/solve/options.hpp"
#include "bough/tree/tree.hpp"

namespace bough::solve {

enum class FactorOutcome {
  ok,           ///< regular, or singular in dependent constraint rows only (see deficiency).
  singular,     ///< a motion unknown is not held (under-constrained, or in no element).
  not_finite,   ///< an element matrix holds NaN or infinity.
  backend,      ///< an external solver failed otherwise, or is not part of this build (monolithic only).
  unsymmetric,  ///< the chosen library solves symmetric matrices only (CHOLMOD).
};

/// Outcome of factor(). If several fronts fail, the lowest one is reported.
struct FactorStatus {
  FactorOutcome outcome = FactorOutcome::ok;
  tree::FrontId front = tree::none;  ///< where the failure was found.
  int block = -1;                    ///< block with the largest share in the failure; -1 if ok.
  int local = -1;                    ///< unknown within the block.
  double magnitude = 0.0;            ///< the pivot, or the share of the block in the null vector [-].
  int deficiency = 0;      ///< dependent constraint rows (or null vectors if singular); -1: unknown (monolithic).
  int delayed_pivots = 0;  ///< pivots that moved to a parent front, counted once per move.
  bool ok() const { return outcome == FactorOutcome::ok; }
};

/// Outcome of solve(), in scaled variables without units.
struct SolveReport {
  /// For the part of b that has a solution, and for A without entries taken to be zero (see inconsistency and
  /// rank_error).
  double backward_error = std::numeric_limits<double>::quiet_NaN();  ///< |r| / (|A| |x| + |b|), maximum norms, scaled.
  int refinement_steps = 0;
  int deficiency = 0;  ///< as in FactorStatus.
  double inconsistency =
      0.0;  ///< |Y^T b| / |b|, Y the left null vectors: 0 if dependent constraints agree with each other.
  double rank_error =
      0.0;  ///< |T x| / (|A| |x| + |b|), T the part of A taken to be zero because its rows depend on others.
  int inconsistent_block = -1;       ///< block with the largest part of Y Y^T b.
  double inconsistent_amount = 0.0;  ///< that part, in the units of the block's right-hand side.
  double growth =
      0.0;  ///< |x| / |b|, maximum norms, scaled: a lower bound of |A^-1|. Near 1/eps: singular for this load.
  int growth_block = -1;            ///< block with the largest scaled unknown.
  bool finite = true;               ///< false: the solution holds NaN or infinity.
  int interface_iterations = 0;     ///< of the interface problem, refinement included (forms with global multipliers).
  bool interface_converged = true;  ///< false: the iteration on the interface problem did not converge.
};

/// Why values that were declared symmetric are not factored as such.
enum class SymmetryLoss {
  none,    ///< they are, or they were not declared symmetric.
  values,  ///< an element matrix differs from its transpose: SymmetryReport::element.
};

/// The factorization that a solver uses, and why.
struct SymmetryReport {
  Symmetry declared = Symmetry::general;
  Symmetry used = Symmetry::general;
  SymmetryLoss loss = SymmetryLoss::none;
  int element = -1;         ///< the first one that differs, by visit and by order within the visit.
  int block = -1;           ///< its first block.
  double difference = 0.0;  ///< largest entry of its D (A - A^T) D [-], scaled variables; above 1e-9.
};

/// Signs of eigenvalues, from the pivots of a factorization.
struct Inertia {
  /// Negative eigenvalues of a symmetric A, by Sylvester's law as many as negative pivots, as long as rows and columns
  /// are exchanged together (-1: they were not). Zero eigenvalues from dependent rows are not counted.
  int negative = -1;
  /// Sign of the determinant of A, symmetric or not; 0: unknown (dependent rows).
  int determinant = 0;
};

/// Matrices of an interface on its tied displacements, in scaled variables, by columns. Those of the scene's units are
/// D_r^-1 S D_c^-1 and D_c F D_r, with the scales of rows and columns (Hierarchical::row_scale, column_scale).
struct InterfaceMatrices {
  std::vector<std::int64_t> unknowns;  ///< of the tree's numbering
  std::vector<double> stiffness;       ///< S: the sub-domain condensed to its interface
  std::vector<double> penalty;         ///< the diagonal of P
  std::vector<double> flexibility;     ///< F = (S + P)^-1, of multipliers with s = 1
};

/// Interface of one sub-domain, or the one interface problem of a form with global multipliers, after factor().
/// Scaled variables.
struct InterfaceReport {
  tree::SubdomainId subdomain = tree::none;
  int level = 0;
  int num_unknowns = 0;               ///< motion unknowns and multipliers tied to the interface mesh.
  int num_delayed = 0;                ///< unknowns whose pivots were delayed past this interface.
  double condition = 1.0;             ///< of P^1/2 F P^1/2 on the tied displacements, F = s^2 (S + P)^-1 (2-norm).
  std::vector<double> spectrum = {};  ///< singular values of P^1/2 F P^1/2, descending; empty where not computed
  InterfaceMatrices matrices = {};    ///< empty unless asked for
  bool is_definite = true;  ///< S is positive, up to round-off: only then the condition is bounded by its size.
  int num_coarse = 0;  ///< global multipliers: unknowns of the coarse problem (interface mesh and floating directions).
  int num_floating = 0;  ///< global multipliers: of these, directions in which sub-domains float or nearly do.
  double flops = 0.0;    ///< of the interface problem, one factorization (iterative: the last solution) [flop].
  double seconds =
      std::numeric_limits<double>::quiet_NaN();  ///< CPU time of the same [s]; NaN if it is not measured separately.
  int iterations = 0;                            ///< of the last solution; 0 for a direct solution.
};

/// Running totals of one solver object.
struct SolverCounters {
  std::int64_t memory_bytes = 0;  ///< numeric storage.
  double factor_flops = 0.0;      ///< estimate of one factorization without delays [flop].
  std::int64_t factorizations = 0;
  std::int64_t solutions = 0;
  std::int64_t delayed_pivots = 0;         ///< over all factorizations.
  std::int64_t enlarged_fronts = 0;        ///< fronts that took delayed pivots, over all factorizations.
  std::int64_t enlarging_allocations = 0;  ///< heap allocations these needed.
  std::int64_t fronts_in_lanes = 0;        ///< fronts of the tree that are factored in lockstep.
  double flops_in_lanes = 0.0;             ///< the part of factor_flops in these fronts [flop].
  std::int64_t packs_of_fronts = 0;        ///< these fronts, those that share a pack counted once.
  double flops_of_packs = 0.0;             ///< of one lane of each pack, filled up to the largest of its fronts [flop].
  std::int64_t factor_bytes = 0;
  double columns_alone = 0.0;  ///< unknowns eliminated in fronts outside of lanes.
  double panels_alone = 0.0;   ///< sum over these unknowns of the sizes of their fronts.
  std::int64_t lanes_left =
      0;  ///< fronts that left their lane for scalar elimination with pivoting, over all factorizations.
};

/// Work of the caller in the visits of a walk (SolverVisits): on the way up before the elements of a visit are
/// assembled and its right-hand side is condensed, on the way down after its unknowns are known. May run concurrently
/// for different visits, never for a visit before its children on the way up, or before its parent on the way down.
struct VisitWork {
  void (*run)(void* context, int visit) = nullptr;
  void* context = nullptr;
  explicit operator bool() const { return run != nullptr; }
  void operator()(int visit) const { run(context, visit); }
};

/// A VisitWork that calls `body(visit)`; body must outlive the walk.
template <class Body>
VisitWork make_visit_work(Body& body) {
  return {[](void* context, int visit) { (*static_cast<Body*>(context))(visit); }, &body};
}

/// The visits of a solver's walks: a sub-domain, or several in lockstep. A solver without sub-domains has one.
struct SolverVisits {
  std::vector<int> parent;       ///< by visit; -1 at the root, which is the last. Children come before parents.
  std::vector<int> batch_begin;  ///< by visit: its first batch in batches(), and the number of batches at the end.
  std::vector<int> of_block;     ///< by block: the visit that eliminates its unknowns.
  int count() const { return static_cast<int>(parent.size()); }
};

}  // namespace bough::solve
