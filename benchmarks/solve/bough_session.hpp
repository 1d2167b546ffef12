#pragma once
/// bough's solver on a problem, through its public interface.
#include <memory>
#include <string>
#include <utility>

#include "bough/schedule/threads.hpp"
#include "bough/solve/hierarchical.hpp"
#include "bough/solve/matrix_solver.hpp"
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

/// The tree and the storage of the solver, made as for a run. Sessions with different numbers of threads share them,
/// since they never run at the same time.
struct BoughStorage {
  tree::Tree tree;
  solve::Hierarchical solver;
  explicit BoughStorage(const Problem& p)
      : tree(tree::make_tree(p.graph)),
        solver(p.graph, tree, {.symmetry = p.is_symmetric() ? solve::Symmetry::symmetric : solve::Symmetry::general}) {
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
  bool refactor() override { return factor(); }
  bool solve(std::vector<double>& x) override {
    x.resize(problem_.rhs.size());
    return storage_->solver.solve_unchecked(threads_.walker(), problem_.rhs.data(), x.data()).finite;
  }
  std::string findings() const override {
    return storage_->solver.last_status().ok() ? "" : "a number is not finite, or the matrix is singular";
  }
  double memory_bytes() const override { return static_cast<double>(storage_->solver.counters().memory_bytes); }
  double factor_flops() const override { return storage_->solver.counters().factor_flops; }
  void iterate(const std::function<void()>& iterations) override { threads_.keep_together(iterations); }

 private:
  const Problem& problem_;
  std::shared_ptr<BoughStorage> storage_;
  schedule::Threads threads_;
};

/// The same of a matrix without elements, whose method bough chooses.
class BoughMatrixSession final : public Session {
 public:
  BoughMatrixSession(const Problem& p, std::shared_ptr<solve::MatrixSolver> solver, int threads)
      : problem_(p), solver_(std::move(solver)), threads_(threads) {}
  bool analyze() override { return true; }  // the solver was made with it
  bool factor() override { return solver_->factor(threads_.walker(), problem_.matrix.value); }
  bool refactor() override { return factor(); }
  bool solve(std::vector<double>& x) override {
    x.resize(problem_.rhs.size());
    solver_->solve_unchecked(threads_.walker(), problem_.rhs.data(), x.data());
    return true;
  }
  std::string findings() const override { return solver_->findings(); }
  double memory_bytes() const override { return solver_->memory_bytes(); }
  double factor_flops() const override { return solver_->factor_flops(); }
  void iterate(const std::function<void()>& iterations) override { threads_.keep_together(iterations); }

 private:
  const Problem& problem_;
  std::shared_ptr<solve::MatrixSolver> solver_;
  schedule::Threads threads_;
};

}  // namespace bough::bench
