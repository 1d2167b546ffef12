#pragma once
/// All storage of the forms with global multipliers. Internal to solve.
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "bough/solve/reference/dual.hpp"
#include "dependent_rows.hpp"
#include "refine.hpp"
#include "subdomain_fronts.hpp"

namespace bough::solve {

/// One scalar tie x_plus - x_minus = 0 between the copies of an unknown in two leaves.
struct Tie {
  int unknown;
  int plus, minus;  ///< leaves, by their number among the leaves
};

/// A boundary unknown of a leaf.
struct BoundaryUnknown {
  int unknown;
  int coarse;     ///< its index in the interface mesh, or -1
  bool is_first;  ///< the copy to which the load is applied
};

/// One sub-domain condensed to its boundary, then to its ties. The local order is: rejected unknowns, boundary
/// unknowns, and last those of the interface mesh.
struct LeafInterface {
  tree::SubdomainId id = tree::none;
  std::vector<BoundaryUnknown> boundary;             ///< in the order of the leaf's boundary blocks
  std::vector<int> order;                            ///< local -> position among the unknowns kept by SubdomainFronts
  std::vector<std::pair<int, double>> ties;          ///< (tie, sign)
  std::vector<int> tie_boundary;                     ///< by entry of ties: position in boundary
  std::vector<int> tie_row, tie_column;              ///< the same: row and column in the factored matrix
  std::vector<double> a, load, x, work;              ///< a: factored, column-major
  std::vector<int> rows, columns, row_from, coarse;  ///< coarse: column among w of each unknown kept here
  Eigen::MatrixXd flexibility, right, left;          ///< at the entries of ties: H, R (ties x kept), Q
  int size = 0, full = 0, pivots = 0;
  bool failed = false;
  int num_kept() const { return size - pivots; }
  FrontMatrix front() { return {a.data(), size, full, rows.data(), columns.data(), row_from.data()}; }
};

/// A dense matrix eliminated in place, with the permutations of its fully summed part.
struct DenseStage {
  std::vector<double> a, work;
  std::vector<int> rows, columns, row_from;
  int size = 0, full = 0, pivots = 0;
  void reset(int new_size, int new_full);
  double& operator()(int i, int j) { return a[static_cast<std::size_t>(i) + static_cast<std::size_t>(j) * rows_()]; }
  FrontMatrix front() { return {a.data(), size, full, rows.data(), columns.data(), row_from.data()}; }
  double flops() const;

 private:
  std::size_t rows_() const { return static_cast<std::size_t>(size); }
};

struct Dual::State {
  State(const blocks::BlockGraph& graph, const tree::Tree& tree, const DualOptions& form, const SolveOptions& options);

  // global.cpp: copies and ties, sub-domain by sub-domain
  void tear(const blocks::BlockGraph& graph);
  void factor_leaf(LeafInterface& leaf);
  void condense_load(LeafInterface& leaf, const double* b);
  void recover_leaf(LeafInterface& leaf, const Eigen::VectorXd& solution);
  void recover_leaf_left(LeafInterface& leaf, const Eigen::VectorXd& vector);
  void add_interface_load(LeafInterface& leaf, Eigen::VectorXd& rhs);
  void eval_responses(LeafInterface& leaf);
  // hybrid.cpp: the interface mesh and the interface problem
  std::vector<char> choose_local(const std::vector<std::vector<int>>& leaves_of_block) const;
  void factor_interface();
  void solve_interface(const Eigen::VectorXd& rhs, Eigen::VectorXd& x);
  void back_substitute(Eigen::VectorXd& rest, Eigen::VectorXd& x);
  void back_substitute_left(Eigen::VectorXd& rest, Eigen::VectorXd& y);
  void number_coarse();
  void assemble_interface();
  bool iterate(const Eigen::VectorXd& rhs, Eigen::VectorXd& x);
  void assemble_preconditioner();
  double eval_condition() const;
  // dual_null_space.cpp
  void eval_candidates(const tree::Walker& walker, Eigen::MatrixXd& right, Eigen::MatrixXd* left);
  void decide_rank(const tree::Walker& walker);
  // dual.cpp
  void visit_leaves(const tree::Walker& walker, bool up, const std::function<void(LeafInterface&)>& body);
  void solve_scaled(const tree::Walker& walker, const double* b, double* x);
  void recover(const tree::Walker& walker, const Eigen::VectorXd& solution, double* x);
  int num_ties() const { return static_cast<int>(ties.size()); }

  const tree::Tree& tree;
  DualOptions form;
  SolveOptions options;
  ElementStore elements;
  Scales scales;
  bool scales_wanted = true;
  std::vector<ElementBatch> batches;
  SubdomainFronts fronts;
  std::vector<LeafInterface> leaves;
  std::vector<int> leaf_of_subdomain;
  std::vector<int> untouched;  ///< indices in the mesh of unknowns in no element
  std::vector<Tie> ties;
  std::vector<int> mesh;         ///< unknowns of the interface mesh (hybrid), then those in no element
  std::vector<double> copies;    ///< by unknown: 1 / number of copies, if there are several
  int num_coarse = 0;            ///< size of w: the mesh, then the remaining unknowns of each leaf
  DenseStage coarse, interface;  ///< w, eliminated before the multipliers (hybrid); the others
  std::vector<double> tie_scale;
  Eigen::MatrixXd reduced,
      preconditioner;  ///< the interface problem before its elimination; iterative: its preconditioner
  bool is_symmetric = false;
  DependentRows dependent;
  int iterations = 0;
  bool converged = true;
  double seconds = 0.0;
  RefineBuffers buffers;
  FactorStatus status;
  SolverCounters counters;
};

}  // namespace bough::solve
