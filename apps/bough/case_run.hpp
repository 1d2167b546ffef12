#pragma once
/// What `bough batch` and `bough sweep` share: how a case is run, told and summed up.
#include <functional>
#include <string>
#include <vector>

#include "bough/io/output_folder.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/study/batch.hpp"

namespace bough::app {

struct CaseSettings {
  std::filesystem::path out;
  std::string title;
  int threads = 0;
  double time_limit = 0.0, memory_limit = 0.0;
  bool keeps_results = true;  ///< every case gets a folder; else its row is all that is left of it
  bool quiet = false, check_expected = false;
  double stop_after = 0.0;  ///< [s] from the start, stops as a user would; 0: never
  int retries = 0;          ///< of a case that fails, each with steps half as long
  bool resumes = false;     ///< takes over what a batch into the same folder has done
};

/// The scene of a case.
struct CaseSource {
  std::function<io::SceneFile(const study::BatchCase&)> read;
  std::function<std::string(const study::BatchCase&)> text;  ///< what it is read from, without what the case changes
  std::string cases_table = {};                              ///< written as cases.csv; empty: it is not
};

/// Runs the cases, large ones first where they are few enough to be looked at before.
/// batch.html is rewritten from time to time. Every case that ends is written into journal.jsonl at once; cases that a
/// journal taken over holds are not run again. Throws io::OutputRefused where another batch writes into the folder.
std::vector<study::CaseResult> run_cases(const std::vector<study::BatchCase>& cases, const CaseSettings& settings,
                                         const CaseSource& source, const io::OutputCollection& collection);

/// Writes batch.csv, batch.json, batch.html, cost.csv and, where there are sensitivities, sensitivities.csv; tells what came of the
/// cases and returns the exit status.
int finish_cases(const std::vector<study::CaseResult>& results,
                 const std::vector<study::MeasureSensitivity>& sensitivities, const CaseSettings& settings,
                 const io::OutputCollection& collection);

}  // namespace bough::app
