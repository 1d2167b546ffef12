#include "scene_files.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/input_file.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& file, const fs::path& folder) {
  const auto [end, at] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && at != file.end();
}

}  // namespace

OrFault<std::string> SceneFiles::read(const std::string& name, std::size_t most_bytes) {
  const auto wrong = [](std::string words) { return OrFault<std::string>(std::in_place_index<1>, std::move(words)); };
  if (const auto known = known_.find(name); known != known_.end()) {
    if (known->second.size() > most_bytes) return wrong(too_large_text(most_bytes));
    return OrFault<std::string>(std::in_place_index<0>, known->second);
  }
  if (folder_.empty()) return wrong("files can be named only by a scene that is read from a file itself");
  if (fs::path(name).is_absolute()) return wrong("the name has to be relative to the folder of the scene");
  std::error_code error;
  const fs::path folder = fs::canonical(folder_, error);
  const fs::path file = error ? fs::path() : fs::canonical(folder / name, error);
  if (error) return wrong("there is no such file beside the scene");
  if (!is_below(file, folder)) return wrong("the file does not lie below the folder of the scene");
  try {
    const std::string& bytes = known_.emplace(name, read_text(file, most_bytes)).first->second;
    return OrFault<std::string>(std::in_place_index<0>, bytes);
  } catch (const Unreadable& fault) {
    return wrong(fault.why());
  }
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
