#pragma once
/// Runs many cases, one thread and one row of `batch.csv` for each. Scenes of a folder and the cases of a sweep use the
/// same engine.
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/shared_text.hpp"
#include "bough/io/text_sink.hpp"
#include "bough/study/case_table.hpp"
#include "bough/study/sensitivity.hpp"

namespace bough::study {

struct BatchOptions {
  int threads = 1;                 ///< total number of threads of the cases that run at a time, >= 1
  double time_limit = 0.0;         ///< wall time of one case [s]; 0: none
  double resident_limit = 0.0;     ///< memory that one worker may hold in the machine [bytes]; 0: any
  std::vector<std::size_t> order;  ///< order in which cases are started, each once; empty: as given. The order of rows
                                   ///< does not depend on it
};

/// Runs a case, in another process than the one that collects. Returns the exit status of `bough run` (0 done, 1
/// failed, 2 bad input). rows: receives the history, head and rows, of a case whose results are not written to a folder
/// while it runs; if the process dies, they are kept.
using RunCase = std::function<int(const BatchCase&, CaseReport& report, io::SharedText& rows)>;

/// Called when a case has ended, with its result and index, and with all results so far, this one included.
using CaseDone = std::function<void(const CaseResult&, std::size_t which, const CaseTable& all)>;

/// Every *.json file directly in a folder is a case, ordered by name; case NAME writes to out/NAME. Throws
/// std::runtime_error where the folder cannot be read or has no such file.
std::vector<BatchCase> cases_in(const std::filesystem::path& folder, const std::filesystem::path& out);

/// Whether a batch writes a file or a folder of its own under this name into its folder, so that no case can have it.
bool is_name_of_batch(std::string_view name);

/// Runs all cases of a table that have no result yet, and returns the table with theirs; results do not depend on which
/// finishes first. Worker processes run the cases, each worker one after the other, so that a case that crashes, hangs
/// or exhausts memory harms no other: its worker is replaced. All workers end with this process, however it ends. If no
/// process can be started, the case has failed. `stop` is asked between cases; once it returns true, no further case
/// starts, and running cases are told to stop (SIGTERM). A case beyond its time limit is told to stop as well, and is
/// killed if it does not end. A case whose worker holds more memory than its limit is killed; this is checked every
/// fiftieth of a second. Call this function while the process has one thread.
CaseTable run_batch(CaseTable table, const BatchOptions& options, const RunCase& run_case, const CaseDone& done,
                    const std::function<bool()>& stop);

/// The table with one row per case: case, status, cause, counts of steps and figures, doubts, checks, then inputs and
/// measures by name; cells without a value are empty. It contains no measured times, so that equal results give equal
/// files. Text that a spreadsheet would take for a formula begins with an apostrophe. machine_of: if given, the content
/// of a last column `machine`.
void write_batch_csv(const CaseTable& results, const io::TextSink& sink,
                     const std::function<std::string(std::size_t)>& machine_of = {});
/// The table as JSON, with inputs and measures as numbers, and the sensitivities of each measure to the inputs.
void write_batch_json(const CaseTable& results, const std::string& title,
                      const std::vector<MeasureSensitivity>& sensitivities, const io::TextSink& sink);
/// case,wall_seconds,cpu_seconds,peak_megabytes
void write_cost_csv(const CaseTable& results, const io::TextSink& sink);
/// measure,method,index,variable,value,low,high,cases
std::string sensitivities_csv(const std::vector<MeasureSensitivity>& sensitivities);

}  // namespace bough::study
