#pragma once
/// Pieces that the drawings of a profile share. Internal to report.
#include <string>
#include <utility>
#include <vector>

#include "bough/records/profile.hpp"

namespace bough::report {

class Document;

constexpr int num_shades = 9;

/// Rules that fill as many classes, faint to strong, against a light or dark background.
std::string fill_styles(const std::string& selector, const std::string& prefix);

/// A row of buttons of which one is chosen: inputs GROUP-KEY, for rules "#GROUP-KEY:checked~svg ...".
std::string radio_buttons(const std::string& group, const std::vector<std::pair<std::string, std::string>>& choices,
                          std::size_t chosen);

/// The section on interfaces, if there are any.
void add_interfaces(Document& page, const records::Profile& p);

}  // namespace bough::report
