#pragma once
/// Many scenes, each a case of its own: one thread a case, one directory and one row of `batch.csv` a case.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace bough::study {

struct BatchOptions {
  std::filesystem::path folder;  ///< every *.json in it is a case, named by its stem; not searched deeper
  std::filesystem::path out;     ///< case NAME writes to out/NAME
  int threads = 1;               ///< cases at a time, >= 1
  double time_limit = 0.0;       ///< wall time of one case [s]; 0: none
};

struct BatchCase {
  std::string name;
  std::filesystem::path scene, directory;
};

/// figures_fail: the run is complete, and an expected figure of its scene does not hold.
enum class CaseStatus { ok, figures_fail, failed, interrupted, bad_input, crashed, timed_out };

struct CaseResult {
  BatchCase which;
  CaseStatus status = CaseStatus::failed;
  std::string cause;  ///< in one line; empty where ok
  long accepted = 0, rejected = 0, newton_iterations = 0;
  int expected_holds = 0, expected_fails = 0;
};

/// What a case tells of itself when it ends.
struct CaseReport {
  std::string cause;                ///< what to report
  std::filesystem::path directory;  ///< where its results stand; empty: it left none
};

/// How a case is run, in a process of its own: the exit status of `bough run` (0 done, 1 failed, 2 bad input).
using RunCase = std::function<int(const BatchCase&, CaseReport& report)>;

/// Told after every case: how many are done, of how many.
using CaseDone = std::function<void(const CaseResult&, std::size_t done, std::size_t all)>;

/// The cases of a folder by name. Throws std::runtime_error where it cannot be read or holds none.
std::vector<BatchCase> cases_in(const BatchOptions& options);

/// Runs all cases; rows are in the order of `cases_in` whatever finishes first. Each case runs in a child process, so
/// that one that crashes, hangs or takes all memory harms no other; all of them end with this process, however it
/// ends. A case for which no process can be started has failed. `stop` is asked between cases; once true no further
/// case starts and those running are told to stop (SIGTERM). A case past its time limit is told so, too, and is
/// killed where it does not end by itself. Call it while the process has one thread.
std::vector<CaseResult> run_batch(const BatchOptions& options, const RunCase& run_case, const CaseDone& done,
                                  const std::function<bool()>& stop);

/// The table: case,status,cause,steps_accepted,steps_rejected,newton_iterations,expected_holds,expected_fails. Holds
/// no times, so that equal results give equal files.
std::string batch_csv(const std::vector<CaseResult>& results);

std::string_view text_of(CaseStatus status);

}  // namespace bough::study
