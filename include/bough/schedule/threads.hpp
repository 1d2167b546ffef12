#pragma once
/// Walks on several threads. This is the only place that uses TBB; if bough is built without TBB, the walk is serial.
#include <functional>
#include <memory>

#include "bough/tree/walker.hpp"

namespace bough::schedule {

/// A fixed number of threads, and the walk that uses them. A subtree whose work exceeds a grain is divided into parts;
/// a smaller one is one part. Results do not depend on the number of threads: they decide when a sub-domain is visited,
/// never the order of summation.
class Threads {
 public:
  static constexpr double usual_grain_flops = 2e5;

  /// count: number of threads, >= 1 (1: the serial walk). grain_flops: least work of a part [flop].
  explicit Threads(int count, double grain_flops = usual_grain_flops);
  ~Threads();
  Threads(Threads&&) noexcept;
  Threads& operator=(Threads&&) noexcept;

  int count() const;
  /// Valid as long as this object exists, also after a move of it (its state is on the heap).
  tree::Walker walker() const;

  /// Runs `body()` with the threads kept awake between its walks. Otherwise every walk has to wake them, which takes
  /// longer than a walk over a hundred bodies.
  void keep_together(const std::function<void()>& body) const;

  /// For tests: every part and chunk first spins for a pseudo-random time below `microseconds`. 0 turns it off.
  void set_random_delay(unsigned microseconds, unsigned seed);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bough::schedule
