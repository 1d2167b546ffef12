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

/// Where a run stands: name of the store, below the folder of the batch, and the place of its record.
struct StoredPlace {
  std::string store;
  std::uint64_t offset = 0;
};

/// One process writes a store, any may read it. A record is a line of JSON with names, sizes and hashes of files, and
/// then their bytes: what a kill cuts off is told from what is whole, and nobody is led there.
class RunStore {
 public:
  /// The first store of the folder, store_000.pack, store_001.pack and so on, that no other process holds; it is held
  /// until this process ends. Records are appended. Throws std::runtime_error where none can be opened.
  explicit RunStore(const std::filesystem::path& folder);
  ~RunStore();
  RunStore(const RunStore&) = delete;
  RunStore& operator=(const RunStore&) = delete;

  /// The system has the record when this returns; the disk takes it in its own time. Throws std::runtime_error where
  /// it cannot be written; the store is then as before.
  StoredPlace add(const std::vector<StoredFile>& files);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

inline constexpr const char* store_names = "store_*";  ///< as a manifest lists them

/// The files of a record; nothing where there is no whole one.
std::optional<std::vector<StoredFile>> read_stored(const std::filesystem::path& folder, const StoredPlace& place);
/// Waits until the disk has all stores of a folder. remove_stores: takes them away.
void sync_stores(const std::filesystem::path& folder);
void remove_stores(const std::filesystem::path& folder);

/// Writes stored files as the folder of a run, as if it had been run there. Throws as OutputFolder. Returns where they
/// stand: beside where `folder` holds good results and these are of a run that failed.
std::filesystem::path unpack_run(const std::vector<StoredFile>& files, FolderState state,
                                 const std::filesystem::path& folder);

/// A run that is recorded in memory, to be stored: history.csv, columns.json, motion.bin and summary.json of
/// RunDirectory, to the byte but for what the summary says of VTU files, which are not made. twin: where given, takes
/// the history row by row, so that it is not lost with the process.
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
