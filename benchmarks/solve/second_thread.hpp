#pragma once
/// Gain by a second thread on chains and lattices, beside the gain of two threads of this machine that share no work.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bough_session.hpp"

namespace bough::bench {

/// Two solvers of one problem, each with its own storage, on one thread each; and the first of them on two threads.
struct SecondThreadCase {
  std::unique_ptr<Problem> problem;
  std::unique_ptr<BoughSession> alone[2], together;
  long rounds = 1;  ///< of each of them alternately, about 30 ms
};

/// Registers rows second_thread/CASE for the chains of 128, 512 and 2048 links and the lattices of 50 x 50, 100 x 100
/// and 12 x 12 x 12 nodes that are selected. Counters: those of SideBySide, with factorization and solution as the
/// work, `together` [ms] of one solver on two threads, and the gain, `gained` = alone / together. The returned object
/// must outlive the run of the rows.
std::vector<std::unique_ptr<SecondThreadCase>> add_second_thread_rows(
    const std::function<bool(const std::string&)>& is_wanted);

}  // namespace bough::bench
