#include "scene_files.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

namespace bough::io {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& file, const fs::path& folder) {
  const auto [end, at] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && at != file.end();
}

std::string too_large(std::size_t most_bytes) {
  return "the file is larger than " + std::to_string(most_bytes >> 20u) + " MB";
}

}  // namespace

OrFault<std::string> SceneFiles::read(const std::string& name, std::size_t most_bytes) {
  const auto wrong = [](std::string words) { return OrFault<std::string>(std::in_place_index<1>, std::move(words)); };
  if (const auto known = known_.find(name); known != known_.end()) {
    if (known->second.size() > most_bytes) return wrong(too_large(most_bytes));
    return OrFault<std::string>(std::in_place_index<0>, known->second);
  }
  if (folder_.empty()) return wrong("files can be named only by a scene that is read from a file itself");
  if (fs::path(name).is_absolute()) return wrong("the name has to be relative to the folder of the scene");
  std::error_code error;
  const fs::path folder = fs::canonical(folder_, error);
  const fs::path file = error ? fs::path() : fs::canonical(folder / name, error);
  if (error) return wrong("there is no such file beside the scene");
  if (!is_below(file, folder)) return wrong("the file does not lie below the folder of the scene");
  if (!fs::is_regular_file(file, error)) return wrong("this is not a file");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > most_bytes) return wrong(too_large(most_bytes));
  std::ifstream in(file, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) return wrong("the file can not be read");
  known_.emplace(name, bytes);
  return OrFault<std::string>(std::in_place_index<0>, std::move(bytes));
}

std::string SceneFiles::contents() const {
  std::string all;
  for (const auto& [name, bytes] : known_) all += '\0' + name + '\0' + bytes;
  return all;
}

bool SceneFiles::count(const scene::Mesh& mesh) {
  constexpr std::size_t most_numbers = 1'500'000;
  numbers_ += 3 * (mesh.points.size() + mesh.triangles.size());
  return numbers_ <= most_numbers;
}

}  // namespace bough::io
