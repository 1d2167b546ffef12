#pragma once
/// Folders of cases within the folder of a batch. A case is identified by its key (key_of), which stands in the manifest
/// of its folder, beside its results in a store, and in its line of the journal. Names of cases change when a sweep
/// does: `keys.csv` gives the key of each name at present, and every search by name goes through it.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bough/study/journal.hpp"

namespace bough::study {

/// A case found by its name.
struct FoundCase {
  std::filesystem::path batch;  ///< folder of the batch, or of the shard, that has it
  std::string key;
  std::optional<CaseResult> result;  ///< of its newest line in the journal; none: it has not ended
};
/// In the folder of a batch, or in those of the shards within; none where no batch there has such a case.
std::optional<FoundCase> find_case(const std::filesystem::path& folder, const std::string& name);

/// Why a folder is not that of the case whose name it has, in a sentence; empty if it is, or if it is of no case.
std::string why_not_of_its_case(const std::filesystem::path& folder);

/// Whether the results in a folder are those of the case with this key, as its line in the journal tells of them.
bool holds_case(const std::filesystem::path& folder, const std::string& key, const CaseResult& result);

/// Removes the results of a case, whatever they are of; what others put into the folder is left, under the name
/// <folder>.former. Returns that name where it was needed.
std::optional<std::filesystem::path> remove_case(const std::filesystem::path& folder);

/// Moves the folders of cases that are done, by the journal, to the names that they have now, and removes all that are
/// neither of a present case under its name nor of one that is done. Returns folders that were left aside, as
/// remove_case. Precondition: the caller holds the folder of the batch.
std::vector<std::filesystem::path> settle_case_folders(const std::filesystem::path& batch, const CaseList& cases,
                                                       const Records& records);

}  // namespace bough::study
