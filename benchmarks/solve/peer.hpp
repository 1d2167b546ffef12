#pragma once
/// A direct solver as the benchmark sees it.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "../support/problem.hpp"

namespace bough::bench {

/// One solver on one problem with one ordering; the problem outlives it.
class Session {
 public:
  virtual ~Session() = default;
  /// Symbolic work, once. False: failed.
  [[nodiscard]] virtual bool analyze() = 0;
  /// The first numeric factorization, pivot search included. False: failed.
  [[nodiscard]] virtual bool factor() = 0;
  /// What is timed: numeric factorization with the symbolic work at hand, then x = A^-1 rhs of the problem. No
  /// refinement, no estimate of errors. False: failed.
  [[nodiscard]] virtual bool refactor_and_solve(std::vector<double>& x) = 0;
  /// Nonzeros of L and U, their diagonal once; 0: not told.
  virtual double factor_entries() const { return 0.0; }
  /// All that the solver holds [bytes]; 0: not told.
  virtual double memory_bytes() const { return 0.0; }
  /// Of one factorization [flop]; 0: not told.
  virtual double factor_flops() const { return 0.0; }
  /// Runs the iterations of a row, with what they have in common around them, such as threads that stay together
  /// during a run.
  virtual void iterate(const std::function<void()>& iterations) { iterations(); }
};

struct Peer {
  std::string name;
  std::string version;
  /// Orderings worth a trial, the default first; empty: does not apply.
  std::function<std::vector<std::string>(const Problem&)> orderings;
  std::function<std::unique_ptr<Session>(const Problem&, const std::string& ordering)> make;
};

/// The solvers that were found when the benchmark was built.
std::vector<Peer> make_peers();

Peer make_klu_peer();
Peer make_eigen_lu_peer();
Peer make_eigen_ldlt_peer();
Peer make_umfpack_peer();
Peer make_cholmod_peer();
Peer make_mumps_peer();
Peer make_superlu_peer();

}  // namespace bough::bench
