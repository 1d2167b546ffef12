#pragma once
/// What `bough batch` and `bough sweep` share: how a case is run, told and summed up.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/study/batch.hpp"
#include "bough/study/collect.hpp"

namespace bough::app {

/// What is left of a case besides its row.
enum class Kept { nothing, store, folder };
/// As asked for, of so many cases. Throws io::OutputRefused where they would be too many folders.
Kept kept_of(const CaseArguments& arguments, std::size_t num_cases);

struct CaseSettings : CaseArguments {
  std::string title;
  Kept kept = Kept::folder;  ///< of all cases but those that `keep_cases` names: these keep folders
  std::optional<study::ShardRecord> shard_record = {};  ///< of the shard that the cases are; `out` is its own folder
  Kept kept_as(const study::BatchCase& which) const;
};

/// The scene of a case.
struct CaseSource {
  std::function<io::SceneFile(const study::BatchCase&)> read;
  std::function<std::string(const study::BatchCase&)> text;  ///< what it is read from, without what the case changes
  std::string cases_table = {};                              ///< written as cases.csv; empty: it is not
};

/// The owner of the results of a batch in its folder, before anything there is touched. Rows that would be lost are
/// refused: without --resume, which takes them over, or --replace, which deletes them. A damaged manifest beside a
/// journal that is whole is made anew with --resume, which is told. Throws io::OutputRefused.
io::Owner take_folder(const CaseSettings& settings, const std::string& verb, const std::filesystem::path& source);

/// Runs the cases, large ones first where they are few enough to be looked at before.
/// batch.html is rewritten from time to time. Every case that ends is written into journal.jsonl at once; cases that a
/// journal taken over holds are not run again. Throws io::OutputRefused where another batch writes into the folder.
study::CaseTable run_cases(const study::CaseList& cases, const CaseSettings& settings, const CaseSource& source,
                           io::OutputCollection& collection);

/// What a retried case depends on besides its scene and what it changes there: of its key.
std::string policy_of(const CaseArguments& arguments);

/// collected: of shards that were collected, where the results come from. Writes batch.csv, batch.json, batch.html,
/// cost.csv and, where there are sensitivities, sensitivities.csv; tells what came of the cases and returns the exit
/// status.
int finish_cases(const study::CaseTable& results, const std::vector<study::MeasureSensitivity>& sensitivities,
                 const CaseSettings& settings, io::OutputCollection& collection,
                 const study::Collected* collected = nullptr);

/// Indices of sensitivity as tables, on standard output.
void print_sensitivities(const std::vector<study::MeasureSensitivity>& sensitivities);

}  // namespace bough::app
