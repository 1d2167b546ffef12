#pragma once
/// `summary.json`: how a run ended, what it cost and whether its laws held. Written last: a directory that holds one is whole.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bough/results/records.hpp"

namespace bough::io {

/// "ok", "failed", "interrupted".
std::string_view status_text(results::RunStatus status);

/// The file's text. NaN and infinity appear as the strings "nan", "inf", "-inf", never as null. Options are keyed by their JSON pointer, as
/// `--set` takes them.
std::string summary_text(const results::Summary& summary, std::string_view version);

/// What the report, the comparison and the batch table need of a summary.
struct SummaryFile {
  std::string status, cause, scene, title, version;
  long accepted = 0, rejected = 0, newton_iterations = 0;
  std::vector<std::pair<std::string, double>> checks;        ///< numbers only
  std::vector<std::pair<std::string, std::string>> options;  ///< by JSON pointer; texts only
  std::vector<std::string> notes;
  std::vector<results::Doubt> doubts;  ///< why the run should not be trusted
  std::vector<results::ExpectedResult> expected;
};

/// Throws std::runtime_error naming the file and what is wrong.
SummaryFile read_summary(const std::filesystem::path& path);

}  // namespace bough::io
