#pragma once
/// Trials of a solver on a problem before it is timed.
#include <functional>
#include <limits>

#include "peer.hpp"

namespace bough::bench {

/// A solver with a normwise backward error above this is excluded.
constexpr double largest_backward_error = 1e-10;

/// A peer with one ordering, and its CPU seconds for the symbolic analysis, for the first numeric factorization and for
/// the operations timed (the smaller of two if they are short).
struct Trial {
  const Peer* peer = nullptr;
  std::string ordering, failure;
  bool is_slow = false;  ///< the failure is its time
  std::unique_ptr<Session> session;
  double analysis = 0.0, first = 0.0, again = std::numeric_limits<double>::infinity(), backward_error = 0.0;
};

/// Tries all orderings of a peer and returns the best one (with its failure if all fail). Orderings are compared while
/// the first factorization takes less than 0.3 s; otherwise `kept`, the choice for a smaller case of the same kind, is
/// used (empty: none). A first factorization above the limit [s] counts as failure, and the trial ends.
Trial try_peer(const Peer& peer, const Problem& p, const std::string& kept,
               double limit = std::numeric_limits<double>::infinity());

/// CPU seconds of an analysis: the least of three if it is short. `make` does all of it, from the matrix to the object
/// that can factor, and is called at least once.
double eval_analysis(const std::function<void()>& make);

/// "backward error 1.0e-09 (amd)"
std::string describe_error(double backward_error, const std::string& ordering);

}  // namespace bough::bench
