#pragma once
/// The results of one run as one self-contained page: the motion, the histories and how well the laws hold. No
/// network; readable without scripts, with a moving picture where scripts and WebGL run.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bough/io/history.hpp"
#include "bough/io/summary.hpp"
#include "bough/report/picture.hpp"

namespace bough::report {

struct RunFiles {
  std::string name;
  std::optional<io::SummaryFile> summary;  ///< none: the run did not end
  io::History history;
  std::vector<records::MotionFrame> motion;  ///< empty: not recorded
  records::MotionParts parts;                ///< of it
};

/// Reads a result directory. Throws std::runtime_error if it is incomplete or has files of different runs
/// (io::read_whole_summary).
RunFiles read_run(const std::filesystem::path& directory, std::size_t max_frames = 301);

bool is_static(const RunFiles& run);  ///< its histories are functions of the load factor

/// The caller sets options.is_static. other: a second run, which is laid over the first; their differences are plotted.
std::string page_html(const RunFiles& run, const PictureOptions& options, const RunFiles* other = nullptr);

/// What to do where no motion was recorded, in one sentence.
std::string_view how_to_record_motion();

}  // namespace bough::report
