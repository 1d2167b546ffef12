#pragma once
/// The references of a study: formulas, tables, and computed runs that are kept in a cache.
#include <filesystem>
#include <string>
#include <vector>

#include "bough/study/errors.hpp"
#include "bough/study/sweep.hpp"
#include "sampled_run.hpp"

namespace bough::study {

/// Identity of a computed reference: the scene with its defaults, the sample times, this program.
std::string made_from(const io::StudySpec& spec, const std::vector<std::string>& overrides);

/// Computed references in a folder, two files each: HASH.csv (a history) and HASH.txt (the full text of its identity).
class ReferenceCache {
 public:
  explicit ReferenceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// The history with exactly this identity, if there is one.
  std::optional<io::History> find(const std::string& from) const;
  void keep(const std::string& from, const io::History& history) const;

 private:
  std::filesystem::path folder_;  ///< empty: no cache
};

/// The references of a grid: their description, and their values by quantity.
struct GridReference {
  SweepReference told;
  std::vector<Samples> values;
};

/// A computed reference of a study: its run, and the run that checks it.
struct ReferenceRun {
  std::vector<std::string> overrides;
  std::string from;
  SampledRun run;
  bool is_cached = false;
};

/// The computed references that the grids need, each once; `which[g]` are the two runs of grid g, none if its
/// quantities have formulas and tables.
struct ReferenceRuns {
  std::vector<ReferenceRun> runs;
  std::vector<std::vector<std::size_t>> which;
};
ReferenceRuns plan_references(const io::StudySpec& spec);

GridReference make_reference(const io::StudySpec& spec, const ReferenceRuns& references, std::size_t grid);

}  // namespace bough::study
