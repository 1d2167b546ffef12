#include "embedded_texts.hpp"

namespace bough::app {

// Made by cmake/EmbedText.cmake: each text after a line with a file separator and its path.
extern const std::string_view manual_text;
extern const std::string_view new_text;

namespace {

std::vector<EmbeddedText> split_texts(std::string_view all) {
  constexpr char separator = '\x1c';
  std::vector<EmbeddedText> texts;
  while (!all.empty()) {
    const std::size_t line_end = all.find('\n');
    const std::size_t next = all.find(separator, 1);
    texts.push_back({all.substr(1, line_end - 1), all.substr(line_end + 1, next - line_end - 1)});
    all.remove_prefix(next == std::string_view::npos ? all.size() : next);
  }
  return texts;
}

}  // namespace

std::vector<EmbeddedText> manual_pages() { return split_texts(manual_text); }
std::vector<EmbeddedText> new_scenes() { return split_texts(new_text); }

}  // namespace bough::app
