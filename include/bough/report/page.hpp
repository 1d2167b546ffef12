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
  io::History errors = {};                   ///< of errors.csv; no rows: none were measured
  std::vector<records::MotionFrame> motion;  ///< empty: not recorded
  records::MotionParts parts;                ///< of it
  bool is_by_step = false;                   ///< times are numbers of steps: see by_step()
};

/// Reads a result directory. Throws std::runtime_error if it is incomplete or has files of different runs
/// (io::read_whole_summary).
RunFiles read_run(const std::filesystem::path& directory, std::size_t max_frames = 301);

bool is_static(const RunFiles& run);    ///< its histories are functions of the load factor
bool is_of_modes(const RunFiles& run);  ///< its pictures are shapes of modes: that of mode k from time k - 1 to k
/// "3: 12.5 Hz, 'blade' bends along (0, 0, 1)"
std::vector<std::string> mode_labels(const RunFiles& run);
/// The state that modes are about, and the shape of one (from 1 on) where it is farthest, to both sides. Nothing where
/// there is no such mode.
std::vector<records::MotionFrame> frames_of_mode(const RunFiles& run, int mode);
/// Whether velocities of its motion are derivatives of the places by what the histories are functions of.
bool has_velocities(const RunFiles& run);

/// The run with the number of the step instead of the load factor, which becomes a sensor. Along a path load factors
/// may turn back, so that nothing is a function of them.
RunFiles by_step(RunFiles run);
bool turns_back(const RunFiles& run);  ///< the load factor of some step is not above that of the step before

/// What histories are drawn over, with its unit.
std::string_view time_label(const RunFiles& run);

/// The caller sets options.is_static. other: a second run, which is laid over the first; their differences are plotted.
std::string page_html(const RunFiles& run, const PictureOptions& options, const RunFiles* other = nullptr);

/// What to do where no motion was recorded, in one sentence.
std::string_view how_to_record_motion();

}  // namespace bough::report
