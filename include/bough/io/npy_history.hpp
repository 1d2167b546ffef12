#pragma once
/// `history.npy` has the numbers of a long history as an array of NumPy, format 1.0: float64, row after row, columns as
/// in columns.json (time, step_size, iterations, sensors). It accompanies history.csv and has the same bits. While it
/// is written, its head states no rows; their number follows from its size, also after a crash.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

/// Head of such a file, a multiple of 64 bytes, the same length for any number of rows.
std::string npy_head(std::size_t rows, std::size_t columns);

/// A whole file of a square matrix, which is given column by column.
std::string npy_square(const std::vector<double>& by_columns);

/// Repairs the bytes of a file left by a crash: complete rows only, with their number in the head; empty if there are
/// none.
std::string repaired_npy(std::string bytes, std::size_t columns);

/// Begins the file when there are more than `long_history` rows, and keeps the rows in memory until then.
class NpyHistoryWriter {
 public:
  static constexpr std::size_t long_history = 10'000;

  NpyHistoryWriter(std::filesystem::path path, const records::HistoryHeader& header)
      : path_(std::move(path)), num_columns_(3 + header.columns.size()) {}
  void row(const records::HistoryRow& row);
  /// Reading goes on with the file from the place that the archive holds, if it had begun.
  void checkpoint(records::Archive& archive);
  [[nodiscard]] bool has_begun() const { return file_ != nullptr; }
  /// Writes the number of rows into the head, and commits.
  void commit(Durability durability = Durability::now);
  /// Record of the file's present content.
  [[nodiscard]] FileRecord record() const {
    return {path_.filename().string(), file_->bytes_flushed(), file_->digest()};
  }
  [[nodiscard]] bool can_commit() const { return file_->is_open(); }

 private:
  std::filesystem::path path_;
  std::size_t num_columns_, rows_ = 0;
  std::string kept_;  ///< rows of a history that is not yet long
  std::unique_ptr<AtomicFile> file_;
};

}  // namespace bough::io
