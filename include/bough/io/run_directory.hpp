#pragma once
/// The directory of one run: the recorder that writes it.
///   history.csv    the sensors
///   history.npy    the same of more than 10 000 rows, for NumPy
///   columns.json   unit, quantity and part of each of its columns
///   motion.pvd, motion/frame_000000.vtu ..., motion.bin   where motion is recorded
///                  (a build without BOUGH_WITH_VTK writes motion.bin only)
///   summary.json   how the run ended, what it was made from, the hash of every file
///   manifest.json  what in the directory is bough's (manifest.hpp)
/// All of them appear under the directory's name together, at the end (output_folder.hpp).
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bough/io/history.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/io/npy_history.hpp"
#include "bough/io/output_folder.hpp"
#include "bough/io/summary.hpp"
#include "bough/io/write_vtu.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

class RunDirectory final : public records::Recorder {
 public:
  /// Nothing is touched until `open` or `begin`: a run that does not start leaves no directory.
  RunDirectory(std::filesystem::path directory, std::string version, RunOrigin origin = {});

  /// Takes the directory for this run, and refuses what is not bough's (OutputFolder). `begin` does so where nobody
  /// did before.
  void open();

  void begin(const records::HistoryHeader& header) override;
  void row(const records::HistoryRow& row) override;
  void motion(const records::MotionFrame& frame) override;
  void parts(const records::MotionParts& parts) override { parts_ = parts; }

  /// Gives history, motion and summary their place. After a failed write what was safely written before is kept,
  /// without a summary. Throws the first failure.
  void end(const records::Summary& summary) override;

  [[nodiscard]] bool has_begun() const { return history_ != nullptr; }
  [[nodiscard]] bool has_ended() const { return has_ended_; }  ///< `end` was called, whether it went well or not

  /// For a run that was cut off by `cause` (a recorder that could not write, say) before `end`: ends it as failed
  /// with what is there. Does nothing where it did not begin or did end. Throws as `end`.
  void end_as_failed(records::Summary summary, const std::string& cause);

  /// Where the results stand; after the end of a run that failed perhaps beside former results that were good.
  [[nodiscard]] const std::filesystem::path& directory() const { return folder_ ? folder_->folder() : directory_; }
  /// In words, why they stand beside; empty where they do not.
  [[nodiscard]] std::string why_beside() const {
    return folder_ && folder_->stands_beside() ? folder_->why_beside() : std::string();
  }
  /// Names of the files that are whole, relative to the directory, for the message at the end.
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

  /// Gives the rows that a run which was killed had handed to the system their place: a history without a summary,
  /// marked as failed. Returns where it stands; nothing where there are no rows, or the run still goes on. Throws as
  /// OutputFolder. keep_rows: the same for rows that stand in memory, the head of the history before them.
  static std::optional<std::filesystem::path> keep_rows_of_killed(const std::filesystem::path& directory);
  static std::filesystem::path keep_rows(const std::filesystem::path& directory, std::string_view rows);

 private:
  /// Gives the files their names; returns the first failure.
  std::exception_ptr commit_files();
  void list(FileRecord record);

  std::filesystem::path directory_;
  std::string version_;
  RunOrigin origin_;
  std::unique_ptr<OutputFolder> folder_;
  std::unique_ptr<HistoryWriter> history_;
  std::unique_ptr<NpyHistoryWriter> twin_;
  std::unique_ptr<MotionWriter> motion_;
  records::MotionParts parts_;
  std::string columns_;  ///< of columns.json
  bool has_ended_ = false;
  std::vector<PvdEntry> frames_;
  std::vector<FileRecord> frame_records_, records_;
  std::vector<std::string> files_;
};

}  // namespace bough::io
