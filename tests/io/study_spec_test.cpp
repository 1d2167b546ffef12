#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "bough/io/read_study.hpp"
#include "support/scratch_directory.hpp"
#include "support/source_dir.hpp"
#include "support/untrapped.hpp"

namespace bough::io {
namespace {

/// A folder with a scene and a table, for studies given as text.
class Studies : public testing::Test {
 protected:
  Studies() {
    folder_ = scratch_.path();
    std::ofstream(folder_ / "ball.json") << R"({
      "schema_version": 1, "gravity": [0, 0, -8],
      "bodies": [{"name": "ball", "mass": 2, "inertia": [1, 1, 1]}],
      "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}, {"name": "c", "position": [2, 0, 0]}],
      "materials": [{"name": "steel", "young": 2e11, "poisson": 0.3, "density": 7850}],
      "sections": [{"name": "bar", "shape": {"kind": "rectangle", "width": 0.02, "height": 0.02}, "material": "steel"}],
      "beams": [{"name": "one", "section": "bar", "start": "a", "end": "b", "elements": 1},
                {"name": "two", "section": "bar", "start": "b", "end": "c", "elements": 1}],
      "sensors": [{"name": "place", "kind": "position", "at": "ball"}, {"name": "turn", "kind": "rotation", "at": "ball"}],
      "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1},
      "expected": [{"quantity": "place.x", "value": 0, "tolerance": 1}]})";
    std::ofstream(folder_ / "fall.csv") << "t,x,y,z\n0,0,0,0\n0.5,0,0,-1\n1,0,0,-4\n";
    std::ofstream(folder_ / "bad.csv") << "t,x,y,z\n0,0,0,zero\n";
  }

  /// A sound study; `change` replaces one text in it by another.
  StudyFile read(const std::string& from = "", const std::string& to = "") {
    std::string text = R"({
  "schema_version": 1,
  "scene": "ball.json",
  "set": [{"pointer": "/analysis/tolerance", "value": 1e-10}],
  "quantities": [
    {"name": "place", "sensor": "place", "formula": [0, 0, {"expression": "-4*t^2"}], "source": "free fall"},
    {"name": "height", "sensor": "place", "components": ["z"], "unit": "m"}
  ],
  "sample_interval": 0.5,
  "reference": {"set": [{"pointer": "/analysis/step_size", "value": 0.01}],
                "check": [{"pointer": "/analysis/step_size", "value": 0.02}], "order": 2},
  "grids": [
    {"name": "all",
     "axes": [{"name": "integrator", "values": ["generalized_alpha", "variational"]},
              {"name": "step size", "values": [0.1, 0.05]}],
     "orders": [{"quantity": "place", "order": 2, "theory": "second order"}]}
  ]
})";
    if (!from.empty()) {
      const std::size_t at = text.find(from);
      EXPECT_NE(at, std::string::npos) << from;
      text.replace(at, from.size(), to);
    }
    return read_study_text(text, "study", folder_);
  }

  /// The one problem of a changed study: its pointer and text.
  Problem problem(const std::string& from, const std::string& to) {
    const StudyFile file = read(from, to);
    EXPECT_EQ(file.problems.size(), 1u) << from << " -> " << to;
    for (const Problem& p : file.problems) EXPECT_GT(p.line, 0) << p.text();
    if (file.problems.size() != 1)
      for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
    return file.problems.empty() ? Problem{} : file.problems.front();
  }

  support::ScratchDirectory scratch_;
  std::filesystem::path folder_;
};

TEST_F(Studies, a_sound_one_is_read_whole) {
  const StudyFile file = read();
  for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
  const StudySpec& s = file.spec;
  ASSERT_EQ(s.grids.size(), 1u);
  ASSERT_EQ(s.grids[0].axes.size(), 2u);
  EXPECT_EQ(s.grids[0].abscissa, 1u) << "the first axis of numbers";
  EXPECT_EQ(s.grids[0].axes[0].choices[1].label, "variational");
  EXPECT_EQ(combinations_of(s.grids[0]).size(), 4u);
  EXPECT_EQ(overrides_of(s, s.grids[0], std::vector<std::size_t>{1, 0}),
            (std::vector<std::string>{"/expected=[]", "/analysis/tolerance=1e-10",
                                      "/analysis/integrator=\"variational\"", "/analysis/step_size=0.1"}));
  EXPECT_EQ(sample_times(s), (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_EQ(s.quantities[0].columns.size(), 3u);
  EXPECT_EQ(s.quantities[1].columns.size(), 1u);
  EXPECT_TRUE(s.quantities[0].is_compared());
  EXPECT_EQ(s.repetitions, 3);
  EXPECT_EQ(s.wanted.size(), 5u);
}

TEST_F(Studies, its_scene_may_name_files_in_its_own_folder) {
  std::string scene = (std::stringstream() << std::ifstream(folder_ / "ball.json").rdbuf()).str();
  const std::string rectangle = R"({"kind": "rectangle", "width": 0.02, "height": 0.02})";
  const std::string polygon =
      R"({"kind": "polygon", "torsion_constant": 1e-8, "file": "square.csv"}, "shear_factors": [0.85, 0.85])";
  ASSERT_NE(scene.find(rectangle), std::string::npos);
  scene.replace(scene.find(rectangle), rectangle.size(), polygon);
  std::filesystem::create_directories(folder_ / "scenes");
  std::ofstream(folder_ / "scenes/ball.json") << scene;
  const auto read_it = [&] { return read("\"scene\": \"ball.json\"", "\"scene\": \"scenes/ball.json\""); };
  const StudyFile lost = read_it();
  ASSERT_FALSE(lost.ok());
  EXPECT_NE(lost.problems.front().text().find("there is no such file beside the scene"), std::string::npos)
      << lost.problems.front().text();
  std::ofstream(folder_ / "scenes/square.csv") << "0,0\n0.02,0\n0.02,0.02\n0,0.02\n";
  const StudyFile file = read_it();
  for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
  EXPECT_EQ(file.spec.scene_folder, folder_ / "scenes");
}

TEST_F(Studies, a_star_in_a_pointer_stands_for_every_item) {
  const StudyFile file = read(R"({"name": "integrator", "values": ["generalized_alpha", "variational"]})",
                              R"({"name": "elements", "values": [2, 4]})");
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file.spec.grids[0].axes[0].choices[1].overrides,
            (std::vector<std::string>{"/beams/0/elements=4", "/beams/1/elements=4"}));
  EXPECT_TRUE(file.spec.grids[0].axes[0].larger_is_finer);
}

TEST_F(Studies, a_table_serves_in_place_of_a_formula) {
  const std::string formula = R"("formula": [0, 0, {"expression": "-4*t^2"}])";
  const StudyFile file = read(formula, R"("table": {"file": "fall.csv", "columns": ["x", "y", "z"]})");
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file.spec.quantities[0].table_times, (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_EQ(file.spec.quantities[0].table_rows[2], (std::vector<double>{0.0, 0.0, -4.0}));
  EXPECT_EQ(problem(formula, R"("table": {"file": "none.csv", "columns": ["x", "y", "z"]})").pointer,
            "/quantities/0/table/file");
  EXPECT_EQ(problem(formula, R"("table": {"file": "bad.csv", "columns": ["x", "y", "z"]})").pointer,
            "/quantities/0/table/file");
  EXPECT_EQ(problem(formula, R"("table": {"file": "fall.csv", "columns": ["x", "y", "w"]})").pointer,
            "/quantities/0/table/columns/2");
  EXPECT_EQ(problem(formula, R"("table": {"file": "fall.csv", "columns": ["x", "y"]})").pointer,
            "/quantities/0/table/columns");
}

TEST_F(Studies, a_table_without_a_sample_time_is_told) {
  std::ofstream(folder_ / "short.csv") << "t,x,y,z\n0,0,0,0\n1,0,0,-4\n";
  const Problem p = problem(R"("formula": [0, 0, {"expression": "-4*t^2"}])",
                            R"("table": {"file": "short.csv", "columns": ["x", "y", "z"]})");
  EXPECT_NE(p.rule.find("0.5"), std::string::npos) << p.text();
}

TEST_F(Studies, each_mistake_is_told_at_its_place) {
  EXPECT_EQ(problem(R"("sensor": "place", "formula")", R"("sensor": "plaice", "formula")").pointer,
            "/quantities/0/sensor");
  EXPECT_EQ(problem(R"(["z"])", R"(["w"])").pointer, "/quantities/1/components/0");
  EXPECT_EQ(problem(R"("scene": "ball.json")", R"("scene": "bull.json")").pointer, "/scene");
  EXPECT_EQ(problem(R"({"name": "step size",)", R"({"name": "step sise",)").pointer, "/grids/0/axes/1/name");
  EXPECT_EQ(problem(R"("quantity": "place")", R"("quantity": "plaice")").pointer, "/grids/0/orders/0/quantity");
  EXPECT_EQ(problem(R"("sample_interval": 0.5)", R"("sample_interval": 0.3)").pointer, "/sample_interval");
  EXPECT_EQ(problem(R"([0, 0, {"expression": "-4*t^2"}])", R"([0, 0])").pointer, "/quantities/0/formula");
  EXPECT_EQ(problem(R"("name": "height")", R"("name": "place")").pointer, "/quantities/1/name");
}

TEST_F(Studies, a_formula_that_is_not_finite_at_a_sample_time_is_told) {
  const test::Untrapped division_by_zero;
  EXPECT_EQ(problem(R"x("-4*t^2")x", R"x("-4/(t - 0.5)")x").pointer, "/quantities/0/formula/2");
}

TEST_F(Studies, a_misspelt_key_is_told_with_the_one_that_was_meant) {
  const Problem p = problem(R"("sample_interval": 0.5)", R"("sample_intervall": 0.5)");
  EXPECT_EQ(p.pointer, "/sample_intervall");
  EXPECT_NE(p.hint.find("sample_interval"), std::string::npos);
}

TEST_F(Studies, a_value_that_the_scene_does_not_take_is_blamed_on_the_value) {
  const Problem word = problem(R"("variational"])", R"("variatonal"])");
  EXPECT_EQ(word.pointer, "/grids/0/axes/0/values/1");
  EXPECT_NE(word.rule.find("/analysis/integrator"), std::string::npos) << word.text();
  EXPECT_EQ(problem("[0.1, 0.05]", "[0.1, -0.05]").pointer, "/grids/0/axes");
  EXPECT_EQ(problem(R"("value": 1e-10)", R"("value": "small")").pointer, "/set");
}

TEST_F(Studies, an_axis_that_changes_the_mechanics_is_refused_with_where_to_go) {
  const char* const integrators = R"({"name": "integrator", "values": ["generalized_alpha", "variational"]})";
  for (const std::string pointer : {"/gravity", "/beams/*/section", "/analysis/end_time", "/bodies/0/mass"}) {
    const Problem p = problem(integrators, R"({"name": "x", "pointer": ")" + pointer + R"(", "values": [1, 2]})");
    EXPECT_NE(p.text().find("bough sweep"), std::string::npos) << p.text();
    EXPECT_EQ(p.pointer, "/grids/0/axes/0/pointer");
  }
}

TEST_F(Studies, steps_divide_the_sample_interval) {
  const Problem p = problem("[0.1, 0.05]", "[0.1, 0.03]");
  EXPECT_EQ(p.pointer, "/grids/0/axes/1/values/1");
  EXPECT_NE(p.rule.find("0.03"), std::string::npos);
}

TEST_F(Studies, nothing_is_compared_with_itself) {
  const StudyFile file = read(R"("value": 0.01})", R"("value": 0.05})");
  ASSERT_EQ(file.problems.size(), 1u);
  EXPECT_EQ(file.problems[0].pointer, "/reference");
  EXPECT_EQ(problem(R"("value": 0.02})", R"("value": 1e-2})").pointer, "/reference") << "the check is the reference";
}

TEST_F(Studies, a_quantity_without_anything_to_compare_with_is_told) {
  const StudyFile whole = read();
  ASSERT_TRUE(whole.ok());
  const Problem p = problem(R"("reference": {"set": [{"pointer": "/analysis/step_size", "value": 0.01}],
                "check": [{"pointer": "/analysis/step_size", "value": 0.02}], "order": 2},)",
                            "");
  EXPECT_EQ(p.pointer, "/quantities/1");
}

TEST_F(Studies, sensors_are_replaced_and_their_mistakes_told_where_they_stand) {
  const std::string before = R"("sample_interval")";
  const StudyFile good =
      read(before, R"("sensors": [{"name": "place", "kind": "position", "at": "ball"}], "sample_interval")");
  EXPECT_TRUE(good.ok());
  const Problem p =
      problem(before, R"("sensors": [{"name": "place", "kind": "position", "at": "boll"}], "sample_interval")");
  EXPECT_EQ(p.pointer, "/sensors/0/at");
}

TEST_F(Studies, text_that_is_no_study_never_throws) {
  for (const char* text : {"", "[]", "null", "{", "{\"schema_version\": 1}", "{\"scene\": 7, \"grids\": {}}",
                           "{\"schema_version\": 1, \"scene\": \"ball.json\", \"quantities\": [], \"grids\": []}"})
    EXPECT_FALSE(read_study_text(text, "x", folder_).ok()) << text;
  EXPECT_FALSE(read_study(folder_ / "none.json").ok());
}

/// Every run is read before the first starts: a grid of millions never started.
TEST_F(Studies, a_grid_of_more_runs_than_anybody_waits_for_is_a_problem) {
  std::string steps = "[0.5", radii = "[0.5";
  for (int k = 2; k <= 80; ++k) {
    steps += ", " + std::to_string(0.5 / k);
    radii += ", " + std::to_string(0.5 + 0.005 * k);
  }
  const StudyFile file =
      read("[0.1, 0.05]}",
           steps + R"(]}, {"name": "radius", "pointer": "/analysis/spectral_radius", "values": )" + radii + "]}");
  ASSERT_FALSE(file.ok());
  EXPECT_NE(file.problems.front().text().find("a study has at most 5000 runs"), std::string::npos)
      << file.problems.front().text();
}

TEST(StandingStudies, are_read_with_the_scenes_of_all_their_runs) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data" / "studies")) {
    if (entry.path().extension() != ".json") continue;
    const StudyFile file = read_study(entry.path());
    EXPECT_TRUE(file.ok()) << entry.path() << ": " << file.problems.front().text();
    ++count;
  }
  EXPECT_GE(count, 8);
}

TEST(CanonicalScene, is_the_same_for_the_same_scene_and_not_for_another) {
  const std::string scene = R"({"schema_version": 1, "bodies": [{"name": "b", "mass": 1, "inertia": [1, 1, 1]}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.5}})";
  const std::vector<std::string> none, same = {"/analysis/step_size=5e-1"}, other = {"/analysis/step_size=0.25"},
                                       by_default = {"/analysis/spectral_radius=0.8"}, bad = {"/analysis/step_size=-1"};
  EXPECT_FALSE(canonical_scene(scene, none).empty());
  EXPECT_EQ(canonical_scene(scene, none), canonical_scene(scene, same));
  EXPECT_EQ(canonical_scene(scene, none), canonical_scene(scene, by_default)) << "defaults are filled in";
  EXPECT_NE(canonical_scene(scene, none), canonical_scene(scene, other));
  EXPECT_EQ(canonical_scene(scene, bad), "");
}

}  // namespace
}  // namespace bough::io
