#pragma once
/// All storage of the hierarchical solver. Internal to solve.
#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "bough/solve/hierarchical.hpp"
#include "dense.hpp"
#include "element_store.hpp"
#include "front_storage.hpp"
#include "lane_kernels.hpp"
#include "lane_plan.hpp"
#include "lane_scales.hpp"
#include "moves.hpp"
#include "null_vectors.hpp"
#include "transfers.hpp"

namespace bough::solve {

/// Data of one front. All pointers refer to the pools of State, except for fronts with delayed pivots, and for fronts
/// that left lanes.
struct FrontData {
  double* a = nullptr;  ///< the parts of FrontMatrix
  double* u = nullptr;
  double* s = nullptr;  ///< may be reused after the parent has been eliminated
  double* d = nullptr;  ///< null: not factored as a symmetric one
  int lda = 0, ldu = 0, lds = 0;
  double* vector = nullptr;  ///< size: right-hand side, then [y; g]
  int* rows = nullptr;       ///< full: global unknown of each fully summed row, in pivot order
  int* columns = nullptr;
  int* row_from = nullptr;  ///< full: row before pivoting
  int size = 0, full = 0, pivots = 0;
  int dependent = 0;              ///< of those without a pivot: rows and columns decided here, the last ones
  int delayed_in = 0;             ///< unknowns that children could not eliminate: they come first
  int delayed_to = 0;             ///< row of the parent of the first unknown that it delays itself
  bool failed = false;            ///< not finite here or below
  bool rows_in_order = false;     ///< no pivot has exchanged rows
  bool columns_in_order = false;  ///< nor the columns of its own unknowns
  bool allocated = false;         ///< enlarging it allocated memory in this factorization
  int num_delayed() const { return full - pivots - dependent; }
  bool is_symmetric() const { return d != nullptr; }
  void set_parts(const FrontShape& shape, double* factor, double* schur);
  FrontMatrix matrix() const { return {a, size, full, rows, columns, row_from, lda, u, ldu, s, lds, d}; }
};

/// Memory of a front enlarged by delayed pivots, kept for the next time.
struct Enlarged {
  LaneDoubles a;
  std::vector<double> vector;
  std::vector<int> indices;
};

enum class NullSide { right, left };

/// A node's share of constraint forces up to which they cancel, and the share of the largest forces below which they
/// do not count: see forces_cancel().
constexpr double passing_force = 3e-2, insignificant_force = 1e-3;
constexpr double units_of_precision = 1024.0;  ///< of the data, up to which forces cancel: the sum of many entries

/// Dependent rows, and what follows from them: those that the root has found by singular values, and those decided in
/// fronts.
struct NullSpace {
  int dimension = 0;                    ///< of the root
  bool took_vectors = false;            ///< the storage of the condensed right-hand side was used for candidates
  std::vector<double> right;            ///< dimension x unknowns, orthonormal in the weighted norm; scaled variables
  std::vector<double> left;             ///< dimension x unknowns, orthonormal
  NullVectors local_right, local_left;  ///< of fronts; scaled variables
  bool has_left = false;
  std::vector<tree::FrontId> dependent_fronts;  ///< that decided, ascending
  // Scratch.
  SparseRows rows{NullVectors::most};        ///< entries of the present vectors
  SparseRows forces{2 * NullVectors::most};  ///< by motion unknown: sums and sums of magnitudes
  std::array<double, NullVectors::most> largest{};
  std::vector<tree::FrontId> passed, waiting;
  std::vector<int> overlapping, group_of_front, remaining_rows, remaining_columns;
  std::vector<double> remaining_values, values;
  std::vector<std::pair<std::int64_t, const double*>> columns_with_entries;  ///< of an element

  int deficiency() const { return dimension + local_right.num_vectors(); }
};

/// The root's front before it is eliminated, square, and room to eliminate it in.
struct RootCopy {
  std::vector<double> entries, d;
  std::vector<int> indices;
  int size = 0;
  bool is_square = false;  ///< its rows are those of its columns
  int negative = -1;       ///< eigenvalues, once counted
};

/// Root pivots below this, scaled, are examined before they are used.
constexpr double suspect_pivot = 1e-5;

/// Largest scaled magnitudes that one group found.
struct SolutionSizes {
  double residual = 0.0, rhs = 0.0, x = 0.0;
};

/// Largest number of doubles of Schur complements and vectors on the stack of a visit.
constexpr std::int64_t room_of_scratch = 1 << 14;

/// Largest number of unknowns of a front whose substitutions have their scratch on the stack instead of behind its
/// vector.
constexpr std::int64_t room_of_vector = 1 << 11;
/// Doubles of a vector and of the scratch behind it.
inline std::int64_t vector_size(std::int64_t unknowns) { return unknowns <= room_of_vector ? unknowns : 2 * unknowns; }

struct Hierarchical::State {
  State(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options);

  const tree::Tree& tree;
  SolveOptions options;
  LanePlan lanes;
  ElementStore elements;
  Scales scales;
  std::vector<double> inverse_column;  ///< 1 / scales.column, exact
  bool scales_wanted = true;
  std::unique_ptr<bool[]> is_constraint;  ///< by unknown

  std::vector<FrontData> fronts;
  std::vector<Enlarged> enlarged;  ///< by front
  std::vector<std::int64_t> factor_begin, vector_begin, index_begin, run_begin,
      row_begin;  ///< by front, into the pools
  SymmetryReport symmetry;
  bool trusts_symmetry = false;
  std::vector<Asymmetry> asymmetries;  ///< by group: the first that the visit found
  SchurPlaces schur_places;
  LaneDoubles factor_pool, schur_pool;
  std::vector<double> vector_pool;
  std::vector<int> index_pool;
  std::vector<int> row_unknowns;  ///< unknowns of the rows of every front: eliminated ones, then the boundary (pool)
  std::vector<Run> runs;          ///< of the boundaries of fronts, in their parents (pool)
  std::vector<Run> element_runs;  ///< of the blocks of elements, by tree::Tree::scatter_begin
  std::vector<tree::FrontId> scalar_fronts;  ///< fronts that are never in lanes
  NullSpace null_space;
  std::vector<char> leaves_to_root;  ///< by front: its rows turned out not to be dependent, in the present scales
  RootCopy root_copy;                ///< SolveOptions::inertia
  std::vector<int> row_of_column;    ///< scratch of inertia()
  double* x = nullptr;               ///< of the present solution: the caller's array
  const double* given = nullptr;     ///< its right-hand side
  std::vector<double> rhs;           ///< a copy, if the caller's would be overwritten
  std::vector<double> residual;      ///< and scratch
  std::vector<double> correction;

  // Sub-domains in lockstep: packs of eight lanes.
  LaneDoubles lane_scratch, lane_tops, lane_factors;
  LaneDoubles lane_vectors;  ///< of eliminated unknowns, after forward substitution
  LaneScales lane_scales;
  /// By group, during its visit: memory of Schur complements and vectors that are not needed afterwards.
  std::vector<double*> group_scratch;
  std::vector<LaneSet> leaving_lanes;  ///< by front of LanePlan: left in the last factorization for dependent rows
  std::vector<LaneSet> scalar_lanes;  ///< by front of LanePlan: lanes that needed the scalar path in this factorization
  std::vector<SolutionSizes> sizes;   ///< by group
  /// Matrices and factors do not stay in the caches between walks: they are prefetched, and written past the caches.
  bool exceeds_caches = false;
  bool reads_factors_ahead = false;   ///< factors do not stay in the nearer caches
  bool fronts_are_far = false;        ///< the same of fronts on the scalar path
  double norm = 0.0;                  ///< largest row sum of the scaled matrix that was measured last
  std::int64_t next_measurement = 0;  ///< number of factorizations after which matrices are measured again

  FactorStatus status;
  SolverCounters counters;
  const double* visit_rhs = nullptr;  ///< right-hand side of the present walk
  bool is_condensed = false;          ///< that of the last upward walk, in all visits
  tree::Mark mark;                    ///< of the present walk
  tree::Walker factor_walker;         ///< of the present factorization: distributes the work on large fronts

  // hierarchical.cpp
  void visit_all(const tree::Walker& walker, VisitWork work) const;
  /// factor(); `after` runs at the end of each visit of a group.
  FactorStatus factor_all(const tree::Walker& walker, VisitWork before, const double* rhs, VisitWork after);
  // lane_walks.cpp, residual_walks.cpp: visits of groups
  void factor_group(int group, const VisitWork& before);
  void forward_group(int group, bool while_factoring = false);
  void backward_group(int group);
  void residual_group(int group);
  void check_front_symmetric(int index);
  void check_element_symmetric(int group, int element);
  double* schur_of(const LaneFront& f) {
    return (f.is_top ? lane_tops.data() : group_scratch[static_cast<std::size_t>(f.group)]) + f.schur * lanes_wide;
  }
  double* factor_of(const LaneFront& f) { return lane_factors.data() + f.factor * lanes_wide; }
  /// On the way up the right-hand side, condensed, on the way down the solution: eliminated unknowns, then the
  /// boundary.
  double* vector_of(const LaneFront& f) { return schur_of(f) + f.schur_size() * lanes_wide; }
  template <class Visit>
  void with_scratch(int group, Visit&& visit);
  void factor_lanes(int group);
  void fetch_front(int front, Transfers& transfers);
  void prefetch_factor(int front, bool downward) const;
  void factor_lane_front(int index, double* factor, Transfers& transfers);
  Source source_of(const LaneFront& f, const Move& move);
  void factor_lanes_alone(int index, double* factor, LaneSet alone);
  void leave_lanes(int index, const double* factor, LaneSet alone);
  void add_children_vectors(const LaneFront& f, double* v);
  void forward_lane_front(int index, const double* factor);
  void backward_lane_front(int index);
  void backward_left_lane_front(int index, std::vector<double>& left);
  void residual_lane_front(int index, SolutionSizes& most);

  // lane_handover.cpp
  LaneSet lanes_to_leave(const LaneFront& f) const;
  void factor_lane_alone(int index, int lane);
  void add_lane_vector(tree::FrontId child, double* gathered, const FrontData& parent);
  void hand_down(tree::FrontId f);
  void fill_lane_vector(tree::FrontId f, bool with_own);
  bool is_scalar(tree::FrontId f) const {
    const int index = lanes.lane_front[static_cast<std::size_t>(f)];
    return index < 0 ||
           (scalar_lanes[static_cast<std::size_t>(index)] >> lanes.lane[static_cast<std::size_t>(f)] & 1) != 0;
  }
  /// Calls body with as many doubles as the front has unknowns.
  template <class Body>
  static void with_vector(FrontData& d, Body&& body);
  template <class Body>
  void for_boundary(tree::FrontId f, Body&& body) const;  ///< body(row of the boundary, unknown)

  void size_factors();
  bool is_symmetric() const { return symmetry.used != Symmetry::general; }
  bool compares_triangles() const { return is_symmetric() && !trusts_symmetry; }
  void lose_symmetry(const Asymmetry& found);
  void check_all_symmetric();
  void check_visits_symmetric();
  void add_runs(const blocks::BlockGraph& graph, const tree::Front& f);
  void count_front(tree::FrontId f);

  // upward.cpp, assemble.cpp: factor
  void factor_subdomain(tree::SubdomainId s);
  void factor_front(tree::FrontId f);
  void size_front(tree::FrontId f);
  double* schur_place(tree::FrontId f);
  template <class Visit>
  void for_contributors(tree::FrontId f, Visit&& visit) const;
  void assemble_front(tree::FrontId f);
  void fill_columns(tree::FrontId f, int first, int last);
  void add_block(tree::FrontId f, const Move& move, const Target& target);
  void add_delayed(tree::FrontId f, int first, int last);
  void eliminate_front(tree::FrontId f);
  void note_order(tree::FrontId f);
  // inertia.cpp
  void keep_root(const FrontData& root);
  int count_negative_in_root();
  // solve_walks.cpp
  void forward_front(tree::FrontId f);
  void gather_rhs(tree::FrontId f, double* gathered);
  void gather_boundary(tree::FrontId f, double* boundary) const;
  void backward_front(tree::FrontId f);
  void prefetch_front(tree::FrontId f) const;
  bool checks() const { return options.check != SolveCheck::none; }
  void take(const double* b, double* x_out, bool looks_again);
  void measure_matrices(const tree::Walker& walker);
  SolveReport solve_given(const tree::Walker& walker);
  SolveReport check_solution(const tree::Walker& walker, SolveReport report);
  void back_substitute(const tree::Walker& walker, const VisitWork& after = {});
  void solve_into_x(const tree::Walker& walker, const double* b);
  ElementStore::Errors eval_residual(const tree::Walker& walker, const double* b, SolveReport& report);
  void set_growth(double x_size, double rhs_size, SolveReport& report) const;
  // null_space.cpp
  void decide_rank();
  void project_candidates();
  void find_null_space();
  void eval_null_candidates();
  void backward_left_front(tree::FrontId f, std::vector<double>& left);
  void project_multipliers();
  ElementStore::Errors eval_met_residual(const tree::Walker& walker, SolveReport& report);
  void leave_out_zeros(ElementStore::Errors& errors, SolveReport& report);
  void make_consistent(SolveReport& report);
  // local_null_space.cpp
  double uncertain_entry() const;
  void decide_dependent(tree::FrontId f);
  bool find_local_null_vectors();
  void find_local_left_vectors();
  bool add_local_vectors(tree::FrontId f, NullSide side);
  void spread_null_vectors(tree::FrontId top, int first, int count, NullSide side);
  void substitute_null_vectors(tree::FrontId f, int count, NullSide side);
  bool are_dependent_rows(int count);
  void add_constraint_forces(int element, int count);
  double add_negligible_part();
  // interfaces.cpp
  void copy_schur(tree::FrontId f, double* to);
  InterfaceReport report_interface(tree::SubdomainId s, int widest, bool keeps_matrices);

  const tree::Front& front(tree::FrontId f) const { return tree.fronts[static_cast<std::size_t>(f)]; }
  FrontData& data(tree::FrontId f) { return fronts[static_cast<std::size_t>(f)]; }
  const FrontData& data(tree::FrontId f) const { return fronts[static_cast<std::size_t>(f)]; }
};

/// Schur complements and vectors that only the visit needs are on its stack, which stays in the cache.
template <class Visit>
void Hierarchical::State::with_scratch(int index, Visit&& visit) {
  const bool fits = lanes.groups[static_cast<std::size_t>(index)].scratch * lanes_wide <= room_of_scratch;
  alignas(64) double scratch[room_of_scratch];
  if (fits) group_scratch[static_cast<std::size_t>(index)] = scratch;
  visit();
  if (fits) group_scratch[static_cast<std::size_t>(index)] = nullptr;
}

template <class Body>
void Hierarchical::State::with_vector(FrontData& d, Body&& body) {
  if (d.size > room_of_vector) return body(d.vector + d.size);
  double scratch[room_of_vector];
  body(scratch);
}

template <class Body>
void Hierarchical::State::for_boundary(tree::FrontId f, Body&& body) const {
  const int* unknown = row_unknowns.data() + row_begin[static_cast<std::size_t>(f)] + front(f).num_eliminated;
  for (int i = 0; i < front(f).num_boundary; ++i) body(i, static_cast<std::size_t>(unknown[i]));
}

}  // namespace bough::solve
