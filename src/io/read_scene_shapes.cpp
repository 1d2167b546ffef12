/// Shapes of sections and bodies, from the scene or from files that it names.
#include <algorithm>
#include <memory>

#include "read_scene_impl.hpp"

namespace bough::io {

std::optional<scene::Outline> Converter::outline(const Value& v, const std::string& at) {
  scene::Outline outline;
  if (const Value* file = v.find("file")) {
    constexpr std::size_t most_bytes = std::size_t{1} << 20u;
    const OrFault<std::string> text = files.read(file->text.str(), most_bytes);
    const OrFault<scene::Outline> read = text.index() == 1
                                             ? OrFault<scene::Outline>(std::in_place_index<1>, std::get<1>(text))
                                             : outline_of_text(std::get<0>(text));
    if (read.index() == 1) {
      fault(at + "/file", std::get<1>(read), "", shown_in_quotes(file->text.str()));
      return std::nullopt;
    }
    outline = std::get<0>(read);
    const Value* holes = v.find("holes");
    if (holes != nullptr && !holes->items.empty()) {
      fault(at + "/holes", "holes of an outline from a file stand in the file", "each after an empty line");
      return std::nullopt;
    }
  } else {
    outline.loops.push_back(corners(*v.find("points")));
    if (const Value* holes = v.find("holes"))
      for (const Value& hole : holes->items) outline.loops.push_back(corners(hole));
  }
  if (!is_sound(outline, v.find("file") != nullptr ? at + "/file" : at)) return std::nullopt;
  return outline;
}

void Converter::body_looks(const Value& v, const std::string& at, scene::Body& body) {
  const Value* looks = v.find("looks");
  if (looks == nullptr) return;
  const std::string name = looks->find("file")->text.str();
  std::string ending = std::filesystem::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const OrFault<std::string> text = files.read(name, max_file_bytes);
  const OrFault<scene::Mesh> read = text.index() == 1 ? OrFault<scene::Mesh>(std::in_place_index<1>, std::get<1>(text))
                                                      : mesh_of_text(std::get<0>(text), ending);
  const auto wrong = [&](const std::string& words) { fault(at + "/looks/file", words, "", shown_in_quotes(name)); };
  if (read.index() == 1) return wrong(std::get<1>(read));
  scene::Mesh mesh = std::get<0>(read);
  if (!files.count(mesh)) return wrong("all surfaces of the scene together are too large for pictures");
  const double scale = number_or(*looks, "scale", 1.0);
  for (auto& x : mesh.points)
    for (int c = 0; c < 3; ++c)
      x[static_cast<std::size_t>(c)] = scale * x[static_cast<std::size_t>(c)] - body.center_of_mass[c];
  body.looks = std::make_shared<const scene::Mesh>(std::move(mesh));
}

}  // namespace bough::io
