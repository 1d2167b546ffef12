#pragma once
/// Formats of the results of a run: each is one file of this folder and one row of `result_formats`.
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/records/archive.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

/// Files of a run, as they are listed in its summary and its manifest.
using ListFile = std::function<void(FileRecord)>;

/// Writes the files of one format into a folder. All calls but `commit` come while the run goes on, in the order of
/// records::Recorder; a failed write is thrown.
class ResultWriter {
 public:
  explicit ResultWriter(std::filesystem::path folder) : folder_(std::move(folder)) {}
  virtual ~ResultWriter() = default;
  ResultWriter(const ResultWriter&) = delete;
  ResultWriter& operator=(const ResultWriter&) = delete;

  virtual void begin(const records::HistoryHeader&) {}
  virtual void row(const records::HistoryRow&) {}
  /// parts: those of all frames.
  virtual void motion(const records::MotionFrame&, const records::MotionParts&) {}
  virtual void state(const records::StoredState&) {}
  /// Positions in the files, which are on the disk when it returns. Where they are read, in place of `begin`, files are
  /// cut back to these and gone on with. Throws std::runtime_error where a file is not as it was.
  virtual void checkpoint(records::Archive&, const records::HistoryHeader&) {}
  /// Completes the files and lists them. A file that cannot be completed, but is whole up to some row, is listed before
  /// the failure is thrown. Returns the names to be told.
  virtual std::vector<std::string> commit(const records::Summary& summary, const ListFile& list) = 0;

 protected:
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Writes a whole file and lists it.
  std::string put(const std::string& name, std::string_view text, const ListFile& list) const;

 private:
  std::filesystem::path folder_;
};

/// Commits a writer of one file, and lists it; returns its name. After a failed write the rows since the last flush are
/// lost, those before it are complete.
template <class Writer>
std::string commit_one(Writer& writer, const ListFile& list) {
  try {
    writer.commit(Durability::soon);
  } catch (const std::exception&) {
    if (!writer.can_commit()) throw;
    writer.commit(Durability::soon);
    list(writer.record());
    throw;
  }
  list(writer.record());
  return writer.record().name;
}

struct ResultFormat {
  std::string name;                ///< in /output/formats of a scene; empty: it is always written
  std::vector<std::string> files;  ///< that it may write, as in a manifest
  std::unique_ptr<ResultWriter> (*make)(const std::filesystem::path& folder);
  std::string about;   ///< of one with a name, for readers
  bool draws = false;  ///< it needs pictures: a scene that asks for it has its motion recorded
};

/// In the order in which files are listed.
const std::vector<ResultFormat>& result_formats();

/// Makes a writer, for a row of the table.
template <class Writer>
std::unique_ptr<ResultWriter> make_writer(const std::filesystem::path& folder) {
  return std::make_unique<Writer>(folder);
}

}  // namespace bough::io
