#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "bough/io/json_value.hpp"

namespace bough::io {

/// The path to a value, converted to text only if there is a fault. It refers to the path of the enclosing value, which
/// must outlive it.
struct JsonPath {
  const JsonPath* up = nullptr;
  std::string_view key = {};  ///< of a member; of an item, its number
  std::size_t item = 0;

  std::string text() const {
    if (up == nullptr) return std::string(key);  // a path may begin at a pointer
    return key.data() == nullptr ? up->text() + "/" + std::to_string(item) : pointer_to(up->text(), key);
  }
  JsonPath member(std::string_view name) const { return {this, name, 0}; }
  JsonPath at(std::size_t index) const { return {this, {}, index}; }
};

}  // namespace bough::io
