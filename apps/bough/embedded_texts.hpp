#pragma once
/// Texts of the source tree that stand in the program: the manual for `bough explain`, scenes for `bough new`.
#include <string_view>
#include <vector>

namespace bough::app {

struct EmbeddedText {
  std::string_view path;  ///< "data/manual/guides/trust.md"
  std::string_view text;
};

/// The pages of the manual.
std::vector<EmbeddedText> manual_pages();
/// The scenes that `bough new` writes.
std::vector<EmbeddedText> new_scenes();

}  // namespace bough::app
