#pragma once
/// bough's own solver on a problem, by its public interface.
#include "bough/schedule/threads.hpp"
#include "bough/solve/hierarchical.hpp"
#include "bough/tree/tree.hpp"
#include "peer.hpp"

namespace bough::bench {

/// Writes the element matrices where a solver wants them.
template <class Solver>
void write_elements(const Problem& p, Solver& solver) {
  for (int e = 0; e < p.graph.num_elements(); ++e) {
    const std::vector<double>& a = p.elements[static_cast<std::size_t>(e)];
    const auto copy = [&a](auto&& target) {
      for (std::size_t k = 0; k < a.size(); ++k) target[static_cast<std::ptrdiff_t>(k)] = a[k];
    };
    if constexpr (requires { solver.element(e); })
      copy(solver.element(e));
    else
      copy(solver.element_matrix(e));
  }
}

class BoughSession final : public Session {
 public:
  BoughSession(const Problem& p, int threads)
      : problem_(p),
        threads_(threads),
        tree_(tree::make_tree(p.graph)),
        solver_(p.graph, tree_, {.check = solve::SolveCheck::none, .refinement_steps = 0}) {
    write_elements(p, solver_);
  }
  bool analyze() override { return true; }  // the tree was made by the constructor
  bool factor() override { return solver_.factor(threads_.walker()).ok(); }
  bool refactor_and_solve(std::vector<double>& x) override {
    if (!solver_.factor(threads_.walker()).ok()) return false;
    x.resize(problem_.rhs.size());
    return solver_.solve(threads_.walker(), problem_.rhs.data(), x.data()).finite;
  }

 private:
  const Problem& problem_;
  schedule::Threads threads_;
  tree::Tree tree_;
  solve::Hierarchical solver_;
};

}  // namespace bough::bench
