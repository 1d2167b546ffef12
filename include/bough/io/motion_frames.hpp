#pragma once
/// `motion.bin`: the moving structure, for pictures. A header, one line of JSON that spaces fill to a multiple of 8
/// bytes:
///   {"format":"bough motion 4","frame_floats":n,"curves":[{"name","points","outline","subdomains"}],
///    "bodies":[{"name","attachments","mesh"}],"links":[{"name","kind"}],"frames":[name],"arrows":[{"name","kind"}],
///    "signals":[name],"signal_units":[unit] (if there are any; a unit is empty where it is not known),
///    "outlines":[[[x2,x3,x2,x3,...] per loop]],"meshes":[{"points":[x,y,z,...],"triangles":[a,b,c,...]}]}
/// then binary numbers, little-endian, without gaps. First the start, float64:
///   curve point: position 3, axes 9 (row-major, columns are axes) | body: centre 3, axes 9, position 3, attachments
///     3 each
///   link: first 3, second 3, axes 9 | frame: position 3, axes 9 | arrow: position 3
/// then the frames, each:  time, float64 | turn since the frame before (records::MotionFrame), float64 | number m of
/// packed bytes, uint64 | m bytes: n float32 compressed by zlib, the lowest bytes of all first, then the next ones up to
/// the highest:
///   curve point: displacement 3, rotation 3, velocity 3, force 6, strain 6 | body: displacement 3, rotation 3,
///     velocity 3
///   link: displacement of first 3, of second 3, rotation 3, velocity of first 3, of second 3
///   frame: displacement 3, rotation 3, velocity 3
///   arrow: displacement 3, velocity 3, force 3, moment 3 (of kind "line load" per length) | signal: value
/// Displacements are those from the start, so that small ones keep their digits far from the origin; a rotation r turns
/// the axes of the start in space,  axes = exp(~r) axes_start.  Frames that are not whole (a crash) do not count.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

/// The bytes of such a file.
class MotionBytes {
 public:
  explicit MotionBytes(records::MotionParts parts = {}) : parts_(std::move(parts)) {}
  /// All frames must have the parts of the first one. Header and start are written before the first frame.
  void append(std::string& bytes, const records::MotionFrame& frame);
  void checkpoint(records::Archive& archive) { archive(start_); }

 private:
  records::MotionParts parts_;
  std::optional<records::MotionFrame> start_;
};

class MotionWriter {
 public:
  explicit MotionWriter(const std::filesystem::path& path, records::MotionParts parts = {})
      : file_(std::make_unique<AtomicFile>(path)), bytes_(std::move(parts)) {}
  /// Goes on with a motion, from the place that the archive holds.
  MotionWriter(const std::filesystem::path& path, records::Archive& archive) : file_(AtomicFile::reopen(path)) {
    checkpoint(archive);
  }
  void checkpoint(records::Archive& archive) { archive(*file_, bytes_); }
  /// As MotionBytes::append. Throws std::runtime_error if the file cannot be written.
  void frame(const records::MotionFrame& frame);
  void commit(Durability durability = Durability::now) { file_->commit(durability); }
  /// Record of the bytes in the file.
  [[nodiscard]] FileRecord record() const {
    return {file_->path().filename().string(), file_->bytes_flushed(), file_->digest()};
  }
  [[nodiscard]] bool can_commit() const { return file_->is_open(); }

 private:
  std::unique_ptr<AtomicFile> file_;
  MotionBytes bytes_;
};

struct Motion {
  records::MotionParts parts;
  std::vector<records::MotionFrame> frames;
  std::size_t num_recorded = 0;  ///< frames in the file; those here are chosen from them
};

/// Reads at most `max_frames` frames (>= 2), and more where parts turn by more than .45 rad from one to the next and
/// memory allows it; evenly chosen, always the first and the last. Throws std::runtime_error naming the file and what is
/// wrong.
Motion read_motion_file(const std::filesystem::path& path, std::size_t max_frames);

}  // namespace bough::io
