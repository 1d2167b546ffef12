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

}  // namespace

std::string matrix_market_text(const SparseMatrix& matrix, const std::vector<std::string>& comments) {
  std::string text = head(matrix.is_symmetric ? "coordinate real symmetric" : "coordinate real general", comments);
  const auto size = static_cast<std::size_t>(matrix.size);
  append_count(text, size);
  text += ' ';
  append_count(text, size);
  text += ' ';
  append_count(text, matrix.row.size());
  text += '\n';
  for (std::size_t j = 0; j < size; ++j)
    for (std::size_t k = matrix.column_begin[j]; k < matrix.column_begin[j + 1]; ++k) {
      append_count(text, static_cast<std::size_t>(matrix.row[k]) + 1);
      text += ' ';
      append_count(text, j + 1);
      text += ' ';
      append_number(text, matrix.value[k]);
      text += '\n';
    }
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
