#pragma once
/// Results of many runs in one file: a folder of files takes longer than a small run, and a file system suffers from a
/// hundred thousand of them.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bough/io/manifest.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/io/shared_text.hpp"
#include "bough/io/summary.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

/// A file of a run, as RunDirectory writes it.
struct StoredFile {
  std::string name, text;
};

/// Position of a stored run: name of the store, relative to the folder of the batch, and offset of its record.
struct StoredPlace {
  std::string store;
  std::uint64_t offset = 0;
};

/// A store is written by one process and may be read by any. A record is a line of JSON with the key of a case and
/// names, sizes and hashes of files, followed by their bytes. An incomplete record, cut off by a kill, is recognised, and
/// no position refers to it.
class RunStore {
 public:
  /// The first store of the folder, store_000.pack, store_001.pack and so on, that no other process holds; it is held
  /// until this process ends. Records are appended. Throws std::runtime_error where none can be opened.
  explicit RunStore(const std::filesystem::path& folder);
  ~RunStore();
  RunStore(const RunStore&) = delete;
  RunStore& operator=(const RunStore&) = delete;

  /// Returns when the system has the record; the disk gets it later. Throws std::runtime_error if it cannot be written;
  /// the store is then unchanged.
  StoredPlace add(const std::vector<StoredFile>& files, const std::string& key);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

inline constexpr const char* store_names = "store_*";  ///< as a manifest lists them

/// The files of a record; none if it is incomplete, or of another case than that of the key.
std::optional<std::vector<StoredFile>> read_stored(const std::filesystem::path& folder, const StoredPlace& place,
                                                   const std::string& key);
/// Waits until all stores of a folder are on disk.
void sync_stores(const std::filesystem::path& folder);

/// Writes stored files as the folder of a run, as if it had been run there. Throws as OutputFolder. Returns their
/// place: beside `folder` if that has good results and these are of a failed run.
std::filesystem::path unpack_run(const std::vector<StoredFile>& files, FolderState state,
                                 const std::filesystem::path& folder, const Owner& owner);

/// Records a run in memory, to be stored: history.csv, columns.json, motion.bin and summary.json with the bytes of
/// RunDirectory, except that no VTU files are made or mentioned in the summary. twin: if given, receives the history
/// row by row, so that it is not lost with the process.
class RunInMemory final : public records::Recorder {
 public:
  RunInMemory(std::string version, RunOrigin origin, SharedText* twin = nullptr)
      : version_(std::move(version)), origin_(std::move(origin)), twin_(twin) {}
  void begin(const records::HistoryHeader& header) override;
  void row(const records::HistoryRow& row) override;
  void motion(const records::MotionFrame& frame) override;
  void parts(const records::MotionParts& parts) override { motion_bytes_ = MotionBytes(parts); }
  void end(const records::Summary& summary) override;
  /// For a run that was cut off by `cause` before `end`; as RunDirectory::end_as_failed.
  void end_as_failed(records::Summary summary, const std::string& cause);
  [[nodiscard]] const std::vector<StoredFile>& files() const { return files_; }

 private:
  void keep_twin(std::size_t begin);

  std::string version_;
  RunOrigin origin_;
  SharedText* twin_;
  std::string history_, columns_, motion_;
  MotionBytes motion_bytes_;
  std::vector<StoredFile> files_;
};

}  // namespace bough::io
