#pragma once
/// Collects the shards of a batch.
#include <filesystem>
#include <string>
#include <vector>

#include "bough/study/cases.hpp"
#include "bough/study/journal.hpp"
#include "bough/study/shards.hpp"

namespace bough::study {

inline constexpr const char* shard_file = "shard.json";  ///< identity of a shard
inline constexpr const char* keys_file = "keys.csv";     ///< its cases and their keys
inline constexpr const char* journal_file = "journal.jsonl";
inline constexpr const char* cases_file = "cases.csv";  ///< all cases of all shards, with their inputs

/// Identity of a shard's results, apart from its cases.
struct ShardRecord {
  std::string verb;  ///< "batch" or "sweep"
  std::string title;
  std::string source;   ///< folder of scenes or file of the sweep
  std::string cases;    ///< digest of cases.csv
  std::string content;  ///< digest of the scene common to all cases, and of the options that affect results
  Shard shard;
  Machine machine;
};
std::string shard_text(const ShardRecord& record);

/// "case,key" and a line a case.
std::string keys_csv(const CaseList& cases, const std::vector<std::string>& keys);

/// All cases with what they change: header "case" and the variables, JSON values.
std::string cases_csv(const SweepCases& cases);

/// Replaces the values of the cases by those of the list that all shards share: values drawn with another mathematical
/// library may differ from them in the last of their 12 digits. Returns a description of any other difference; empty if
/// the cases agree with the list.
std::string adopt_cases(const std::string& table, SweepCases& cases);

/// The collected results of all shards.
struct Collected {
  ShardRecord record;                ///< that of the first shard; its shard number has no meaning
  std::string list;                  ///< cases.csv
  CaseTable results;                 ///< in the order of the list; missing cases have none
  std::vector<std::string> missing;  ///< cases without a row
  std::size_t num_shards = 0;
  std::vector<std::string> machines;    ///< instruction sets and libraries, where there are several; else empty
  std::vector<std::size_t> machine_of;  ///< of each case, into `machines`

  /// For the column `machine` of batch.csv; empty for a missing case.
  [[nodiscard]] std::string machine_of_case(std::size_t i) const {
    return results.has(i) ? machines[machine_of[i]] : std::string();
  }
};

/// Reads shards: folders that contain one, or folders of such folders. The list of all cases is in the parent folder of
/// a shard. Rows are identified by their case, so different partitions may be mixed. Throws std::runtime_error with an
/// explanation where there is no shard or no list, where shards belong to another list, scene, options or program, and
/// where two rows of one case differ although they were made under equal conditions.
Collected collect_shards(const std::vector<std::filesystem::path>& folders);

}  // namespace bough::study
