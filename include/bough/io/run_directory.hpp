#pragma once
/// The directory of one run: the recorder that writes it.
///   history.csv    the sensors
///   history.npy    the same of more than 10 000 rows, for NumPy
///   columns.json   unit, quantity and part of each of its columns
///   errors.csv     errors of all columns at the times of the history, where the analysis wants them measured
///   motion.pvd, motion/frame_000000.vtu ..., motion.bin   where motion is recorded
///                  (a build without BOUGH_WITH_VTK writes motion.bin only)
///   motion.glb     the moving structure for other viewers, where the scene asks for it
///   states.bin     states from which other scenes can start (stored_states.hpp)
///   summary.json   status, cost and checks of the run, its inputs, the hash of every file
///   manifest.json  the files in the directory that bough wrote (manifest.hpp)
/// All of them appear under the directory's name together, at the end (output_folder.hpp).
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bough/io/output_folder.hpp"
#include "bough/io/summary.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

class ResultWriter;

/// When a run keeps checkpoints, and whether it goes on from one.
struct CheckpointRule {
  double wall_clock = 0.0;  ///< between two of them [s]; 0: there are none
  double time = 0.0;        ///< of the run [s], or load factor, between two of them; 0: not by that
  bool resumes = false;     ///< from the last one that a run of the same scene by the same program has left
};

class RunDirectory final : public records::Recorder {
 public:
  /// Nothing is touched before `open` or `begin`: a run that does not start leaves no directory.
  /// replaces: whether results of another owner may be replaced (manifest.hpp).
  /// formats: that are written besides those of every run (scene::Output::formats).
  RunDirectory(std::filesystem::path directory, std::string version, RunOrigin origin = {}, bool replaces = false,
               CheckpointRule rule = {}, std::vector<std::string> formats = {});
  ~RunDirectory() override;

  /// Takes the directory for this run, or refuses it if it has foreign entries (OutputFolder). `begin` calls it if it
  /// was not called before.
  void open();

  /// Whether the directory has the good results of this very run, whole, and nothing that it could go on from.
  bool has_all();

  void begin(const records::HistoryHeader& header) override;
  void row(const records::HistoryRow& row) override;
  void motion(const records::MotionFrame& frame) override;
  void parts(const records::MotionParts& parts) override { parts_ = parts; }
  bool keeps_states() const override { return true; }
  void state(const records::StoredState& state) override;

  /// Tells readers how far the run has come (unfinished_run.hpp), every two seconds at most.
  void note_progress(const records::Progress& progress);

  /// checkpoint.1 and checkpoint.2, written in turn: a line of text, then the positions in all files and the state of
  /// the run. The files are on the disk before a checkpoint is, and it gets its name when it is. Of the two the later
  /// one is used whose files are as they were.
  bool keeps_checkpoints() const override { return rule_.wall_clock > 0.0; }
  bool is_checkpoint_due(double time, bool is_last) override;
  void checkpoint(std::string_view state) override;
  std::string resume(const records::HistoryHeader& header) override;
  /// What is to be told about checkpoints: which one the run goes on from, and why others cannot be used.
  [[nodiscard]] const std::vector<std::string>& told() const { return told_; }
  /// Whether the results that `end` has published can be gone on with.
  [[nodiscard]] bool can_go_on() const { return can_go_on_; }
  [[nodiscard]] double time() const { return time_; }  ///< of the last step

  /// Commits history, motion and summary. After a failed write, everything written safely before is kept, without a
  /// summary. Throws the first failure.
  void end(const records::Summary& summary) override;

  [[nodiscard]] bool has_begun() const { return !writers_.empty(); }
  [[nodiscard]] bool has_ended() const { return has_ended_; }  ///< `end` was called, whether it went well or not

  /// For a run that was interrupted by `cause` before `end` (a recorder that could not write, say): ends it as failed
  /// with the data so far. Has no effect if it did not begin or has ended. Throws as `end`.
  void end_as_failed(records::Summary summary, const std::string& cause);

  /// Place of the results; after a failed run perhaps beside former good results.
  [[nodiscard]] const std::filesystem::path& directory() const { return folder_ ? folder_->folder() : directory_; }
  /// Why they were put beside; empty if they were not.
  [[nodiscard]] std::string why_beside() const {
    return folder_ && folder_->stands_beside() ? folder_->why_beside() : std::string();
  }
  /// Names of the complete files, relative to the directory, for the message at the end.
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

  /// Commits the rows that a killed run had passed to the system: a history without a summary, marked as failed.
  /// Returns its place; none if there are no rows, or if the run is still going on. Throws as OutputFolder. keep_rows:
  /// for rows in memory, preceded by the head of the history. owner: of the results.
  static std::optional<std::filesystem::path> keep_rows_of_killed(const std::filesystem::path& directory,
                                                                  const Owner& owner);
  static std::filesystem::path keep_rows(const std::filesystem::path& directory, const Owner& owner,
                                         std::string_view rows);

 private:
  /// A checkpoint as it was read, its head taken off.
  struct Checkpoint {
    std::filesystem::path place;  ///< folder
    long number = 0;
    double time = 0.0;
    std::string name, state, files;
  };
  void find_checkpoints();
  /// The good ones of a folder, the later one last.
  std::vector<Checkpoint> checkpoints_in(const std::filesystem::path& place);
  std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);
  void make_writers();
  std::string identity() const;
  void settle_checkpoints(records::RunStatus status);
  /// Gives the files their names; returns the first failure.
  std::exception_ptr commit_files(const records::Summary& summary);

  std::filesystem::path directory_;
  std::string version_;
  RunOrigin origin_;
  bool replaces_;
  std::unique_ptr<OutputFolder> folder_;
  std::vector<std::string> wanted_;  ///< formats
  std::vector<std::unique_ptr<ResultWriter>> writers_;
  records::MotionParts parts_;
  bool has_ended_ = false, was_cut_off_ = false, can_go_on_ = false;
  CheckpointRule rule_;
  std::vector<Checkpoint> found_;  ///< to go on from: the last one, and where its files are not as they were, the other
  std::chrono::steady_clock::time_point kept_at_ = std::chrono::steady_clock::now();
  double kept_time_ = 0.0, time_ = 0.0;  ///< times of the last checkpoint and of the last step
  long num_checkpoints_ = 0;
  const std::chrono::steady_clock::time_point begun_at_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point told_at_ = begun_at_;
  std::vector<std::string> told_;
  std::vector<FileRecord> records_;
  std::vector<std::string> files_;
};

}  // namespace bough::io
