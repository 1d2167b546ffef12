// Writes schema.json and the base scene, each broken in one place, into a directory: the cases of scene_bad_test that a schema can see.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "bough/io/read_scene.hpp"
#include "scene_base.hpp"
#include "scene_table_cases.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: write_schema_cases directory\n"), 2;
  const std::filesystem::path directory = argv[1];
  std::filesystem::create_directories(directory / "bad");
  std::ofstream(directory / "schema.json") << bough::io::schema_text();
  std::ofstream(directory / "base.json") << bough::io::test::base_scene();
  int n = 0;
  for (const auto& bad : bough::io::test::table_cases) {
    std::string text = bough::io::test::spoilt(bad.from, bad.to);
    if (const std::size_t at = text.find('@'); at != std::string::npos) text.erase(at, 1);
    std::ofstream(directory / "bad" / (std::to_string(n++) + ".json")) << text;
  }
  return 0;
}
