#pragma once
/// Trying a solver on a problem before it is timed.
#include <limits>

#include "peer.hpp"

namespace bough::bench {

/// A normwise backward error above this leaves a solver out.
constexpr double largest_backward_error = 1e-10;

/// A peer with one ordering, and the CPU seconds it took: first numeric factorization, and what is timed (the better
/// of two where that is short).
struct Trial {
  const Peer* peer = nullptr;
  std::string ordering, failure;
  bool is_slow = false;  ///< the failure is its time
  std::unique_ptr<Session> session;
  double first = 0.0, again = std::numeric_limits<double>::infinity(), backward_error = 0.0;
};

/// All orderings that suit the peer, the best one returned (with its failure if all fail). Orderings are tried while
/// the first factorization takes less than 0.3 s; then `kept`, the choice for a smaller case of the same kind, stays
/// (empty: none). A first factorization above the limit [s] counts as failure; nothing more is computed then.
Trial try_peer(const Peer& peer, const Problem& p, const std::string& kept,
               double limit = std::numeric_limits<double>::infinity());

/// "backward error 1.0e-09 (amd)"
std::string describe_error(double backward_error, const std::string& ordering);

}  // namespace bough::bench
