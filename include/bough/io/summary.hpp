#pragma once
/// `summary.json`: how a run ended, its cost and its checks. It is written last: a directory with a summary is
/// complete.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/manifest.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

/// The state of another run in which a run starts.
struct StartOrigin {
  std::filesystem::path folder, file;  ///< of the other run, and the file in it that holds the state
  double time = 0.0;                   ///< [s], or load factor
  std::string hash = {};               ///< of the state
};

/// Inputs of a run: the scene, overrides, and the program.
struct RunOrigin {
  std::filesystem::path scene_file = {};       ///< "-": standard input; empty: the scene was made in memory
  std::string scene_hash = {};                 ///< digest of its bytes
  std::vector<std::string> overrides = {};     ///< "/pointer=value", in the order in which they were applied
  std::string commit = {}, program_hash = {};  ///< of the program that ran (program_hash.hpp)
  std::string key = {};                        ///< of a case of a batch: its identity (manifest.hpp)
  std::optional<StartOrigin> from = {};        ///< none: the scene's own start

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
  std::vector<records::Table> tables;
  std::string scene_hash, start_hash;  ///< of the scene, and of the state in which it started; empty: there is none
  std::vector<std::string> overrides;  ///< of the scene, as they were given
  std::vector<FileRecord> files;       ///< that were written with it
};

/// Throws std::runtime_error naming the file and what is wrong.
SummaryFile read_summary(const std::filesystem::path& path);

/// Changes whenever new results take the place of those in a directory.
std::string state_of_folder(const std::filesystem::path& directory);
/// Whether a directory still has this state, and nobody moves new results into it; waits a moment where somebody does.
bool is_settled(const std::filesystem::path& directory, const std::string& state);

/// The summary of a directory, after checking that the files `names` were written together with it. Throws
/// std::runtime_error if the directory is incomplete, or if one of them is listed but missing, exists but is not
/// listed, or has changed.
SummaryFile read_whole_summary(const std::filesystem::path& directory, const std::vector<std::string>& names);

/// What read() makes of the files of a directory, all of one run: where the directory was replaced by new results in the
/// meantime, they are read once more. Throws what read() throws of a directory that stays.
template <class Read>
auto read_unchanged(const std::filesystem::path& directory, const Read& read) {
  constexpr int most_tries = 20;
  for (int k = 1;; ++k) {
    const std::string before = state_of_folder(directory);
    try {
      auto result = read();
      if (k == most_tries || state_of_folder(directory) == before) return result;
    } catch (const std::runtime_error&) {
      if (k == most_tries || is_settled(directory, before)) throw;
    }
  }
}

}  // namespace bough::io
