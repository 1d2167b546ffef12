#pragma once
/// What `bough batch` and `bough sweep` do with shards: run one, write the job file of all.
#include <functional>
#include <string>
#include <vector>

#include "case_run.hpp"

namespace bough::app {

/// A batch as it is asked for, before it is known which of its cases are to run here.
struct WholeBatch {
  std::string verb;
  std::filesystem::path source;               ///< folder of scenes, or file of a sweep
  std::vector<std::filesystem::path> inputs;  ///< that results must not replace
  study::CaseList cases = {};
  std::string list = {};                           ///< cases.csv
  std::function<std::vector<double>()> work = {};  ///< predicted, by case
};

/// Prints which shard it is and where that was found. Throws io::OutputRefused in words where it is not known.
study::Shard shard_asked_for(const std::string& text);

/// Where the cases of a shard go.
std::filesystem::path folder_of(const CaseArguments& arguments, const study::Shard& shard);

/// Counts of work that a run of the scene is predicted to take, unknowns times steps; 0 where it has problems.
double work_of(const io::SceneFile& file);

/// The list of cases for all shards: written by the first, taken by all. Returns what stands there; the caller refuses
/// one of another batch by `refuse_other_list`.
std::string list_for_shards(const WholeBatch& batch, const CaseArguments& arguments);
[[noreturn]] void refuse_other_list(const CaseArguments& arguments, const std::string& why);

/// Makes the settings and the cases those of one shard.
void take_shard(const study::Shard& shard, const CaseSource& source, WholeBatch& batch, CaseSettings& settings);

/// Writes the job file that `settings` ask for; returns the exit status.
int export_jobs(const WholeBatch& batch, const CaseArguments& arguments, const CaseSource& source);

}  // namespace bough::app
