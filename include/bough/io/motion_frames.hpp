#pragma once
/// `motion.jsonl`: the moving structure in a compact text form, for pictures. JSON Lines: the first line is a header
///   {"format":"bough motion 1","curves":[names],"bodies":[names],"links":[names]}
/// and each further line one frame
///   {"t":time,"c":[[x,y,z, x,y,z, ...] per curve],
///    "b":[[x,y,z, R row-major, center x,y,z, attachments x,y,z ...] per body],"l":[[x,y,z, x,y,z] per link]}
/// with nine significant digits: enough for any picture; full precision stands in history.csv and in the VTU files.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/results/records.hpp"

namespace bough::io {

/// The lines of such a file.
class MotionLines {
 public:
  /// All frames must have the parts of the first one, before whose line the header stands.
  void append(std::string& text, const results::MotionFrame& frame);

 private:
  bool has_header_ = false;
};

class MotionLinesWriter {
 public:
  explicit MotionLinesWriter(const std::filesystem::path& path) : file_(path) {}
  /// All frames must have the parts of the first one. std::runtime_error where it cannot be written.
  void frame(const results::MotionFrame& frame);
  void commit(Durability durability = Durability::now) { file_.commit(durability); }
  /// Of what stands in the file.
  [[nodiscard]] FileRecord record() const {
    return {file_.path().filename().string(), file_.bytes_flushed(), file_.digest()};
  }
  [[nodiscard]] bool can_commit() const { return file_.is_open(); }

 private:
  AtomicFile file_;
  std::string line_;
  MotionLines lines_;
};

/// Reads at most `max_frames` frames (>= 2), evenly chosen, always the first and the last. Section forces and axes of curves are not in this
/// file and come back zero. Throws std::runtime_error naming file, line and what is wrong.
std::vector<results::MotionFrame> read_motion_lines(const std::filesystem::path& path, std::size_t max_frames);

}  // namespace bough::io
