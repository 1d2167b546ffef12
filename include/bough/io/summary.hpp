#pragma once
/// `summary.json`: how a run ended, its cost and its checks. It is written last: a directory with a summary is
/// complete.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/manifest.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

/// Inputs of a run: the scene, overrides, and the program.
struct RunOrigin {
  std::filesystem::path scene_file = {};       ///< "-": standard input; empty: the scene was made in memory
  std::string scene_hash = {};                 ///< digest of its bytes
  std::vector<std::string> overrides = {};     ///< "/pointer=value", in the order in which they were applied
  std::string commit = {}, program_hash = {};  ///< of the program that ran (program_hash.hpp)
  std::string key = {};                        ///< of a case of a batch: its identity (manifest.hpp)

  std::vector<std::filesystem::path> inputs() const;  ///< files that the results must not replace
};

/// "ok", "failed", "interrupted".
std::string_view status_text(records::RunStatus status);

/// The file's text. NaN and infinity appear as the strings "nan", "inf", "-inf", never as null. Options are keyed by
/// their JSON pointer, as `--set` takes them. files: all that belong to the run, each with its hash.
std::string summary_text(const records::Summary& summary, std::string_view version, const RunOrigin& origin = {},
                         const std::vector<FileRecord>& files = {});

/// The parts of a summary that the report, the comparison and the batch table need.
struct SummaryFile {
  std::string status, cause, scene, title, version;
  long accepted = 0, rejected = 0, newton_iterations = 0;
  std::vector<std::pair<std::string, double>> checks;        ///< numbers only
  std::vector<std::pair<std::string, std::string>> options;  ///< by JSON pointer; texts only
  std::vector<std::string> notes;
  std::vector<records::Doubt> doubts;  ///< reasons not to trust the run
  std::string not_judged;              ///< errors that may exist nevertheless
  std::vector<records::ExpectedResult> expected;
  std::vector<records::MeasureResult> measures;
  std::vector<std::string> overrides;  ///< of the scene, as they were given
  std::vector<FileRecord> files;       ///< that were written with it
};

/// Throws std::runtime_error naming the file and what is wrong.
SummaryFile read_summary(const std::filesystem::path& path);

/// The summary of a directory, after checking that the files `names` were written together with it. Throws
/// std::runtime_error if the directory is incomplete, or if one of them is listed but missing, exists but is not
/// listed, or has changed.
SummaryFile read_whole_summary(const std::filesystem::path& directory, const std::vector<std::string>& names);

}  // namespace bough::io
