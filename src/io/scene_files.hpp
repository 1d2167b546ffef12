#pragma once
/// Files that a scene names: outlines of sections and surfaces of bodies.
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "bough/scene/outlines.hpp"

namespace bough::io {

/// A value, or what is wrong with the file in words, with line or byte.
template <class T>
using OrFault = std::variant<T, std::string>;

/// Corners of a polygon, one a line: two numbers with a comma, semicolon or blanks between them. A line without
/// numbers ends a loop: those after the first are holes. Holes and outer loop are turned as scene::Outline asks. #
/// begins a comment.
OrFault<scene::Outline> outline_of_text(std::string_view text);

/// A surface: STL, binary or text, or OBJ, of which vertices and faces are read (polygons as fans). Corners at one
/// place are one point. At most `most_triangles`.
inline constexpr std::size_t most_triangles = 100'000;
OrFault<scene::Mesh> mesh_of_text(std::string_view text, std::string_view ending);

/// Reads files below one folder.
class SceneFiles {
 public:
  explicit SceneFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The bytes of a file, or what is wrong: its name is absolute, it does not lie below the folder once links are
  /// resolved, it is no file, or larger than `most_bytes`.
  OrFault<std::string> read(const std::string& name, std::size_t most_bytes);
  /// Names and bytes of all that was read, by name.
  [[nodiscard]] std::string contents() const;
  /// Counts numbers of surfaces; false where all together are more than pages and pictures can hold.
  [[nodiscard]] bool count(const scene::Mesh& mesh);

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::string> known_;
  std::size_t numbers_ = 0;
};

}  // namespace bough::io
