#include "bough/io/csv_table.hpp"

#include "bough/io/history.hpp"

namespace bough::io {

std::string CsvTable::read(std::string_view text) {
  std::vector<std::string> row;
  std::string cell;
  bool is_quoted = false, has_cells = false;
  std::size_t line = 1;
  std::string rule;
  const auto end_row = [&] {
    if (!has_cells && cell.empty()) return;
    row.push_back(csv_text(std::move(cell)));
    cell.clear();
    has_cells = false;
    if (columns.empty())
      columns = std::move(row);
    else if (row.size() == columns.size())
      rows.push_back(std::move(row));
    else if (rule.empty())
      rule = "line " + std::to_string(line) + " has " + std::to_string(row.size()) + " cells, and there are " +
             std::to_string(columns.size()) + " columns";
    row.clear();
  };
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_quoted) {
      if (c == '"' && i + 1 < text.size() && text[i + 1] == '"')
        cell += text[++i];
      else if (c == '"')
        is_quoted = false;
      else
        cell += c;
      line += c == '\n' ? 1 : 0;
    } else if (c == '"' && cell.empty()) {
      is_quoted = true;
      has_cells = true;
    } else if (c == ',') {
      row.push_back(csv_text(std::move(cell)));
      cell.clear();
      has_cells = true;
    } else if (c == '\n' || c == '\r') {
      end_row();
      line += c == '\n' ? 1 : 0;
    } else {
      cell += c;
    }
  }
  if (is_quoted) return "a quote is not closed";
  end_row();
  if (columns.empty()) return "the table is empty";
  return rule;
}

}  // namespace bough::io
