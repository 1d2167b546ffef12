#pragma once
/// bough's solver on a problem, through its public interface.
#include <algorithm>
#include <memory>
#include <string>
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
    const std::size_t n = problem_.rhs.size();
    x.resize(n);
    if (problem_.place.empty())
      return storage_->solver.solve_unchecked(threads_.walker(), problem_.rhs.data(), x.data()).finite;
    work_.resize(n);
    for (std::size_t i = 0; i < n; ++i) work_[static_cast<std::size_t>(problem_.place[i])] = problem_.rhs[i];
    const bool is_finite = storage_->solver.solve_unchecked(threads_.walker(), work_.data(), work_.data()).finite;
    for (std::size_t i = 0; i < n; ++i) x[i] = work_[static_cast<std::size_t>(problem_.place[i])];
    return is_finite;
  }
  std::string findings() const override {
    const solve::FactorStatus& status = storage_->solver.last_status();
    if (status.outcome == solve::FactorOutcome::not_finite) return "a number is not finite";
    if (status.outcome == solve::FactorOutcome::singular)
      return "singular, " + std::to_string(status.deficiency) + " null vectors, most in unknown " +
             std::to_string(unknown_of(status) + 1);
    return status.deficiency > 0 ? std::to_string(status.deficiency) + " dependent rows" : "";
  }
  double memory_bytes() const override { return static_cast<double>(storage_->solver.counters().memory_bytes); }
  double factor_flops() const override { return storage_->solver.counters().factor_flops; }
  void iterate(const std::function<void()>& iterations) override { threads_.keep_together(iterations); }

 private:
  /// The unknown of the matrix that a failure names.
  int unknown_of(const solve::FactorStatus& status) const {
    const int place = problem_.unknown_begin[static_cast<std::size_t>(status.block)] + status.local;
    const auto found = std::find(problem_.place.begin(), problem_.place.end(), place);
    return found == problem_.place.end() ? place : static_cast<int>(found - problem_.place.begin());
  }

  const Problem& problem_;
  std::shared_ptr<BoughStorage> storage_;
  schedule::Threads threads_;
  std::vector<double> work_;
};

}  // namespace bough::bench
