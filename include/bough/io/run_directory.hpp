#pragma once
/// The directory of one run: the recorder that writes it.
///   summary.json   removed first, written last
///   history.csv    the sensors
///   motion.pvd, motion/frame_000000.vtu ..., motion.jsonl   where motion is recorded
///                  (a build without BOUGH_WITH_VTK writes motion.jsonl only)
/// Every file appears under its name only when it is whole.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bough/io/history.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/io/write_vtu.hpp"
#include "bough/results/records.hpp"

namespace bough::io {

class RunDirectory final : public results::Recorder {
 public:
  /// Nothing is touched until `begin`: a run that does not start leaves no directory.
  RunDirectory(std::filesystem::path directory, std::string version);

  void begin(const results::HistoryHeader& header) override;
  void row(const results::HistoryRow& row) override;
  void motion(const results::MotionFrame& frame) override;

  /// Gives history, motion and then the summary their names. After a failed write what was safely written before is kept. Where even that
  /// cannot be done, throws the first failure.
  void end(const results::Summary& summary) override;

  [[nodiscard]] bool has_begun() const { return history_ != nullptr; }
  [[nodiscard]] bool has_ended() const { return has_ended_; }  ///< `end` was called, whether it went well or not

  /// For a run that was cut off by `cause` (a recorder that could not write, say) before `end`: ends it as failed with what is there.
  /// Does nothing where it did not begin or did end. Throws as `end`.
  void end_as_failed(results::Summary summary, const std::string& cause);

  [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }
  /// Names of the files that are whole, relative to the directory, for the message at the end.
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }

 private:
  void remove_former_results();

  std::filesystem::path directory_;
  std::string version_;
  std::unique_ptr<HistoryWriter> history_;
  std::unique_ptr<MotionLinesWriter> motion_lines_;
  bool has_ended_ = false;
  VtuOptions vtu_options_;
  std::vector<PvdEntry> frames_;
  std::vector<std::string> files_;
};

}  // namespace bough::io
