#pragma once
/// Runs many cases, one thread and one row of `batch.csv` for each. Scenes of a folder and the cases of a sweep use the
/// same engine.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bough/io/run_store.hpp"
#include "bough/io/shared_text.hpp"
#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"
#include "bough/study/sensitivity.hpp"

namespace bough::study {

struct BatchOptions {
  int threads = 1;                 ///< total number of threads of the cases that run at a time, >= 1
  double time_limit = 0.0;         ///< wall time of one case [s]; 0: none
  double resident_limit = 0.0;     ///< memory that one worker may hold in the machine [bytes]; 0: any
  std::vector<std::size_t> order;  ///< order in which cases are started; empty: as given. The order of rows does not
                                   ///< depend on it
};

struct BatchCase {
  std::string name;
  std::filesystem::path scene, directory;  ///< directory: of the case's results
  std::vector<std::string> overrides = {};
  std::vector<std::pair<std::string, std::string>> inputs = {};  ///< the varied inputs and their values as JSON, for
                                                                 ///< tables
  int threads = 1;  ///< number of threads that the case asks for; it gets no more than there are
};

/// figures_fail: the run is complete, and an expected figure of its scene does not hold.
enum class CaseStatus { ok, figures_fail, failed, interrupted, bad_input, crashed, timed_out };

/// Report of a case at its end. It is passed from the process of the case to the process that collects results.
struct CaseReport {
  std::string cause;                ///< what to report
  std::filesystem::path directory;  ///< directory of its results; empty: it left none, or they are stored
  std::optional<io::StoredPlace> stored;
  bool was_interrupted = false;
  bool is_unwritten = false;  ///< its results could not be written; the case may succeed when there is space
  long accepted = 0, rejected = 0, newton_iterations = 0;
  int expected_holds = 0, expected_fails = 0;
  std::string failing;              ///< the first expected figures that do not hold, in words
  std::vector<std::string> doubts;  ///< subjects of the doubts
  std::vector<records::MeasureResult> measures;
  std::vector<std::string> units;  ///< of the measures, in their order; empty text: a pure number, or not known
  std::optional<double> energy_error,
      constraint_error;  ///< largest energy error over the largest energy; largest violation over the size of the parts
  /// Copies counts, figures and measures from the summary of a run.
  void take(const records::Summary& summary, const scene::Scene& scene);
};

/// Measured times and memory of a case. They differ from run to run.
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

/// Runs a case, in another process than the one that collects. Returns the exit status of `bough run` (0 done, 1
/// failed, 2 bad input). rows: receives the history, head and rows, of a case whose results are not written to a folder
/// while it runs; if the process dies, they are kept.
using RunCase = std::function<int(const BatchCase&, CaseReport& report, io::SharedText& rows)>;

/// Called after every case with the number of finished cases and the total.
using CaseDone = std::function<void(const CaseResult&, std::size_t done, std::size_t all)>;

/// Every *.json file directly in a folder is a case, ordered by name; case NAME writes to out/NAME. Throws
/// std::runtime_error where the folder cannot be read or has no such file.
std::vector<BatchCase> cases_in(const std::filesystem::path& folder, const std::filesystem::path& out);

/// Runs all cases; results are in the order of the cases, whichever finishes first. Worker processes run the cases,
/// each worker one after the other, so that a case that crashes, hangs or exhausts memory harms no other: its worker is
/// replaced. All workers end with this process, however it ends. If no process can be started, the case has failed.
/// `stop` is asked between cases; once it returns true, no further case starts, and running cases are told to stop
/// (SIGTERM). A case beyond its time limit is told to stop as well, and is killed if it does not end. A case whose
/// worker holds more memory than its limit is killed; this is checked every fiftieth of a second. Call this function
/// while the process has one thread.
std::vector<CaseResult> run_batch(const std::vector<BatchCase>& cases, const BatchOptions& options,
                                  const RunCase& run_case, const CaseDone& done, const std::function<bool()>& stop);

/// The table with one row per case: case, status, cause, counts of steps and figures, doubts, checks, then inputs and
/// measures by name; cells without a value are empty. It contains no measured times, so that equal results give equal
/// files. Text that a spreadsheet would take for a formula begins with an apostrophe.
std::string batch_csv(const std::vector<CaseResult>& results);
/// The table as JSON, with inputs and measures as numbers, and the sensitivities of each measure to the inputs.
std::string batch_json(const std::vector<CaseResult>& results, const std::string& title,
                       const std::vector<MeasureSensitivity>& sensitivities = {});
/// measure,method,index,variable,value,low,high,cases
std::string sensitivities_csv(const std::vector<MeasureSensitivity>& sensitivities);
/// case,wall_seconds,cpu_seconds,peak_megabytes
std::string cost_csv(const std::vector<CaseResult>& results);

std::string_view text_of(CaseStatus status);

}  // namespace bough::study
