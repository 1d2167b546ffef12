#pragma once
/// `history.csv`: header `time,step_size,iterations,<column>...`, the initial state, then rows as they are recorded.
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bough/io/atomic_file.hpp"
#include "bough/io/manifest.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

/// The first line of a history, and a row.
std::string history_head(const records::HistoryHeader& header);
void append_history_row(std::string& text, const records::HistoryRow& row);

/// Writes rows as they come. Rows that were passed to the system can be kept after a failure: a failed write loses only
/// the rows since the last flush (at most half a second or 64 KiB).
class HistoryWriter {
 public:
  HistoryWriter(const std::filesystem::path& path, const records::HistoryHeader& header);
  /// Goes on with a history, from the place that the archive holds.
  HistoryWriter(const std::filesystem::path& path, const records::HistoryHeader& header, records::Archive& archive);
  void checkpoint(records::Archive& archive) { archive(*file_, rows_); }
  void row(const records::HistoryRow& row);
  void commit(Durability durability = Durability::now) { file_->commit(durability); }
  /// Record of the file's present content.
  [[nodiscard]] FileRecord record() const {
    return {file_->path().filename().string(), file_->bytes_flushed(), file_->digest()};
  }
  [[nodiscard]] bool can_commit() const { return file_->is_open(); }
  [[nodiscard]] long rows() const { return rows_; }

 private:
  std::unique_ptr<AtomicFile> file_;
  std::size_t num_columns_;
  std::string line_;
  std::chrono::steady_clock::time_point flushed_at_;
  long rows_ = 0;
};

struct History {
  records::HistoryHeader header;
  std::vector<records::HistoryRow> rows;
};

/// Reads a history back, bit for bit. Throws std::runtime_error naming file, line and what is wrong.
/// goes_on: it may end within a row, which is left out.
History read_history(const std::filesystem::path& path, bool goes_on = false);

/// One field of a CSV line, quoted where it must be. Text that a spreadsheet would take for a formula gets an apostrophe
/// before it; numbers do not. csv_text: takes it away again.
std::string csv_field(std::string_view text);
std::string csv_text(std::string field);
/// The fields of one CSV line. False where a quote is not closed.
[[nodiscard]] bool split_csv_line(std::string_view line, std::vector<std::string>& fields);

}  // namespace bough::io
