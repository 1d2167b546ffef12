#include "bough/io/matrix_market.hpp"

#include "bough/io/number_text.hpp"

namespace bough::io {

namespace {

std::string head(const char* format, const std::vector<std::string>& comments) {
  std::string text = std::string("%%MatrixMarket matrix ") + format + "\n";
  for (const std::string& comment : comments) {
    text += "% ";
    for (char c : comment) text += c == '\n' || c == '\r' ? ' ' : c;
    text += '\n';
  }
  return text;
}

void append_count(std::string& text, std::size_t count) { append_number(text, static_cast<long long>(count)); }

void append_sizes(std::string& text, std::size_t rows, std::size_t columns, std::size_t entries) {
  append_count(text, rows);
  text += ' ';
  append_count(text, columns);
  text += ' ';
  append_count(text, entries);
  text += '\n';
}

/// Row and column from 0.
void append_entry(std::string& text, std::size_t row, std::size_t column, double value) {
  append_count(text, row + 1);
  text += ' ';
  append_count(text, column + 1);
  text += ' ';
  append_number(text, value);
  text += '\n';
}

}  // namespace

std::string matrix_market_text(const SparseMatrix& matrix, const std::vector<std::string>& comments) {
  std::string text = head(matrix.is_symmetric ? "coordinate real symmetric" : "coordinate real general", comments);
  const auto size = static_cast<std::size_t>(matrix.size);
  append_sizes(text, size, size, matrix.row.size());
  for (std::size_t j = 0; j < size; ++j)
    for (std::size_t k = matrix.column_begin[j]; k < matrix.column_begin[j + 1]; ++k)
      append_entry(text, static_cast<std::size_t>(matrix.row[k]), j, matrix.value[k]);
  return text;
}

std::string matrix_market_text(const records::SparseEntries& matrix, const std::vector<std::string>& comments) {
  std::string text = head("coordinate real general", comments);
  append_sizes(text, static_cast<std::size_t>(matrix.rows), static_cast<std::size_t>(matrix.columns),
               matrix.value.size());
  for (std::size_t k = 0; k < matrix.value.size(); ++k)
    append_entry(text, static_cast<std::size_t>(matrix.row[k]), static_cast<std::size_t>(matrix.column[k]),
                 matrix.value[k]);
  return text;
}

std::string matrix_market_text(const std::vector<double>& values, const std::vector<std::string>& comments,
                               std::size_t num_columns) {
  std::string text = head("array real general", comments);
  append_count(text, num_columns == 0 ? 0 : values.size() / num_columns);
  text += ' ';
  append_count(text, num_columns);
  text += '\n';
  for (const double value : values) {
    append_number(text, value);
    text += '\n';
  }
  return text;
}

}  // namespace bough::io
