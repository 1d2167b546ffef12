#pragma once
/// Many cases, each a run of its own: one thread a case, one row of `batch.csv` a case. Scenes of a folder and the
/// cases of a sweep are run by the same engine.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bough/io/run_store.hpp"
#include "bough/records/run.hpp"
#include "bough/study/sensitivity.hpp"

namespace bough::study {

struct BatchOptions {
  int threads = 1;                 ///< of all cases that run at a time, >= 1
  double time_limit = 0.0;         ///< wall time of one case [s]; 0: none
  double resident_limit = 0.0;     ///< memory that one worker may hold in the machine [bytes]; 0: any
  std::vector<std::size_t> order;  ///< in which cases are started; empty: as they come. Rows do not depend on it
};

struct BatchCase {
  std::string name;
  std::filesystem::path scene, directory;  ///< directory: of its results
  std::vector<std::string> overrides = {};
  std::vector<std::pair<std::string, std::string>> inputs = {};  ///< what varies and its value as JSON, for tables
  int threads = 1;                                               ///< that it asks for; it gets no more than there are
};

/// figures_fail: the run is complete, and an expected figure of its scene does not hold.
enum class CaseStatus { ok, figures_fail, failed, interrupted, bad_input, crashed, timed_out };

/// What a case tells of itself when it ends; it is handed from its process to the one that collects.
struct CaseReport {
  std::string cause;                ///< what to report
  std::filesystem::path directory;  ///< where its results stand; empty: it left none, or it is stored
  std::optional<io::StoredPlace> stored;
  bool was_interrupted = false;
  bool is_unwritten = false;  ///< its results could not be written: it may end otherwise when there is room
  long accepted = 0, rejected = 0, newton_iterations = 0;
  int expected_holds = 0, expected_fails = 0;
  std::string failing;              ///< the first expected figures that do not hold, in words
  std::vector<std::string> doubts;  ///< what they are about
  std::vector<records::MeasureResult> measures;
  std::optional<double> energy_error,
      constraint_error;  ///< largest, over the largest energy; over the size of the parts
  /// Counts, figures and measures of a run.
  void take(const records::Summary& summary);
};

/// What it took: measured by clocks, and so not the same twice.
struct CaseCost {
  double wall_seconds = 0.0, cpu_seconds = 0.0;
  double peak_bytes = 0.0;
};

struct CaseResult {
  BatchCase which;
  CaseStatus status = CaseStatus::failed;
  std::string cause;  ///< in one line; empty where ok
  CaseReport report;
  CaseCost cost;
};

/// How a case is run, in another process than that which collects: the exit status of `bough run` (0 done, 1 failed,
/// 2 bad input).
using RunCase = std::function<int(const BatchCase&, CaseReport& report)>;

/// Told after every case: how many are done, of how many.
using CaseDone = std::function<void(const CaseResult&, std::size_t done, std::size_t all)>;

/// Every *.json of a folder is a case, by name; not searched deeper; case NAME writes to out/NAME. Throws
/// std::runtime_error where the folder cannot be read or holds none.
std::vector<BatchCase> cases_in(const std::filesystem::path& folder, const std::filesystem::path& out);

/// Runs all cases; results are in the order of the cases whatever finishes first. Cases run in worker processes, one
/// at a time in each and many one after the other, so that one that crashes, hangs or takes all memory harms no
/// other: its worker is replaced. All workers end with this process, however it ends. Where no process can be started
/// a case has failed. `stop` is asked between cases; once true no further case starts and those running are told to
/// stop (SIGTERM). A case past its time limit is told so, too, and is killed where it does not end by itself; one
/// whose worker holds more memory than its limit is killed, by a look every fiftieth of a second. Call it while the
/// process has one thread.
std::vector<CaseResult> run_batch(const std::vector<BatchCase>& cases, const BatchOptions& options,
                                  const RunCase& run_case, const CaseDone& done, const std::function<bool()>& stop);

/// The table, a row a case: case, status, cause, counts of steps and figures, doubts, checks, then inputs, then
/// measures, each by name; empty cells where a case has none. Holds nothing that a clock gave, so that equal results
/// give equal files. Text that a spreadsheet would take for a formula begins with an apostrophe.
std::string batch_csv(const std::vector<CaseResult>& results);
/// The same as JSON, with inputs and measures as numbers, and how much inputs decide each measure.
std::string batch_json(const std::vector<CaseResult>& results, const std::string& title,
                       const std::vector<MeasureSensitivity>& sensitivities = {});
/// measure,method,index,variable,value,low,high,cases
std::string sensitivities_csv(const std::vector<MeasureSensitivity>& sensitivities);
/// case,wall_seconds,cpu_seconds,peak_megabytes
std::string cost_csv(const std::vector<CaseResult>& results);

std::string_view text_of(CaseStatus status);

}  // namespace bough::study
