#pragma once
/// What a run has recorded that goes on, was killed, or was stopped, for readers that do not wait for its end.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "bough/io/history.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

/// The first line of a checkpoint, in words, so that it can be told what a file is that cannot be used.
struct CheckpointHead {
  std::string format, program_hash;
  std::string identity;         ///< of the scene with all that was changed in it, or of the case
  long number = 0;              ///< of the run's checkpoints, from 1
  double time = 0.0;            ///< [s], or load factor
  std::uint64_t num_bytes = 0;  ///< that follow the line
  std::string digest;           ///< of these

  std::string text() const;
};
/// None: the line is no such head.
std::optional<CheckpointHead> read_checkpoint_head(std::string_view line);

/// `progress.json` of a run: how far it had come when it told last.
struct RunProgress {
  double time = 0.0, end_time = 0.0;  ///< [s], or load factor
  long steps = 0;                     ///< accepted
  double seconds = 0.0;               ///< of wall clock since it began, or went on
  double from = 0.0;                  ///< time at which it began, or went on
  /// Wall clock that is left, if it goes on as fast as so far [s]; 0: not known.
  double seconds_left() const { return time > from ? seconds * (end_time - time) / (time - from) : 0.0; }
};
std::string progress_text(const RunProgress& progress);

struct UnfinishedRun {
  std::filesystem::path place;  ///< folder in which its files stand, some of them as <name>.partial
  bool goes_on = false;         ///< its writer is at work
  std::optional<RunProgress> progress = {};
  std::optional<double> checkpoint = {};  ///< time of the last one
};

/// The run whose results belong into a directory, or stand there, without having ended; none: there is none, or there
/// are results of one that has ended.
std::optional<UnfinishedRun> find_unfinished_run(const std::filesystem::path& directory);

/// The file of this name in the place of an unfinished run, under the name that it has there; empty: there is none.
std::filesystem::path file_so_far(const UnfinishedRun& run, const std::string& name);

/// The whole rows of its history. Throws as read_history.
History read_rows_so_far(const UnfinishedRun& run);

}  // namespace bough::io
