#pragma once
/// A process that runs one case after the other and tells of each.
#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "bough/study/batch.hpp"

namespace bough::study {

/// What a worker says of a case when it ends.
struct WorkerAnswer {
  int code = 1;  ///< of run_case
  double cpu_seconds = 0.0, peak_bytes = 0.0;
  std::string report;
};

/// The parent's side of a worker. The process is forked from the parent, which then has one thread; it ends with the
/// parent, however that ends, and where its pipe is closed.
class Worker {
 public:
  /// others: whose pipes the new process is not to hold open. Throws std::system_error where no process can be started.
  Worker(const std::vector<BatchCase>& cases, const RunCase& run_case, const std::vector<Worker>& others);
  Worker(Worker&& other) noexcept { *this = std::move(other); }
  Worker& operator=(Worker&& other) noexcept;
  ~Worker() { end(); }

  bool is_busy() const { return case_.has_value(); }
  std::size_t which() const { return *case_; }
  double seconds() const;  ///< since it got its case
  /// False where it has died meanwhile, and did not take it.
  [[nodiscard]] bool give(std::size_t which);
  /// The answer to its case, with which it is idle again; nothing where it is not there yet.
  std::optional<WorkerAnswer> answer();
  /// After `answer`: whether its pipe has ended, for it has.
  bool has_ended() const { return has_ended_; }
  /// Waits for the process to end and returns its wait status; for one that has ended.
  int reap();

  void ask_to_stop();
  void kill();
  /// Kills it where it holds more memory in the machine than this [bytes]. killed_for_memory: how much it held; 0: it
  /// was not killed for that.
  void kill_above(double bytes);
  double killed_for_memory() const { return resident_; }
  /// Whether it was asked to: what it runs is cut off, and what it would run after that may be, too.
  bool was_asked_to_stop() const { return asked_; }
  bool was_killed() const { return killed_; }
  int pipe() const { return from_; }  ///< readable where there is something to be had

 private:
  [[noreturn]] void serve(const std::vector<BatchCase>& cases, const RunCase& run_case);
  void end();

  pid_t process_ = -1;
  int to_ = -1, from_ = -1;
  std::optional<std::size_t> case_;
  std::chrono::steady_clock::time_point given_at_;
  std::string told_;
  double resident_ = 0.0;
  bool has_ended_ = false, asked_ = false, killed_ = false;
};

}  // namespace bough::study
