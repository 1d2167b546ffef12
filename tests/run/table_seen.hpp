#pragma once
/// Tables that a run leaves.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace bough::verify {

/// A table of a run by the names of its columns.
class TableSeen {
 public:
  TableSeen() = default;
  /// The first one; of a run that left none an empty one.
  explicit TableSeen(const support::Outcome& outcome) {
    if (!outcome.summary.tables.empty()) table_ = outcome.summary.tables.front();
  }
  TableSeen(const support::Outcome& outcome, const std::string& name) {
    for (const records::Table& table : outcome.summary.tables)
      if (table.name == name) table_ = table;
    EXPECT_EQ(table_.name, name) << outcome.summary.cause;
  }
  std::size_t count() const { return table_.rows.size(); }
  double number(std::size_t row, const std::string& column) const {
    return std::get<double>(table_.rows.at(row).at(place(column)));
  }
  std::string text(std::size_t row, const std::string& column) const {
    return std::get<std::string>(table_.rows.at(row).at(place(column)));
  }
  std::vector<double> numbers(const std::string& column) const {
    std::vector<double> all;
    for (std::size_t k = 0; k < count(); ++k) all.push_back(number(k, column));
    return all;
  }
  const records::Table& table() const { return table_; }

 private:
  std::size_t place(const std::string& column) const {
    for (std::size_t c = 0; c < table_.columns.size(); ++c)
      if (table_.columns[c].name == column) return c;
    throw std::out_of_range("no column " + column);
  }
  records::Table table_;
};

/// Whether one of some texts has these words.
template <class List>
bool says_one_of(const List& texts, const std::string& words) {
  for (const std::string& text : texts)
    if (text.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace bough::verify
