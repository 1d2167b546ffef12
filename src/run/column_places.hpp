#pragma once
/// Columns of a history by name.
#include <string_view>
#include <unordered_map>

#include "bough/records/run.hpp"

namespace bough::run {

/// Names and places of columns, for as long as the header lives.
class ColumnPlaces {
 public:
  explicit ColumnPlaces(const records::HistoryHeader& header) : num_columns_(header.columns.size()) {
    places_.reserve(num_columns_);
    for (std::size_t k = 0; k < num_columns_; ++k) places_.emplace(header.columns[k], k);
  }
  /// The first column of this name; the number of columns where none has it.
  std::size_t of(std::string_view name) const {
    const auto known = places_.find(name);
    return known == places_.end() ? num_columns_ : known->second;
  }

 private:
  std::size_t num_columns_;
  std::unordered_map<std::string_view, std::size_t> places_;
};

}  // namespace bough::run
