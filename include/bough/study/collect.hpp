#pragma once
/// The shards of a batch put together again.
#include <filesystem>
#include <string>
#include <vector>

#include "bough/study/cases.hpp"
#include "bough/study/journal.hpp"
#include "bough/study/shards.hpp"

namespace bough::study {

inline constexpr const char* shard_file = "shard.json";  ///< what a shard is
inline constexpr const char* keys_file = "keys.csv";     ///< its cases and their keys
inline constexpr const char* journal_file = "journal.jsonl";
inline constexpr const char* cases_file = "cases.csv";  ///< all cases with what varies, of all shards

/// What the results of a shard are, besides its cases.
struct ShardRecord {
  std::string verb;  ///< "batch" or "sweep"
  std::string title;
  std::string source;   ///< folder of scenes or file of the sweep
  std::string cases;    ///< digest of cases.csv
  std::string content;  ///< digest of the scene that all cases share, and of options that decide results
  Shard shard;
  Machine machine;
};
std::string shard_text(const ShardRecord& record);

/// "case,key" and a line a case.
std::string keys_csv(const std::vector<BatchCase>& cases, const std::vector<std::string>& keys);

/// All cases with what they change: header "case" and the variables, JSON values.
std::string cases_csv(const SweepCases& cases);

/// Takes the values of the list that all shards share: draws of another mathematical library may differ from them in
/// the last of their 12 digits. Returns what else differs, in words; empty where the cases are those of the list.
std::string adopt_cases(const std::string& table, SweepCases& cases);

/// What shards have brought together.
struct Collected {
  ShardRecord record;                ///< of the first one; its shard says nothing
  std::string list;                  ///< cases.csv
  std::vector<CaseResult> results;   ///< in the order of the list; those that are missing are not started
  std::vector<std::string> missing;  ///< cases without a row
  std::size_t num_shards = 0;
  std::vector<std::string> machines;    ///< instruction sets and libraries, where there are several; else empty
  std::vector<std::size_t> machine_of;  ///< of each case, into `machines`
};

/// Reads shards: folders that hold one, or folders of such folders; the list of all cases lies in the folder of a
/// shard's folder. Rows are found by case, so any mixture of partitions will do. Throws std::runtime_error in words:
/// no shard, no list, shards of another list, scene, options or program, and two rows of one case that differ though
/// they were made alike.
Collected collect_shards(const std::vector<std::filesystem::path>& folders);

/// batch_csv with a column `machine` at its end where several machines have computed the rows.
std::string collected_csv(const Collected& collected);

}  // namespace bough::study
