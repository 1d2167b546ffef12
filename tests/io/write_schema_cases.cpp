// Writes schema.json and the base scene, each broken in one place, into a directory: the cases of scene_bad_test that
// a schema can see. The same for chains of frames and for studies, in folders of their own.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "bough/io/read_frames.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/read_study.hpp"
#include "bough/io/read_sweep.hpp"
#include "frames_base.hpp"
#include "scene_base.hpp"
#include "scene_table_cases.hpp"

namespace {

/// spoil: the base text with one piece replaced.
template <class Cases, class Spoil>
void write_cases(const std::filesystem::path& directory, const std::string& schema, const std::string& base,
                 const Cases& cases, const Spoil& spoil) {
  std::filesystem::create_directories(directory / "bad");
  std::ofstream(directory / "schema.json") << schema;
  std::ofstream(directory / "base.json") << base;
  int n = 0;
  for (const auto& bad : cases) {
    std::string text = spoil(bad);
    if (const std::size_t at = text.find('@'); at != std::string::npos) text.erase(at, 1);
    std::ofstream(directory / "bad" / (std::to_string(n++) + ".json")) << text;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: write_schema_cases directory\n"), 2;
  namespace io = bough::io;
  const std::filesystem::path directory = argv[1];
  write_cases(directory, io::schema_text(), io::test::base_scene(), io::test::table_cases,
              [](const auto& bad) { return io::test::spoilt(bad.from, bad.to); });
  write_cases(directory / "chain", io::frames_schema_text(), io::test::base_chain(), io::test::chain_table_cases,
              io::test::spoilt_chain);
  write_cases(directory / "study", io::study_schema_text(), R"({
      "schema_version": 1, "scene": "a.json", "quantities": [{"name": "tip", "sensor": "tip", "formula": [0]}],
      "grids": [{"name": "all", "axes": [{"name": "step size", "values": [1e-3]}]}]})",
              std::vector<std::string>{R"({"schema_version": 1, "scene": "a.json", "quantities": [], "grids": []})",
                                       R"({"schema_version": 1, "scene": 7})", R"([])"},
              [](const std::string& text) { return text; });
  write_cases(
      directory / "sweep", io::sweep_schema_text(), R"({
      "schema_version": 1, "scene": "a.json", "designs": [{"kind": "grid", "variables": [{"name": "m", "values": [1]}]}]})",
      std::vector<std::string>{R"({"schema_version": 1, "scene": "a.json", "designs": []})",
                               R"({"schema_version": 1, "scene": "a.json", "designs": [{"kind": "random", "samples": 0,
                                           "variables": [{"name": "m", "distribution": {"kind": "normal"}}]}]})",
                               R"([])"},
      [](const std::string& text) { return text; });
  return 0;
}
