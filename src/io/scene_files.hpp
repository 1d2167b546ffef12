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

/// A value, or a description of the fault of the file, with line or byte.
template <class T>
using OrFault = std::variant<T, std::string>;

/// Corners of a polygon, one per line: two numbers with a comma, semicolon or blanks between them. A line without
/// numbers ends a loop; loops after the first are holes. Each loop gets the sense of rotation that scene::Outline
/// requires. # begins a comment.
OrFault<scene::Outline> outline_of_text(std::string_view text);

/// A surface from STL, binary or text, or OBJ, of which vertices and faces are read (polygons as fans of triangles).
/// Equal corners become one point. At most `most_triangles`.
inline constexpr std::size_t most_triangles = 100'000;
OrFault<scene::Mesh> mesh_of_text(std::string_view text, std::string_view ending);

/// Reads files below one folder.
class SceneFiles {
 public:
  explicit SceneFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The bytes of a file, or its fault: the name is absolute, the file is not below the folder after links are
  /// resolved, it is not a regular file, or it is larger than `most_bytes`.
  OrFault<std::string> read(const std::string& name, std::size_t most_bytes);
  /// Names and bytes of all files read, ordered by name.
  [[nodiscard]] std::string contents() const;
  /// Adds the numbers of a surface to the total; false if the total is more than pages and pictures can hold.
  [[nodiscard]] bool count(const scene::Mesh& mesh);

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::string> known_;
  std::size_t numbers_ = 0;
};

}  // namespace bough::io
