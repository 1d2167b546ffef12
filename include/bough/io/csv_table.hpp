#pragma once
/// Tables of text with commas.
#include <string>
#include <string_view>
#include <vector>

namespace bough::io {

/// A table with one header line, as in RFC 4180: commas, quotes doubled within quotes, any line ends.
struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each with as many cells as there are columns

  /// Returns what is wrong with the text, or an empty string. Empty lines are ignored.
  std::string read(std::string_view text);
};

}  // namespace bough::io
