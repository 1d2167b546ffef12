#pragma once
/// Interface of a direct solver in the benchmark.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "../support/problem.hpp"

namespace bough::bench {

/// One solver on one problem with one ordering. The problem must outlive it.
class Session {
 public:
  virtual ~Session() = default;
  /// Symbolic analysis, done once. False: failed.
  [[nodiscard]] virtual bool analyze() = 0;
  /// The first numeric factorization, pivot search included. False: failed.
  [[nodiscard]] virtual bool factor() = 0;
  /// Numeric factorization with a given symbolic analysis. False: failed.
  [[nodiscard]] virtual bool refactor() = 0;
  /// x = A^-1 rhs of the problem with the last factorization, without iterative refinement and error estimates. False:
  /// failed.
  [[nodiscard]] virtual bool solve(std::vector<double>& x) = 0;
  [[nodiscard]] bool refactor_and_solve(std::vector<double>& x) { return refactor() && solve(x); }
  /// What the last factorization found out about the matrix; empty: nothing to say.
  virtual std::string findings() const { return ""; }
  /// Nonzeros of L and U, their diagonal once; 0: unknown.
  virtual double factor_entries() const { return 0.0; }
  /// Memory of the solver, by its own account [bytes]; 0: unknown.
  virtual double memory_bytes() const { return 0.0; }
  /// Operations of one factorization [flop]; 0: unknown.
  virtual double factor_flops() const { return 0.0; }
  /// Runs the iterations of a row within their common scope, such as threads that stay active during a run.
  virtual void iterate(const std::function<void()>& iterations) { iterations(); }
};

struct Peer {
  std::string name;
  std::string version;
  /// Orderings to compare, the default first; empty: the solver does not apply.
  std::function<std::vector<std::string>(const Problem&)> orderings;
  std::function<std::unique_ptr<Session>(const Problem&, const std::string& ordering)> make;
  bool uses_blas = false;  ///< and, with it, threads
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
