#include "make_solver.hpp"

#include <algorithm>
#include <cmath>

#include "bough/step/linear_solution.hpp"

namespace bough::step {

namespace {

std::unique_ptr<solve::AnySolver> make_monolithic(const plan::Plan& plan, const tree::Tree& tree,
                                                  scene::SolverLibrary library, const solve::SolveOptions& options) {
  using Given = scene::SolverLibrary;
  if (library == Given::klu) return std::make_unique<solve::AnySolver>(solve::Monolithic(plan.graph, tree, options));
  const solve::Library other = library == Given::umfpack   ? solve::Library::umfpack
                               : library == Given::cholmod ? solve::Library::cholmod
                                                           : solve::Library::sparse_lu;
  return std::make_unique<solve::AnySolver>(solve::SparseOracle(plan.graph, tree, other, options));
}

}  // namespace

/// Sub-domains are tasks of several threads, or equal ones share lanes. Where one thread visits all, and leaves between
/// many loops are not alike, they only add interfaces: one sub-domain takes 0.88 of the time of a step on a lattice of
/// 8 x 8 nodes, 0.90 on 12 x 12, 0.95 on a tower crane's jib, 0.93 on a rotor. Other forms need the interfaces. (Sensors
/// of interface forces name sub-domains of the tree as it is: what only looks changes no bit.)
tree::TreeOptions make_tree_options(const plan::Plan& plan, const scene::Solver& given) {
  tree::TreeOptions options;
  options.leaf_size = given.leaf_size;
  options.depth = given.depth;
  const bool is_free = given.leaf_size == 0 && given.depth < 0 && given.form == scene::SolverForm::local;
  options.loops_in_one = is_free && plan.took("small");
  options.in_lockstep = plan.took("lanes");
  return options;
}

namespace {

/// Normwise backward error below which a refinement step finds nothing to correct: 1e-14, or four times the rounding
/// error of a sum with as many products as the longest row of the matrix has, sqrt(m) 2^-53 where their signs are those
/// of chance [Higham 2002, 2.8]. (A body on thousands of springs has rows of as many elements.)
double round_off_of(const blocks::BlockGraph& graph) {
  std::vector<double> products(graph.block_size.size(), 0.0);
  for (int e = 0; e < graph.num_elements(); ++e) {
    const auto begin = graph.element_begin[static_cast<std::size_t>(e)],
               end = graph.element_begin[static_cast<std::size_t>(e) + 1];
    double size = 0.0;
    for (auto k = begin; k < end; ++k)
      size += graph.block_size[static_cast<std::size_t>(graph.element_blocks[static_cast<std::size_t>(k)])];
    for (auto k = begin; k < end; ++k)
      products[static_cast<std::size_t>(graph.element_blocks[static_cast<std::size_t>(k)])] += size;
  }
  double most = 1.0;
  for (const double p : products) most = std::max(most, p);
  return std::max(1e-14, 4.0 * 0x1p-53 * std::sqrt(most));
}

}  // namespace

solve::SolveOptions make_solve_options(const plan::Plan& plan, const scene::Solver& given) {
  solve::SolveOptions options;
  options.penalty_factor = given.penalty_factor;
  options.lanes = plan.took("lanes");
  options.refinement_above = round_off_of(plan.graph);
  options.data_precision = plan.precision;
  options.inertia = !plan.is_dynamic;  // needed by Stability
  if (plan.took("symmetric")) options.symmetry = solve::Symmetry::symmetric;
  return options;
}

std::unique_ptr<solve::AnySolver> make_solver(const plan::Plan& plan, const tree::Tree& tree,
                                              const scene::Solver& given) {
  const solve::SolveOptions options = make_solve_options(plan, given);
  if (given.form == scene::SolverForm::monolithic) return make_monolithic(plan, tree, given.library, options);
  if (given.form == scene::SolverForm::global || given.form == scene::SolverForm::hybrid) {
    const solve::DualOptions form{
        .form = given.form == scene::SolverForm::global ? solve::DualForm::global : solve::DualForm::hybrid,
        .solution = given.iterate_interface ? solve::InterfaceSolution::iterative : solve::InterfaceSolution::direct};
    return std::make_unique<solve::AnySolver>(solve::Dual(plan.graph, tree, form, options));
  }
  if (given.form == scene::SolverForm::augmented)
    return std::make_unique<solve::AnySolver>(solve::Augmented(plan.graph, tree, options));
  return std::make_unique<solve::AnySolver>(solve::Hierarchical(plan.graph, tree, options));
}

const char* explain_backend(solve::FactorOutcome outcome) {
  if (outcome == solve::FactorOutcome::backend)
    return "the library of /solver/library is not part of this program (KLU needs BOUGH_WITH_KLU, UMFPACK and CHOLMOD "
           "need "
           "BOUGH_WITH_GPL when it is built), or it failed: choose \"sparse_lu\", or another /solver/form";
  if (outcome == solve::FactorOutcome::unsymmetric)
    return "the tangent is not symmetric, and /solver/library \"cholmod\" solves symmetric systems only: choose "
           "another "
           "library";
  return nullptr;
}

}  // namespace bough::step
