#pragma once
#include <string>
#include <vector>

namespace bough::plan {

/// "'a'", "'a' and 'b'", "'a', 'b', 'c' and 4 more"
inline std::string listed(const std::vector<std::string>& names) {
  const std::size_t shown = names.size() <= 4 ? names.size() : 3;
  std::string text;
  for (std::size_t i = 0; i < shown; ++i)
    text += (i == 0 ? "'" : i + 1 == names.size() ? " and '" : ", '") + names[i] + "'";
  return shown < names.size() ? text + " and " + std::to_string(names.size() - shown) + " more" : text;
}

}  // namespace bough::plan
