/// bough new KIND: a commented scene to begin with.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/scene/nearest_name.hpp"
#include "embedded_texts.hpp"
#include "result_text.hpp"

namespace bough::app {
namespace {

std::string kind_of(const EmbeddedText& scene) { return io::name_of_file(std::filesystem::path(scene.path)); }

/// The value of "title", which every scene has.
std::string title_of(const EmbeddedText& scene) {
  constexpr std::string_view key = "\"title\": \"";
  const std::size_t at = scene.text.find(key) + key.size();
  return std::string(scene.text.substr(at, scene.text.find('"', at) - at));
}

void print_kinds(std::ostream& out) {
  std::vector<std::vector<std::string>> rows;
  for (const EmbeddedText& scene : new_scenes()) rows.push_back({"  " + kind_of(scene), title_of(scene)});
  out << table_text(rows);
}

}  // namespace

int new_scene(const NewArguments& arguments) {
  if (arguments.kind.empty()) {
    print_kinds(std::cout);
    return exit_done;
  }
  const std::vector<EmbeddedText> scenes = new_scenes();
  const auto scene =
      std::find_if(scenes.begin(), scenes.end(), [&](const EmbeddedText& s) { return kind_of(s) == arguments.kind; });
  if (scene == scenes.end()) {
    std::vector<std::string> kinds;
    std::transform(scenes.begin(), scenes.end(), std::back_inserter(kinds), kind_of);
    const std::string near = scene::nearest_name(arguments.kind, kinds);
    std::cerr << "bough: there is no scene of kind '" << arguments.kind << "'"
              << (near.empty() ? "" : "; did you mean '" + near + "'?") << "\n";
    print_kinds(std::cerr);
    return exit_bad_input;
  }
  if (arguments.out == "-") {
    std::cout << scene->text << std::flush;
    return std::cout.good() ? exit_done : exit_failed;
  }
  const std::filesystem::path file =
      arguments.out.empty() ? std::filesystem::path(arguments.kind + ".json") : arguments.out;
  if (std::filesystem::symlink_status(file).type() != std::filesystem::file_type::not_found) {
    std::cerr << "bough: " << file.string() << " is there already; --out FILE gives another name\n";
    return exit_bad_input;
  }
  io::write_file(file, scene->text);
  std::cout << file.string() << ": " << title_of(*scene) << "\n";
  return exit_done;
}

}  // namespace bough::app
