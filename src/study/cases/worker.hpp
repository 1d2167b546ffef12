#pragma once
/// A process that runs cases one after the other and reports each.
#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/study/batch.hpp"

namespace bough::study {

/// Answer of a worker at the end of a case.
struct WorkerAnswer {
  int code = 1;  ///< of run_case
  double cpu_seconds = 0.0, peak_bytes = 0.0;
  std::string report;
};

/// The parent's side of a worker. The process is forked from the parent, which has one thread at that time. It ends
/// with the parent, however that ends, and when its pipe is closed.
class Worker {
 public:
  /// others: the new process closes their pipes. Throws std::system_error where no process can be started.
  Worker(const CaseList& cases, const RunCase& run_case, const std::vector<Worker>& others);
  Worker(Worker&& other) noexcept { *this = std::move(other); }
  Worker& operator=(Worker&& other) noexcept;
  ~Worker() { end(); }

  bool is_busy() const { return case_.has_value(); }
  std::size_t which() const { return *case_; }
  double seconds() const;  ///< since it received its case
  /// False if the worker has died and did not receive the case.
  [[nodiscard]] bool give(std::size_t which);
  /// The answer to its case, after which the worker is idle; none if it is not there yet.
  std::optional<WorkerAnswer> answer();
  /// After `answer`: whether its pipe has ended, because the process has.
  bool has_ended() const { return has_ended_; }
  /// Waits for a process that has ended and returns its wait status.
  int reap();

  void ask_to_stop();
  void kill();
  /// Kills the worker if it holds more memory than this [bytes]. killed_for_memory: how much it held; 0: it was not
  /// killed for that.
  void kill_above(double bytes);
  double killed_for_memory() const { return resident_; }
  /// Whether it was asked to stop: its present case is interrupted, and a following one may be, too.
  bool was_asked_to_stop() const { return asked_; }
  bool was_killed() const { return killed_; }
  int pipe() const { return from_; }  ///< readable when there is data
  /// The history that its present case has written so far.
  std::string_view rows() const { return rows_.text(); }

 private:
  [[noreturn]] void serve(const CaseList& cases, const RunCase& run_case);
  void end();

  static constexpr std::size_t most_rows = 64 << 20;  ///< [bytes] of a history; more goes into folders as it comes

  io::SharedText rows_{most_rows};
  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
  std::optional<std::size_t> case_;
  std::chrono::steady_clock::time_point given_at_;
  std::string told_;
  double resident_ = 0.0;
  bool has_ended_ = false, asked_ = false, killed_ = false;
};

}  // namespace bough::study
