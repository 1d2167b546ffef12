#pragma once
/// `states.bin`: states of a run from which other scenes can start. A line "bough states 1", then for each state a line
///   time, bytes that follow, their hash
/// and these bytes, a records::StoredState as an Archive: numbers as they stand in memory, little-endian; strings and
/// lists after their length, uint64. The checkpoints of a run that has not ended well hold one such state each.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/records/stored_state.hpp"

namespace bough::io {

/// Begins the file with the first state.
class StateWriter {
 public:
  explicit StateWriter(std::filesystem::path path) : path_(std::move(path)) {}
  void state(const records::StoredState& state);
  /// Reading goes on with the file from the place that the archive holds, if it had begun.
  void checkpoint(records::Archive& archive);
  [[nodiscard]] bool has_begun() const { return file_ != nullptr; }
  void commit(Durability durability = Durability::now) { file_->commit(durability); }
  [[nodiscard]] FileRecord record() const {
    return {path_.filename().string(), file_->bytes_flushed(), file_->digest()};
  }
  [[nodiscard]] bool can_commit() const { return file_->is_open(); }

 private:
  std::filesystem::path path_;
  std::unique_ptr<AtomicFile> file_;
};

/// A state as it is found in a folder.
struct FoundState {
  records::StoredState state;
  std::string hash;            ///< of its bytes
  std::filesystem::path file;  ///< states.bin, or a checkpoint
};

/// Thrown where a folder has no such state. what(): what is wrong, with the nearest times that there are.
class NoSuchState : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The state of one time in the folder of a run, whether that has ended, goes on or was killed. Times are the same that
/// differ by less than 1e-9 of the last one. none: the last one there is. States and checkpoints that were cut off or
/// altered are left out; skipped gets a sentence for each.
FoundState find_state(const std::filesystem::path& directory, std::optional<double> time,
                      std::vector<std::string>& skipped);

}  // namespace bough::io
