#pragma once
/// What is shown of a file beside a fault: its line with a mark, and where a name is defined.
#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bough/io/json_value.hpp"
#include "bough/io/read_scene.hpp"

namespace bough::io {

/// The line around an offset with the bytes from there marked, as far as they stand on this line: at most 100
/// characters before and 60 behind. Tabs are shown as one space each, so that the mark stands below what it marks.
Excerpt excerpt_of(std::string_view text, int line, std::size_t offset, std::size_t length);

/// The length of the token that starts at an offset: a string with its quotes, or what stands up to the next gap.
std::size_t token_length(std::string_view text, std::size_t offset);

/// The excerpt as lines of text, with a mark of `^` and a remark behind it.
std::string marked_lines(const Excerpt& excerpt, char mark, const std::string& remark);

/// Where the things of a document get their names: the members "name" of the items of its lists.
class DefinedNames {
 public:
  struct Place {
    const JsonValue* name = nullptr;  ///< the string
    std::string list;                 ///< "beams"
  };

  /// root: the document; nullptr: there is none.
  explicit DefinedNames(const JsonValue* root);

  /// The first thing of a name that the file itself writes; nullptr: none.
  const Place* find(const std::string& name) const;
  const std::vector<std::string>& all() const { return all_; }

 private:
  std::unordered_map<std::string, Place> first_;
  std::vector<std::string> all_;  ///< each once
};

}  // namespace bough::io
