#pragma once
/// Tables of results, which an analysis leaves beside the history: every format writes any of them.
#include <string>
#include <variant>
#include <vector>

namespace bough::records {

struct Table {
  struct Column {
    std::string name;
    std::string unit = {};  ///< empty: a pure number, or a text
    bool is_brief = false;  ///< shown where there is little room
  };
  using Cell = std::variant<double, std::string>;
  std::string name;   ///< of its file, and its key in the summary
  std::string about;  ///< what it shows and how it was found, in a sentence or more
  std::vector<Column> columns = {};
  std::vector<std::vector<Cell>> rows = {};  ///< each as long as there are columns
};

}  // namespace bough::records
