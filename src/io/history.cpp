#include "bough/io/history.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"

namespace bough::io {
namespace {

const char* const fixed_columns[] = {"time", "step_size", "iterations"};
constexpr std::chrono::milliseconds flush_interval{500};

[[noreturn]] void fail_at(const std::filesystem::path& path, std::size_t line, const std::string& what) {
  throw std::runtime_error(path.string() + ":" + std::to_string(line) + ": " + what);
}

records::HistoryHeader read_header(const std::filesystem::path& path, std::string_view line) {
  std::vector<std::string> fields;
  bool good = split_csv_line(line, fields) && fields.size() >= 3;
  for (std::size_t k = 0; good && k < 3; ++k) good = fields[k] == fixed_columns[k];
  if (!good) fail_at(path, 1, "not a history: the header must begin with time,step_size,iterations");
  std::vector<std::string> columns;
  std::transform(fields.begin() + 3, fields.end(), std::back_inserter(columns), csv_text);
  return {std::move(columns)};
}

records::HistoryRow read_row(const std::filesystem::path& path, std::size_t number, std::string_view line,
                             std::size_t num_columns) {
  records::HistoryRow row;
  row.values.reserve(num_columns);
  std::size_t field = 0;
  while (true) {
    const std::size_t comma = line.find(',');
    double value = 0.0;
    if (!read_number(line.substr(0, comma), value)) {
      fail_at(path, number,
              "field " + std::to_string(field + 1) + " is not a number: '" + std::string(line.substr(0, comma)) + "'");
    }
    if (field == 0) row.time = value;
    if (field == 1) row.step_size = value;
    if (field == 2) {
      if (!(value >= 0.0 && value < 2e9)) fail_at(path, number, "iterations must be a count");
      row.iterations = static_cast<int>(value);
    }
    if (field > 2) row.values.push_back(value);
    ++field;
    if (comma == std::string_view::npos) break;
    line.remove_prefix(comma + 1);
  }
  if (field != num_columns + 3) {
    fail_at(path, number, std::to_string(field) + " fields where the header has " + std::to_string(num_columns + 3));
  }
  return row;
}

}  // namespace

namespace {

/// Whether a spreadsheet would take a text for a formula, once it has lost the apostrophes before it.
bool is_like_formula(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of('\''), text.size()));
  return !text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos;
}

std::string quoted_field(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;  // one record, one line
  }
  return quoted + '"';
}

}  // namespace

std::string csv_field(std::string_view text) {
  double number = 0.0;
  const std::string field = (is_like_formula(text) && !read_number(text, number) ? "'" : "") + std::string(text);
  return field.find_first_of(",\"\n\r") == std::string::npos ? field : quoted_field(field);
}

std::string csv_text(std::string field) {
  if (field.starts_with('\'') && is_like_formula(field)) field.erase(0, 1);
  return field;
}

bool split_csv_line(std::string_view line, std::vector<std::string>& fields) {
  fields.assign(1, "");
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quoted && c == '"' && k + 1 < line.size() && line[k + 1] == '"') {
      fields.back() += '"';
      ++k;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return !quoted;
}

std::string history_head(const records::HistoryHeader& header) {
  std::string line = "time,step_size,iterations";
  for (const std::string& column : header.columns) line += ',' + csv_field(column);
  return line + '\n';
}

void append_history_row(std::string& text, const records::HistoryRow& row) {
  append_number(text, row.time);
  text += ',';
  append_number(text, row.step_size);
  text += ',';
  append_number(text, static_cast<long long>(row.iterations));
  for (const double value : row.values) {
    text += ',';
    append_number(text, value);
  }
  text += '\n';
}

HistoryWriter::HistoryWriter(const std::filesystem::path& path, const records::HistoryHeader& header)
    : file_(std::make_unique<AtomicFile>(path)),
      num_columns_(header.columns.size()),
      flushed_at_(std::chrono::steady_clock::now()) {
  file_->write(history_head(header));
  file_->flush();
}

HistoryWriter::HistoryWriter(const std::filesystem::path& path, const records::HistoryHeader& header,
                             records::Archive& archive)
    : file_(AtomicFile::reopen(path)),
      num_columns_(header.columns.size()),
      flushed_at_(std::chrono::steady_clock::now()) {
  checkpoint(archive);
}

void HistoryWriter::row(const records::HistoryRow& row) {
  if (row.values.size() != num_columns_) throw std::logic_error("HistoryWriter: a row must have one value per column");
  line_.clear();
  append_history_row(line_, row);
  file_->write(line_);
  ++rows_;
  const auto now = std::chrono::steady_clock::now();
  if (now - flushed_at_ < flush_interval) return;
  file_->flush();
  flushed_at_ = now;
}

History read_history(const std::filesystem::path& path, bool goes_on) {
  InputFile file(path);
  History history;
  std::string line;
  std::size_t number = 0;
  while (file.next_line(line)) {
    ++number;
    if (goes_on && !file.ends_with_line_end()) break;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 1) {
      history.header = read_header(path, line);
    } else {
      history.rows.push_back(read_row(path, number, line, history.header.columns.size()));
    }
  }
  if (number == 0) fail_at(path, 1, "empty file");
  return history;
}

}  // namespace bough::io
