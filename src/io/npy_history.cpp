#include "bough/io/npy_history.hpp"

#include <bit>
#include <cmath>
#include <stdexcept>

namespace bough::io {
namespace {

static_assert(std::endian::native == std::endian::little, "history.npy holds numbers as they stand in memory");

void put(std::string& bytes, double value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }

}  // namespace

std::string npy_head(std::size_t rows, std::size_t columns) {
  std::string number = std::to_string(rows);
  number.insert(0, 20 - number.size(), ' ');  // the field has the same length for any number of rows
  std::string words =
      "{'descr': '<f8', 'fortran_order': False, 'shape': (" + number + ", " + std::to_string(columns) + "), }";
  constexpr std::size_t before = 10;  // magic string, version, length
  while ((before + words.size() + 1) % 64 != 0) words += ' ';
  words += '\n';
  std::string head("\x93NUMPY\x01\x00", 8);
  head += static_cast<char>(words.size() & 255u);
  head += static_cast<char>(words.size() >> 8u);
  return head + words;
}

std::string npy_square(const std::vector<double>& by_columns) {
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(by_columns.size()))));
  std::string bytes = npy_head(n, n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) put(bytes, by_columns[j * n + i]);
  return bytes;
}

std::string repaired_npy(std::string bytes, std::size_t columns) {
  const std::size_t head = npy_head(0, columns).size(), row = columns * sizeof(double);
  if (bytes.size() < head + row) return {};
  const std::size_t rows = (bytes.size() - head) / row;
  bytes.resize(head + rows * row);
  return bytes.replace(0, head, npy_head(rows, columns));
}

void NpyHistoryWriter::row(const records::HistoryRow& row) {
  if (row.values.size() + 3 != num_columns_)
    throw std::logic_error("NpyHistoryWriter: a row must have one value per column");
  put(kept_, row.time);
  put(kept_, row.step_size);
  put(kept_, static_cast<double>(row.iterations));
  for (const double value : row.values) put(kept_, value);
  if (++rows_ <= long_history) return;
  if (!file_) {
    file_ = std::make_unique<AtomicFile>(path_);
    file_->write(npy_head(0, num_columns_));
    kept_.shrink_to_fit();
  }
  file_->write(kept_);
  kept_.clear();
}

void NpyHistoryWriter::checkpoint(records::Archive& archive) {
  bool is_begun = has_begun();
  archive(rows_, kept_, is_begun);
  if (!is_begun) return;
  if (archive.is_reading()) {
    file_ = AtomicFile::reopen(path_);
    file_->replace_front(npy_head(0, num_columns_));  // a run that was stopped has put the number of its rows there
  }
  file_->checkpoint(archive);
}

void NpyHistoryWriter::commit(Durability durability) {
  file_->flush();
  // After a failed write the file ends at some flush, which need not be the end of a row.
  const std::size_t head = npy_head(0, num_columns_).size(), written = file_->bytes_flushed();
  const std::size_t rows = written > head ? (written - head) / (num_columns_ * sizeof(double)) : 0;
  if (written >= head) file_->replace_front(npy_head(rows, num_columns_));
  file_->commit(durability);
}

}  // namespace bough::io
