#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace bough::laws {

/// An error in the data of a law, such as a formula that cannot be read or a table out of order.
/// text: the formula as given, empty where the law is not a formula. position: offset in `text` of the first character
/// at fault, from 0; text.size() where more was expected. what(): one sentence for the user.
struct LawError : std::runtime_error {
  LawError(std::string text_in, std::size_t position_in, const std::string& what_in)
      : std::runtime_error(what_in), text(std::move(text_in)), position(position_in) {}

  std::string text;
  std::size_t position;
};

}  // namespace bough::laws
