#pragma once
/// bough's solver on a problem, through its public interface.
#include <memory>
#include <utility>

#include "bough/schedule/threads.hpp"
#include "bough/solve/hierarchical.hpp"
#include "bough/tree/tree.hpp"
#include "peer.hpp"

namespace bough::bench {

/// Writes the element matrices to the storage of a solver.
template <class Solver>
void write_elements(const Problem& p, Solver& solver) {
  for (int e = 0; e < p.graph.num_elements(); ++e) {
    const std::vector<double>& a = p.elements[static_cast<std::size_t>(e)];
    const solve::ElementView target = solver.element(e);
    for (std::size_t k = 0; k < a.size(); ++k) target[static_cast<std::int64_t>(k)] = a[k];
  }
}

/// The tree and the storage of the solver. Sessions with different numbers of threads share them, since they never run
/// at the same time.
struct BoughStorage {
  tree::Tree tree;
  solve::Hierarchical solver;
  /// The tree for one solution per factorization, as the rows time it; lockstep: the tree for several solutions, if it
  /// differs.
  explicit BoughStorage(const Problem& p, bool lockstep = false)
      : tree(tree::make_tree(p.graph, {.for_one_solution = !lockstep && !p.is_symmetric()})),
        solver(p.graph, tree,
               {.symmetry = !p.is_symmetric()   ? solve::Symmetry::general
                            : p.has_multipliers ? solve::Symmetry::symmetric
                                                : solve::Symmetry::definite,
                .check = solve::SolveCheck::none,
                .refinement_steps = 0}) {
    write_elements(p, solver);
    solver.trust_symmetry(p.is_symmetric());  // the peers read one triangle as well
  }
};

class BoughSession final : public Session {
 public:
  BoughSession(const Problem& p, std::shared_ptr<BoughStorage> storage, int threads)
      : problem_(p), storage_(std::move(storage)), threads_(threads) {}
  bool analyze() override { return true; }  // the tree was made with the storage
  bool factor() override { return storage_->solver.factor(threads_.walker()).ok(); }
  bool refactor_and_solve(std::vector<double>& x) override {
    const tree::Walker walker = threads_.walker();
    if (!storage_->solver.factor(walker, {}, problem_.rhs.data()).ok()) return false;
    x.resize(problem_.rhs.size());
    return storage_->solver.finish(walker, problem_.rhs.data(), x.data()).finite;
  }
  double memory_bytes() const override { return static_cast<double>(storage_->solver.counters().memory_bytes); }
  double factor_flops() const override { return storage_->solver.counters().factor_flops; }
  void iterate(const std::function<void()>& iterations) override { threads_.keep_together(iterations); }

 private:
  const Problem& problem_;
  std::shared_ptr<BoughStorage> storage_;
  schedule::Threads threads_;
};

}  // namespace bough::bench
