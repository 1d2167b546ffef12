/// Outlines and surfaces from the texts of their files.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <vector>

#include "scene_files.hpp"

namespace bough::io {
namespace {

/// Lines without comments, and the words of one.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}
  bool next(std::string_view separators) {
    words.clear();
    if (at_ >= text_.size()) return false;
    ++number;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    line = line.substr(0, line.find('#'));
    for (std::size_t k = 0; k < line.size();) {
      const std::size_t begin = line.find_first_not_of(separators, k);
      if (begin == std::string_view::npos) break;
      k = std::min(line.find_first_of(separators, begin), line.size());
      words.push_back(line.substr(begin, k - begin));
    }
    return true;
  }
  std::string where() const { return "line " + std::to_string(number) + ": "; }

  std::vector<std::string_view> words;
  std::size_t number = 0;

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

constexpr std::string_view blanks = " \t\r";
constexpr double largest = 1e100;  // a number whose cube is finite

bool read_coordinate(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::abs(value) <= largest;
}

double doubled_area(const std::vector<std::array<double, 2>>& loop) {
  double sum = 0.0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const auto &a = loop[k], &b = loop[(k + 1) % loop.size()];
    sum += a[0] * b[1] - b[0] * a[1];
  }
  return sum;
}

/// Merges equal points and collects triangles; triangles without area are omitted.
class MeshMaker {
 public:
  int point(const std::array<double, 3>& x) {
    const auto [at, is_new] = known_.emplace(x, static_cast<int>(mesh.points.size()));
    if (is_new) mesh.points.push_back(x);
    return at->second;
  }
  bool triangle(int a, int b, int c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
    return mesh.triangles.size() <= most_triangles;
  }
  scene::Mesh mesh;

 private:
  std::map<std::array<double, 3>, int> known_;
};

using Result = OrFault<scene::Mesh>;
Result wrong(std::string words) { return Result(std::in_place_index<1>, std::move(words)); }
std::string too_many() { return "there are more than " + std::to_string(most_triangles) + " triangles"; }

Result whole(MeshMaker maker) {
  if (maker.mesh.triangles.empty()) return wrong("the file holds no triangles");
  return Result(std::in_place_index<0>, std::move(maker.mesh));
}

/// 80 bytes, the number of triangles (uint32), and of each 12 float32 (normal, three corners) and 2 bytes.
constexpr std::size_t stl_head = 84, stl_triangle = 50;

std::size_t binary_triangles(std::string_view text) {
  std::uint32_t count = 0;
  if (text.size() >= stl_head) std::memcpy(&count, text.data() + 80, sizeof count);
  return count;
}

Result binary_stl(std::string_view text) {
  const std::size_t count = binary_triangles(text);
  if (count > most_triangles) return wrong(too_many());
  MeshMaker maker;
  for (std::size_t k = 0; k < count; ++k) {
    int corners[3];
    for (std::size_t c = 0; c < 3; ++c) {
      float x[3];
      const std::size_t at = stl_head + stl_triangle * k + 12 * (c + 1);
      std::memcpy(x, text.data() + at, sizeof x);
      for (const float v : x)
        if (!std::isfinite(v)) return wrong("byte " + std::to_string(at) + ": a coordinate is not a finite number");
      corners[c] = maker.point({static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])});
    }
    maker.triangle(corners[0], corners[1], corners[2]);
  }
  return whole(std::move(maker));
}

Result text_stl(std::string_view text) {
  MeshMaker maker;
  std::vector<int> corners;
  for (Lines lines(text); lines.next(blanks);) {
    const auto& w = lines.words;
    if (w.empty()) continue;
    if (w[0] == "vertex") {
      std::array<double, 3> x{};
      if (w.size() != 4 || !read_coordinate(w[1], x[0]) || !read_coordinate(w[2], x[1]) || !read_coordinate(w[3], x[2]))
        return wrong(lines.where() + "a vertex has three finite coordinates");
      corners.push_back(maker.point(x));
    } else if (w[0] == "endloop") {
      if (corners.size() != 3) return wrong(lines.where() + "a facet has three vertices");
      if (!maker.triangle(corners[0], corners[1], corners[2])) return wrong(too_many());
      corners.clear();
    } else if (w[0] != "solid" && w[0] != "facet" && w[0] != "outer" && w[0] != "endfacet" && w[0] != "endsolid") {
      return wrong(lines.where() + "this is no word of STL");
    }
  }
  if (!corners.empty()) return wrong("the file ends within a facet");
  return whole(std::move(maker));
}

Result obj(std::string_view text) {
  MeshMaker maker;
  std::vector<int> vertices;
  for (Lines lines(text); lines.next(blanks);) {
    const auto& w = lines.words;
    if (w.empty()) continue;
    if (w[0] == "v") {
      std::array<double, 3> x{};
      if (w.size() < 4 || !read_coordinate(w[1], x[0]) || !read_coordinate(w[2], x[1]) || !read_coordinate(w[3], x[2]))
        return wrong(lines.where() + "a vertex has three finite coordinates");
      vertices.push_back(maker.point(x));
    } else if (w[0] == "f") {
      std::vector<int> face;
      for (std::size_t k = 1; k < w.size(); ++k) {
        const std::string_view word = w[k].substr(0, w[k].find('/'));
        long index = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (index < 0) index += static_cast<long>(vertices.size()) + 1;  // counted from the last one
        if (error != std::errc() || end != word.data() + word.size() || index < 1 ||
            index > static_cast<long>(vertices.size()))
          return wrong(lines.where() + "a face names vertices that stand before it");
        face.push_back(vertices[static_cast<std::size_t>(index) - 1]);
      }
      if (face.size() < 3) return wrong(lines.where() + "a face has at least three vertices");
      for (std::size_t k = 2; k < face.size(); ++k)
        if (!maker.triangle(face[0], face[k - 1], face[k])) return wrong(too_many());
    }  // normals, groups, materials and the like do not change the shape
  }
  return whole(std::move(maker));
}

}  // namespace

OrFault<scene::Outline> outline_of_text(std::string_view text) {
  using Outcome = OrFault<scene::Outline>;
  const auto fails = [](std::string words) { return Outcome(std::in_place_index<1>, std::move(words)); };
  constexpr std::size_t most_corners = 500;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  scene::Outline outline;
  bool is_open = false;
  std::size_t corners = 0;
  for (Lines lines(text); lines.next(" \t\r,;");) {
    if (lines.words.empty()) {
      is_open = false;
      continue;
    }
    std::array<double, 2> x{};
    if (lines.words.size() != 2 || !read_coordinate(lines.words[0], x[0]) || !read_coordinate(lines.words[1], x[1]))
      return fails(lines.where() + "a corner is two finite numbers");
    if (++corners > most_corners) return fails("there are more than " + std::to_string(most_corners) + " corners");
    if (!is_open) outline.loops.emplace_back();
    is_open = true;
    outline.loops.back().push_back(x);
  }
  if (outline.loops.empty()) return fails("the file holds no corners");
  for (std::size_t k = 0; k < outline.loops.size(); ++k) {
    auto& loop = outline.loops[k];
    if (loop.size() > 3 && loop.front() == loop.back())
      loop.pop_back();  // many programs repeat the first point at the
                        // end
    if ((doubled_area(loop) < 0.0) == (k == 0)) std::reverse(loop.begin(), loop.end());
  }
  return Outcome(std::in_place_index<0>, std::move(outline));
}

OrFault<scene::Mesh> mesh_of_text(std::string_view text, std::string_view ending) {
  if (ending == ".obj") return obj(text);
  if (ending != ".stl") return wrong("surfaces are read from files that end with .stl or .obj");
  if (text.size() >= stl_head && text.size() == stl_head + stl_triangle * binary_triangles(text))
    return binary_stl(text);
  if (text.starts_with("solid")) return text_stl(text);
  return wrong("this is no STL: a binary file has 84 bytes and 50 for each triangle, a text begins with solid");
}

}  // namespace bough::io
