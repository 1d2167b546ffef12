#pragma once
/// Task-parallel walk. The only place that knows TBB (if it was not built in, the walk is serial).
#include <functional>
#include <memory>

#include "bough/tree/walker.hpp"

namespace bough::schedule {

/// A fixed number of threads and the walk that uses them. Subtrees above a grain of work become tasks, the others run
/// whole in one task. Results do not depend on the number of threads: a task only decides when a sub-domain is
/// visited, never what is added to what.
class Threads {
 public:
  static constexpr double usual_grain_flops = 2e5;

  /// count: threads, >= 1 (1: the serial walk). grain_flops: least work of a task [flop].
  explicit Threads(int count, double grain_flops = usual_grain_flops);
  ~Threads();
  Threads(Threads&&) noexcept;
  Threads& operator=(Threads&&) noexcept;

  int count() const;
  /// Valid while this object lives and stays where it is (moving keeps it valid: the state is on the heap).
  tree::Walker walker() const;

  /// Runs `body()` so that the threads stay together between its walks. Without it every walk calls them anew, which
  /// takes some microseconds: as long as a walk over a hundred bodies.
  void keep_together(const std::function<void()>& body) const;

  /// For tests: every task and chunk first spins for a pseudo-random time below `microseconds`. 0 turns it off.
  void set_random_delay(unsigned microseconds, unsigned seed);
  /// For tests: two threads work as they do beside another program, whether there is one or not.
  void assume_crowding(bool yes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bough::schedule
