#include "trial.hpp"

#include <algorithm>
#include <cstdio>

#include "../support/cpu_time.hpp"

namespace bough::bench {

namespace {

constexpr double longest_trial = 0.3;

/// One ordering: the first factorization, then the operations timed, twice.
Trial try_ordering(const Peer& peer, const Problem& p, const std::string& ordering, double limit) {
  Trial t;
  t.peer = &peer;
  t.ordering = ordering;
  bool analyzed = false;
  t.analysis = eval_analysis([&] {
    t.session = peer.make(p, ordering);
    analyzed = t.session->analyze();
  });
  double start = cpu_now();
  if (!analyzed || !t.session->factor()) {
    t.failure = "fails to factor the matrix (" + ordering + ")";
    return t;
  }
  t.first = cpu_now() - start;
  if (t.first > limit) {
    char text[120];
    std::snprintf(text, sizeof text, "first numeric factorization %.3g ms, more than %.3g ms (%s)", 1e3 * t.first,
                  1e3 * limit, ordering.c_str());
    t.failure = text;
    t.is_slow = true;
    return t;
  }
  std::vector<double> x;
  for (int k = 0; k < (t.first > longest_trial ? 1 : 2); ++k) {
    start = cpu_now();
    if (!t.session->refactor_and_solve(x)) {
      t.failure = "fails to solve (" + ordering + ")";
      return t;
    }
    t.again = std::min(t.again, cpu_now() - start);
  }
  t.backward_error = eval_backward_error(p.matrix, x, p.rhs);
  if (!(t.backward_error <= largest_backward_error)) {
    t.failure = describe_error(t.backward_error, ordering);
  }
  return t;
}

bool is_better(const Trial& a, const Trial& b) {
  if (a.failure.empty() != b.failure.empty()) return a.failure.empty();
  return a.failure.empty() ? a.again < b.again : a.is_slow < b.is_slow;
}

}  // namespace

std::string describe_error(double backward_error, const std::string& ordering) {
  char text[80];
  std::snprintf(text, sizeof text, "backward error %.1e (%s)", backward_error, ordering.c_str());
  return text;
}

double eval_analysis(const std::function<void()>& make) {
  constexpr double short_enough = 0.1;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const double start = cpu_now();
    make();
    least = std::min(least, cpu_now() - start);
    if (least > short_enough) break;
  }
  return least;
}

Trial try_peer(const Peer& peer, const Problem& p, const std::string& kept, double limit) {
  std::vector<std::string> orderings = peer.orderings(p);
  const auto at_front = std::find(orderings.begin(), orderings.end(), kept);
  if (at_front != orderings.end()) std::iter_swap(orderings.begin(), at_front);
  Trial best = try_ordering(peer, p, orderings.front(), limit);
  for (std::size_t k = 1; k < orderings.size(); ++k) {
    if (!kept.empty() && (best.failure.empty() || best.is_slow) && best.first > longest_trial) break;
    if (orderings[k].starts_with("node") && order_nodes(p, orderings[k]).empty()) continue;
    Trial t = try_ordering(peer, p, orderings[k], limit);
    if (is_better(t, best)) best = std::move(t);
  }
  return best;
}

}  // namespace bough::bench
