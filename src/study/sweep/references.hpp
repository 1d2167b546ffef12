#pragma once
/// What the runs of a study are compared with: formulas, tables, and runs of its own that are computed once and kept.
#include <filesystem>
#include <string>
#include <vector>

#include "bough/study/errors.hpp"
#include "bough/study/sweep.hpp"
#include "sampled_run.hpp"

namespace bough::study {

/// All that a computed reference depends on: the scene with its defaults, the sample times, this program.
std::string made_from(const io::StudySpec& spec, const std::vector<std::string>& overrides);

/// References in a folder, two files each: HASH.csv (a history) and HASH.txt (what it was made from, to the letter).
class ReferenceCache {
 public:
  explicit ReferenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// The history, if one is there that was made from the same.
  std::optional<io::History> find(const std::string& from) const;
  void keep(const std::string& from, const io::History& history) const;

 private:
  std::filesystem::path folder_;  ///< empty: nothing is kept
};

/// The references of a grid: what is told of them, and their values by quantity.
struct GridReference {
  SweepReference told;
  std::vector<Samples> values;
};

/// A computed reference of a study: its run and the run of its check.
struct ReferenceRun {
  std::vector<std::string> overrides;
  std::string from;
  SampledRun run;
  bool is_cached = false;
};

/// Those that the grids need, each once; `which[g]` are the two of grid g, none where its quantities have formulas
/// and tables.
struct ReferenceRuns {
  std::vector<ReferenceRun> runs;
  std::vector<std::vector<std::size_t>> which;
};
ReferenceRuns plan_references(const io::StudySpec& spec);

GridReference make_reference(const io::StudySpec& spec, const ReferenceRuns& references, std::size_t grid);

}  // namespace bough::study
