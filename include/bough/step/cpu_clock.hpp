#pragma once
/// CPU seconds by phase of a run. The kernel's own clocks of CPU time cost some 200 ns a reading, a good part of what
/// a phase of a small scene takes, so where one thread does all the work they are read rarely.
#include <cstdint>

namespace bough::step {

/// CPU seconds: of the whole process where a run has several threads; of the calling thread, which has to stay the
/// same one, where it has one. There they go on with the steady clock for up to 0.2 ms, and are read again when that
/// has passed: a reading is too large by what the thread had to wait within that time, and stays as it is until that
/// is made up for. Errors do not add up.
class CpuClock {
 public:
  explicit CpuClock(bool has_one_thread) : has_one_thread_(has_one_thread) {}
  /// [s], from any origin, never less than before. No allocation.
  double now();

 private:
  friend class PhaseTimer;
  friend class PhaseChain;
  void charge(double* next);

  bool has_one_thread_;
  double* charged_ = nullptr;  ///< sum of the present phase
  double begun_ = 0.0;         ///< when it began [s]
  bool is_chained_ = false;    ///< phases last until the next one begins
  bool is_left_open_ = false;  ///< the present phase has ended, and lasts until the next one begins
  std::int64_t read_at_ = -1;  ///< of the steady clock [ns]; -1: never
  double cpu_ = 0.0;           ///< then [s]
  double told_ = 0.0;          ///< last [s]
};

/// CPU seconds by phase, all threads of the run, and counts of work.
struct WorkCounts {
  double assemble = 0.0, factor = 0.0, solve = 0.0, update = 0.0;
  long factorizations = 0, solutions = 0, evaluations = 0;
  long checks = 0;  ///< solutions whose backward error was measured
  double backward_error_max = 0.0;
  double rank_error_max = 0.0;
};

/// A phase: adds the CPU seconds of its life to a sum, without those of phases that begin and end within it.
class PhaseTimer {
 public:
  PhaseTimer(CpuClock& clock, double& sum);
  ~PhaseTimer();
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  CpuClock& clock_;
  double* outer_;  ///< sum of the phase within which this one began
};

/// While it lives, a phase lasts until the next one begins: one reading of the clock a phase instead of two. A phase
/// then contains the few decisions that follow it.
class PhaseChain {
 public:
  explicit PhaseChain(CpuClock& clock);
  ~PhaseChain();
  PhaseChain(const PhaseChain&) = delete;
  PhaseChain& operator=(const PhaseChain&) = delete;

 private:
  CpuClock& clock_;
};

}  // namespace bough::step
