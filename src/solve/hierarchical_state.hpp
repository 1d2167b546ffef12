#pragma once
/// All storage of the hierarchical solver. Internal to solve.
#include <cstdint>
#include <memory>
#include <vector>

#include "bough/solve/hierarchical.hpp"
#include "dense.hpp"
#include "element_store.hpp"

namespace bough::solve {

/// A run of boundary rows that goes to adjacent rows of the parent front.
struct Run {
  int from;  ///< first row, counted from the start of the boundary
  int to;    ///< first row in the parent, before room is made for delayed pivots
  int length;
};

/// Numbers of one front. Without delayed pivots all pointers go into the pools of State.
struct FrontData {
  double* a = nullptr;       ///< size x size, column-major
  double* vector = nullptr;  ///< size: right-hand side, then [y; g]
  int* rows = nullptr;       ///< full: global unknown of each fully summed row, in pivot order
  int* columns = nullptr;
  int* row_from = nullptr;  ///< full: row before pivoting
  int size = 0, full = 0, pivots = 0;
  int delayed_in = 0;      ///< unknowns that children could not eliminate: they come first
  bool failed = false;     ///< not finite here or below
  bool allocated = false;  ///< the enlarging took heap memory in this factorization
  int num_delayed() const { return full - pivots; }
};

/// Own memory of a front enlarged by delayed pivots; kept for the next time.
struct Enlarged {
  std::vector<double> a, vector;
  std::vector<int> indices;
};

/// Dependent rows found at the root, and what follows from them.
struct NullSpace {
  int dimension = 0;
  std::vector<double> right;  ///< dimension x unknowns, orthonormal in the weighted norm; scaled variables
  std::vector<double> left;   ///< dimension x unknowns, orthonormal
};

/// Root pivots below this, scaled, are looked at before they are used.
constexpr double suspect_pivot = 1e-5;

/// Textbook condensation of one interface: F and F^-1 as they were computed.
struct PlainInterface {
  std::vector<double> flexibility, inverse, penalty, work;
  bool used = false;
};

struct Hierarchical::State {
  State(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options);

  const tree::Tree& tree;
  SolveOptions options;
  ElementStore elements;
  Scales scales;
  bool scales_wanted = true;
  std::unique_ptr<bool[]> is_constraint;  ///< by unknown

  std::vector<FrontData> fronts;
  std::vector<Enlarged> enlarged;                                                ///< by front
  std::vector<std::int64_t> matrix_begin, vector_begin, index_begin, run_begin;  ///< by front, into the pools
  std::vector<double> matrix_pool, vector_pool, scratch_pool;
  std::vector<int> index_pool;
  std::vector<int> own_unknowns;  ///< eliminated unknowns of every front (pool, a third of index_begin)
  std::vector<Run> runs;
  std::vector<PlainInterface> plain;  ///< by sub-domain; empty unless elimination is plain
  NullSpace null_space;
  std::vector<double> x_scaled, rhs, residual, correction;

  FactorStatus status;
  SolverCounters counters;
  const double* visit_rhs = nullptr;  ///< right-hand side of the walk at hand

  // upward.cpp: factor
  void factor_subdomain(tree::SubdomainId s, const Prepare& prepare);
  void size_front(tree::FrontId f);
  void assemble_front(tree::FrontId f);
  void add_element(const tree::Front& front, int position, double* a, int ld, int shift);
  void add_child(tree::FrontId child, FrontData& parent, int& delayed);
  void eliminate_front(tree::FrontId f);
  // solve_walks.cpp
  void forward_front(tree::FrontId f);
  void backward_front(tree::FrontId f);
  void solve_scaled(const tree::Walker& walker, const double* b);
  // null_space.cpp
  void decide_rank();
  void find_null_space();
  void eval_null_candidates();
  void project_multipliers();
  void eval_inconsistency(const double* b, SolveReport& report);
  void eval_growth(const double* b, SolveReport& report) const;
  // interfaces.cpp
  void condense_through_flexibility(tree::SubdomainId s);
  void correct_forward(tree::SubdomainId s);
  std::vector<double> interface_stiffness(tree::SubdomainId s) const;

  const tree::Front& front(tree::FrontId f) const { return tree.fronts[static_cast<std::size_t>(f)]; }
  FrontData& data(tree::FrontId f) { return fronts[static_cast<std::size_t>(f)]; }
  const FrontData& data(tree::FrontId f) const { return fronts[static_cast<std::size_t>(f)]; }
};

}  // namespace bough::solve
