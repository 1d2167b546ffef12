// Sweeps from files: what is read, and what is told where something is wrong.
#include <gtest/gtest.h>

#include <filesystem>

#include "bough/io/atomic_file.hpp"
#include "bough/io/read_sweep.hpp"
#include "support/scratch_directory.hpp"
#include "support/source_dir.hpp"

namespace bough::io {
namespace {

const char* const scene = R"({"schema_version": 1, "parameters": {"m": 1, "k": 2},
  "bodies": [{"name": "a", "kind": "point_mass", "mass": {"expression": "m"}},
             {"name": "b", "kind": "point_mass", "mass": {"expression": "k"}, "position": [1, 0, 0]}],
  "sensors": [{"name": "a", "kind": "position", "at": "a"}],
  "measures": [{"name": "own", "quantity": "a.x"}],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1}})";

class Sweeps : public testing::Test {
 protected:
  Sweeps() {
    write_file(folder_ / "scene.json", scene);
    write_file(folder_ / "table.csv", "case;x\n");
  }
  SweepFile read(const std::string& members) const {
    return read_sweep_text(R"({"schema_version": 1, "scene": "scene.json", )" + members + "}", "s", folder_.path());
  }
  void expect_problem(const std::string& members, const std::vector<std::string>& words) const {
    const SweepFile file = read(members);
    ASSERT_FALSE(file.ok()) << members;
    for (const std::string& word : words) {
      bool is_there = false;
      for (const Problem& p : file.problems) is_there = is_there || p.text().find(word) != std::string::npos;
      EXPECT_TRUE(is_there) << word << " in: " << file.problems.front().text();
    }
  }
  support::ScratchDirectory folder_;
};

std::string design(const std::string& members) { return "\"designs\": [{" + members + "}]"; }

TEST_F(Sweeps, a_sweep_is_read_whole) {
  write_file(folder_ / "table.csv", "\xEF\xBB\xBFk,\"in\"\"put\"\r\n1.5,two\r\n\r\n\"2\",\"x,\ny\"\n");
  const SweepFile file = read(R"("title": "t", "set": [{"pointer": "/bodies/*/position", "value": [0, 1, 0]}],
      "designs": [
        {"kind": "csv", "file": "table.csv", "variables": [{"name": "k"}, {"name": "title", "pointer": "/title", "column": "in\"put"}]},
        {"kind": "random", "samples": 3, "seed": 9, "variables": [{"name": "mass", "pointer": "/parameters/m",
           "distribution": {"kind": "uniform", "low": 1, "high": 2}}]}],
      "where": [{"expression": "k + mass", "low": 1}],
      "measures": [{"name": "more", "quantity": "a.y", "figure": "max"}])");
  for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
  ASSERT_EQ(file.spec.designs.size(), 2u);
  EXPECT_EQ(file.spec.designs[0].variables[0].values[0].number, 1.5);
  EXPECT_EQ(file.spec.designs[0].variables[1].values[1].text, "\"x,\\ny\"");
  EXPECT_EQ(file.spec.designs[1].samples, 3u);
  EXPECT_EQ(file.spec.designs[1].variables[0].pointers, std::vector<std::string>{"/parameters/m"});
  ASSERT_EQ(file.spec.overrides.size(), 3u);  // a position each, and the measures
  const SceneFile base = read_scene_text(file.spec.scene_text, "base", file.spec.overrides);
  ASSERT_TRUE(base.ok());
  ASSERT_EQ(base.scene.measures.size(), 2u);  // the scene's own, then those of the sweep
  EXPECT_EQ(base.scene.measures[0].name, "own");
}

TEST_F(Sweeps, what_is_wrong_is_told_at_its_place) {
  const std::string random = R"("kind": "random", "samples": 3, "variables": [{"name": "m", "distribution": )";
  expect_problem(design(R"("kind": "grid", "variables": [{"name": "mm", "values": [1]}])"),
                 {"/designs/0/variables/0", "no parameter of this name", "\"m\""});
  expect_problem(design(R"("kind": "grid", "variables": [{"name": "m", "values": [1]}, {"name": "m", "values": [2]}])"),
                 {"another variable has this name"});
  expect_problem(design(R"("kind": "grid", "variables": [{"name": "m", "values": [-1]}])"), {"at least 0"});
  expect_problem(design(R"("kind": "grid", "variables": [{"name": "x", "pointer": "/beams/*/order", "values": [1]}])"),
                 {"nothing in the scene"});
  expect_problem(design(R"("kind": "list", "variables": [{"name": "m"}], "rows": [[1], [1, 2]])"),
                 {"/designs/0/rows/1"});
  expect_problem(design(R"("kind": "csv", "file": "table.csv", "variables": [{"name": "m"}])"), {"no rows"});
  expect_problem(design(R"("kind": "csv", "file": "none.csv", "variables": [{"name": "m"}])"), {"no such file"});
  expect_problem(design(random + R"({"kind": "uniform", "low": 2, "high": 2}}])"), {"above \"low\""});
  expect_problem(design(random + R"({"kind": "discrete", "values": [1, 2], "weights": [1]}}])"), {"as many weights"});
  expect_problem(design(random + R"({"kind": "discrete", "values": [1, 2], "weights": [0, 0]}}])"),
                 {"sum of the weights"});
  expect_problem(design(random + R"({"kind": "normal", "mean": 1, "standard_deviation": 0}}])"), {"above 0"});
  expect_problem(design(R"("kind": "saltelly", "samples": 3, "variables": [])"), {"did you mean \"saltelli\"?"});
  const std::string good = design(R"("kind": "grid", "variables": [{"name": "m", "values": [1]}])");
  expect_problem(good + R"(, "where": [{"expression": "n", "low": 1}])", {"/where/0/expression"});
  expect_problem(good + R"(, "where": [{"expression": "m"}])", {"/where/0", "low"});
  expect_problem(good + R"(, "measures": [{"name": "a", "quantity": "b.x"}])", {"/measures", "no sensor"});
  write_file(folder_ / "scene.json", "[");
  expect_problem(good, {"/scene", "not JSON"});
  std::filesystem::remove(folder_ / "scene.json");
  expect_problem(good, {"/scene", "no such file"});
}

// A value at fault is told by its own case; only what all values share refuses the sweep.
TEST_F(Sweeps, a_bad_value_in_the_first_place_refuses_no_other_case) {
  for (const char* const members :
       {R"("kind": "grid", "variables": [{"name": "m", "values": [-1, 1, 2]}, {"name": "k", "values": [1, -1]}])",
        R"("kind": "grid", "variables": [{"name": "m", "values": [-1, 1]}, {"name": "k", "values": [-1, 2]}])",
        R"("kind": "list", "variables": [{"name": "m"}, {"name": "k"}], "rows": [[0, 1], [1, 0], [3, 4]])"}) {
    const SweepFile file = read(design(members));
    EXPECT_TRUE(file.ok()) << members << file.problems.front().text();
  }
  expect_problem(design(R"("kind": "grid", "variables": [{"name": "m", "values": [-1, -2]}])"), {"/bodies/0/mass"});
  expect_problem(design(R"("kind": "grid", "variables": [{"name": "m", "values": [1, 2]},
      {"name": "q", "pointer": "/bodies/0/mas", "values": [1, 2]}])"),
                 {"mas"});
}

TEST(StandingSweeps, are_sound) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data" / "sweeps")) {
    if (entry.path().extension() != ".json") continue;
    const SweepFile file = read_sweep(entry.path());
    for (const Problem& p : file.problems) ADD_FAILURE() << entry.path() << ": " << p.text();
    ++count;
  }
  EXPECT_GE(count, 1);
}

}  // namespace
}  // namespace bough::io
