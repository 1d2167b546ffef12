#pragma once
/// Tables of text with commas.
#include <string>
#include <string_view>
#include <vector>

namespace bough::io {

/// A table with one header line, as RFC 4180 has it: commas, quotes doubled within quotes, any line ends.
struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each with as many cells as there are columns

  /// Empty where the text could be read, else what is wrong with it. Empty lines are left out.
  std::string read(std::string_view text);
};

}  // namespace bough::io
