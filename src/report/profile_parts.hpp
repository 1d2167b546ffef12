#pragma once
/// Pieces that the drawings of a profile share. Internal to report.
#include <string>
#include <utility>
#include <vector>

namespace bough::report {

/// Rules that fill nine classes, faint to strong, against a light or dark background.
std::string fill_styles(const std::string& selector, const std::string& prefix);

/// A row of buttons of which one is chosen: inputs GROUP-KEY, for rules "#GROUP-KEY:checked~svg ...".
std::string radio_buttons(const std::string& group, const std::vector<std::pair<std::string, std::string>>& choices,
                          std::size_t chosen);

}  // namespace bough::report
