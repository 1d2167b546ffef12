// Scenes that vary: named numbers, formulas and copies, against the same scenes written out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "bough/io/read_scene.hpp"
#include "bough/io/read_study.hpp"
#include "scene_base.hpp"
#include "support/source_dir.hpp"
#include "support/untrapped.hpp"

namespace bough::io {
namespace {

std::string texts(const std::vector<Problem>& list) {
  std::string all;
  for (const Problem& p : list) all += p.text() + "\n";
  return all;
}

/// A scene of these members with what every scene needs.
std::string scene_of(const std::string& members) {
  return "{\"schema_version\": 1, \"analysis\": {\"kind\": \"dynamic\", \"end_time\": 1, \"step_size\": 0.1},\n" +
         members + "}";
}

std::string body(const std::string& mass) {
  return R"("bodies": [{"name": "a", "kind": "point_mass", "mass": )" + mass + "}]";
}

/// The only problem of a scene, as text.
std::string problem_of(const std::string& members) {
  const SceneFile file = read_scene_text(scene_of(members), "s");
  EXPECT_EQ(file.problems.size(), 1u) << members << "\n" << texts(file.problems);
  return file.problems.empty() ? "" : file.problems.front().text();
}

void expect_problem(const std::string& members, const std::vector<std::string>& words) {
  const std::string text = problem_of(members);
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

double mass_of(const std::string& members) {
  const SceneFile file = read_scene_text(scene_of(members), "s");
  EXPECT_TRUE(file.ok()) << texts(file.problems);
  return file.ok() ? file.scene.bodies.at(0).mass : 0.0;
}

TEST(SceneVary, a_formula_stands_for_any_number_without_parameters) {
  EXPECT_EQ(mass_of(body(R"x({"expression": "2*(1 + 0.25)"})x")), 2.5);
  EXPECT_EQ(mass_of(body(R"x({"expression": "pi", "comment": "a remark"})x")), 3.141592653589793);
  const std::string hand = scene_of(R"("gravity": [0, 0.5, -9.81], )" + body("2"));
  const std::string formula =
      scene_of(R"("gravity": [0, {"expression": "1/2"}, {"expression": "-9.81"}], )" + body("2"));
  EXPECT_EQ(canonical_scene(formula, {}), canonical_scene(hand, {}));
}

TEST(SceneVary, parameters_may_depend_on_each_other_in_any_order) {
  EXPECT_EQ(mass_of(R"("parameters": {"c": {"expression": "a*b"}, "a": 3, "b": {"expression": "a - 1"}}, )" +
                    body(R"({"expression": "c/2"})")),
            3.0);
  EXPECT_EQ(mass_of(R"("parameters": {"a": -2}, )" + body(R"({"expression": "a^2"})")), 4.0);  // not -(2^2)
}

TEST(SceneVary, a_tower_of_parameters_is_evaluated_in_linear_time) {
  constexpr int n = 50'000;
  std::string parameters;  // each before the one that it needs
  for (int i = n - 1; i > 0; --i)
    parameters += "\"p" + std::to_string(i) + "\": {\"expression\": \"p" + std::to_string(i - 1) + " + 1\"}, ";
  parameters += "\"p0\": 1";
  EXPECT_EQ(mass_of("\"parameters\": {" + parameters + "}, " +
                    body(R"({"expression": "p)" + std::to_string(n - 1) + R"("})")),
            static_cast<double>(n));
}

TEST(SceneVary, cycles_are_told_once_with_their_names) {
  expect_problem(R"("parameters": {"a": {"expression": "b"}, "b": {"expression": "2*c"}, "c": {"expression": "a"},
                                   "d": {"expression": "a"}}, )" +
                     body(R"({"expression": "d"})"),
                 {"depends on itself", "a needs b, which needs c, which needs a", "line 2"});
  expect_problem(R"("parameters": {"a": {"expression": "a + 1"}}, )" + body(R"({"expression": "a"})"),
                 {"/parameters/a/expression", "a needs a"});
}

TEST(SceneVary, names_that_mean_something_else_are_refused) {
  for (const std::string name : {"t", "pi", "e", "sin", "max", "step", "pow", "2a", "a b", "", "comment", "a-b"})
    expect_problem(R"("parameters": {")" + name + R"(": 1, "m": 1}, )" + body(R"({"expression": "m"})"),
                   {"/parameters/" + name, "line 2"});
  expect_problem(R"("repeat": [{"index": "t", "count": 1, "nodes": [{"name": "n {t}"}]}])",
                 {"/repeat/0/index", "means something else"});
  expect_problem(R"("parameters": {"i": 1}, "repeat": [{"index": "i", "count": 1, "nodes": [{"name": "n {i}"}]}])",
                 {"/repeat/0/index", "the same name"});
}

TEST(SceneVary, unknown_names_values_that_are_not_finite_and_t_are_refused_where_they_stand) {
  const std::string parameters = R"("parameters": {"length": 2, "zero": 0}, "title": "{length} {zero}", )";
  expect_problem(parameters + body(R"({"expression": "2*lenght"})"),
                 {"/bodies/0/mass/expression", "lenght", "did you mean \"length\"?", "line 2"});
  expect_problem(parameters + body(R"({"expression": "1/zero"})"), {"gives inf", "/bodies/0/mass"});
  expect_problem(R"("parameters": {"zero": 0, "x": {"expression": "0/zero"}}, )" + body(R"({"expression": "x"})"),
                 {"gives nan", "/parameters/x"});
  expect_problem(R"("parameters": {"x": {"expression": "lost"}, "y": {"expression": "2*x"}}, )" +
                     body(R"({"expression": "x + y"})"),
                 {"lost", "/parameters/x"});  // once, not where it is needed
  expect_problem(body(R"({"expression": "1 + t"})"), {"t stands in laws", "\"t\""});
  expect_problem(body(R"({"expression": "1 +"})"), {"/bodies/0/mass/expression", "expected a number"});
  expect_problem(body(R"({"expression": 1})"), {"a string, not a number"});
  expect_problem(body(R"({"expression": "1", "unit": "kg"})"), {"/bodies/0/mass/unit", "not known"});
  expect_problem(body(R"({"expression": "-1"})"), {"= -1", "at least 0"});
  expect_problem(R"("parameters": {"x": "2"}, )" + body(R"({"expression": "x"})"), {"/parameters/x", "a number"});
  expect_problem(R"("parameters": [1], )" + body("1"), {"/parameters", "an object"});
}

TEST(SceneVary, counts_are_within_1e_9_of_a_whole_number) {
  const std::string nodes = R"("sections": [{"name": "s", "stiffness": [1, 1, 1, 1, 1, 1], "mass": [1, 1, 1, 1, 1, 1]}],
      "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
      "beams": [{"name": "c", "section": "s", "start": "a", "end": "b", "elements": {"expression": ")";
  const SceneFile file = read_scene_text(scene_of(nodes + "0.3/0.1\"}}]"), "s");  // 2.9999999999999996
  ASSERT_TRUE(file.ok()) << texts(file.problems);
  EXPECT_EQ(file.scene.beams.at(0).elements, 3);
  for (const std::string bad : {"2.5", "3 + 2e-9", "1e-10"})
    expect_problem(nodes + bad + "\"}}]", {"/beams/0/elements", "a whole number"});
  expect_problem(R"("repeat": [{"index": "i", "count": {"expression": "5/2"}, "nodes": [{"name": "n {i}"}]}])",
                 {"/repeat/0/count", "gives 2.5", "a whole number"});
  expect_problem(R"("parameters": {"x": 0.5}, "nodes": [{"name": "n {x}"}])", {"/nodes/0/name", "no whole number"});
}

TEST(SceneVary, laws_keep_t_and_take_parameters) {
  const SceneFile file = read_scene_text(scene_of(R"x("parameters": {"A": -3, "w": 2},
                   "loads": [{"at": "a", "force": [1, 0, 0], "law": {"expression": "A*sin(w*t)"}}], )x" +
                                                  body("1")),
                                         "s");
  ASSERT_TRUE(file.ok()) << texts(file.problems);
  EXPECT_EQ(file.scene.point_loads.at(0).law.at(0.7).value, -3.0 * std::sin(2.0 * 0.7));
}

const char* const chain = R"(
  "parameters": {"N": 3, "l": 0.5},
  "repeat": [
    {"index": "i", "first": 1, "count": {"expression": "N"},
     "bodies": [{"name": "rod {i}", "mass": 1, "shape": {"kind": "rod", "length": {"expression": "l"}},
                 "position": [{"expression": "i*l"}, 0, 0]}]},
    {"index": "i", "first": 1, "count": {"expression": "N - 1"},
     "joints": [{"name": "hinge {i}", "kind": "spherical", "first": "rod {i}", "second": "rod {i+1}",
                 "position": [{"expression": "(i + 1/2)*l"}, 0, 0]}]}],
  "joints": [{"name": "hinge 0", "kind": "spherical", "first": "ground", "second": "rod 1", "position": [0, 0, 0]}])";

TEST(SceneVary, copies_are_the_scene_written_out_by_hand) {
  const std::string hand = R"(
  "bodies": [
    {"name": "rod 1", "mass": 1, "shape": {"kind": "rod", "length": 0.5}, "position": [0.5, 0, 0]},
    {"name": "rod 2", "mass": 1, "shape": {"kind": "rod", "length": 0.5}, "position": [1, 0, 0]},
    {"name": "rod 3", "mass": 1, "shape": {"kind": "rod", "length": 0.5}, "position": [1.5, 0, 0]}],
  "joints": [
    {"name": "hinge 0", "kind": "spherical", "first": "ground", "second": "rod 1", "position": [0, 0, 0]},
    {"name": "hinge 1", "kind": "spherical", "first": "rod 1", "second": "rod 2", "position": [0.75, 0, 0]},
    {"name": "hinge 2", "kind": "spherical", "first": "rod 2", "second": "rod 3", "position": [1.25, 0, 0]}])";
  ASSERT_FALSE(canonical_scene(scene_of(hand), {}).empty());
  EXPECT_EQ(canonical_scene(scene_of(chain), {}), canonical_scene(scene_of(hand), {}));
}

TEST(SceneVary, nested_copies_know_the_indices_around_them) {
  const SceneFile file = read_scene_text(scene_of(R"("repeat": [{"index": "i", "count": 3, "repeat": [
      {"index": "j", "first": 1, "count": {"expression": "i"}, "bodies": [
      {"name": "{i},{j}", "kind": "point_mass", "mass": 1}]}]}])"),
                                         "s");
  ASSERT_TRUE(file.ok()) << texts(file.problems);
  std::string names;
  for (const scene::Body& n : file.scene.bodies) names += n.name + " ";
  EXPECT_EQ(names, "1,1 2,1 2,2 ");
}

// Formulas of signals in copies name other signals by braces, as those outside do; the index itself is a number.
TEST(SceneVary, formulas_of_copied_signals_have_braces_in_names) {
  const SceneFile file = read_scene_text(scene_of(R"("parameters": {"k": 3},
      "bodies": [{"name": "b", "kind": "point_mass", "mass": 1}], "repeat": [{"index": "i", "count": 2,
      "signals": [{"name": "x_{i}", "kind": "time", "law": {"expression": "i*t"}},
        {"name": "y_{i}", "kind": "formula", "expression": "k*x_{i} + x_{1-i} + i"},
        {"name": "z_{i}", "kind": "state", "expression": "y_{i} - z_{i}"}]}])"),
                                         "s");
  ASSERT_TRUE(file.ok()) << texts(file.problems);
  ASSERT_EQ(file.scene.signals.size(), 6u);
  for (const scene::Signal& s : file.scene.signals) {
    if (s.name == "y_1") {
      EXPECT_EQ(s.inputs, (std::vector<std::string>{"x_1", "x_0"}));
      EXPECT_EQ(s.formula(std::vector<double>{10.0, 5.0}), 36.0);
    }
    if (s.name == "z_0") EXPECT_EQ(s.inputs, (std::vector<std::string>{"y_0", "z_0"}));
  }
}

TEST(SceneVary, problems_name_the_line_of_the_source_and_the_copy) {
  const std::string text = replaced(scene_of(chain), "\"mass\": 1", R"("mass": {"expression": "2 - i"})");
  const SceneFile file = read_scene_text(text, "s");
  ASSERT_EQ(file.problems.size(), 1u) << texts(file.problems);
  const Problem& p = file.problems[0];
  EXPECT_EQ(p.pointer, "/repeat/0/bodies/0/mass");
  EXPECT_EQ(p.instance, "i = 3");
  EXPECT_EQ(p.line, 6);
  EXPECT_NE(p.text().find("rod 3"), std::string::npos) << p.text();
  EXPECT_NE(p.text().find("= -1"), std::string::npos) << p.text();
}

TEST(SceneVary, the_same_fault_in_many_copies_is_one_problem) {
  const std::vector<std::string> many = {"/parameters/N=1000"};
  const struct {
    std::string from, to, pointer, word;
  } cases[] = {{"\"mass\": 1", "\"mass\": -1", "/repeat/0/bodies/0/mass", "999 more copies"},
               {"\"mass\": 1", "\"mas\": 1", "/repeat/0/bodies/0", "999 more copies"},
               {"rod {i+1}", "rod {i+k}", "/repeat/1/joints/0/second", "998 more copies"},
               {"\"spherical\", \"first\": \"rod {i}\"", "\"spherical\", \"first\": \"rd {i}\"", "/repeat/1/joints/0",
                "more copies"}};
  for (const auto& c : cases) {
    const SceneFile file = read_scene_text(replaced(scene_of(chain), c.from, c.to), "s", many);
    ASSERT_FALSE(file.ok()) << c.to;
    EXPECT_LT(file.problems.size(), 3u) << texts(file.problems);
    EXPECT_EQ(file.problems[0].pointer.find(c.pointer), 0u) << texts(file.problems);
    EXPECT_NE(texts(file.problems).find(c.word), std::string::npos) << c.to << "\n" << texts(file.problems);
  }
}

TEST(SceneVary, limits_are_checked_before_anything_is_copied) {
  const std::string cases[] = {
      R"("repeat": [{"index": "i", "count": 2000000, "nodes": [{"name": "{i}"}]}])",
      R"("repeat": [{"index": "i", "count": 2000000}, {"index": "i", "count": 2000000}])",
      R"("repeat": [{"index": "i", "count": 1999999, "repeat": [{"index": "j", "count": {"expression": "i"}}]}])",
      R"("repeat": [{"index": "a", "count": 2000000, "repeat": [{"index": "b", "count": 2000000, "repeat": [
         {"index": "c", "count": 2000000, "nodes": [{"name": "{a} {b} {c}"}]}]}]}])",
      R"("repeat": [{"index": "i", "count": 100000, "nodes": [{"name": "{i}", "comment": ")" + std::string(1000, 'x') +
          R"("}]}])"};
  for (const std::string& text : cases) {
    const std::clock_t start = std::clock();
    expect_problem(text, {"/repeat/", "more than"});
    const double taken = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_LT(taken, 20.0) << text.substr(0, 80);  // two are walks over millions of empty copies
  }
  expect_problem(R"("repeat": [{"index": "i", "count": 1e9}])", {"/repeat/0/count", "at most 2e+06"});
  expect_problem(R"("repeat": [{"index": "i", "count": -1}])", {"/repeat/0/count", "at least 0"});
}

TEST(SceneVary, no_copies_and_empty_parts_are_nothing) {
  for (const std::string& text :
       std::vector<std::string>{R"("repeat": [])", R"("repeat": [{"index": "i", "count": 0, "nodes": [{"nome": 1}]}])",
                                R"("repeat": [{"index": "i", "count": 5}])", R"("parameters": {})"}) {
    const SceneFile file = read_scene_text(scene_of(text + ", " + body("1")), "s");
    EXPECT_TRUE(file.ok()) << text << "\n" << texts(file.problems);
    EXPECT_TRUE(file.scene.nodes.empty());
  }
}

TEST(SceneVary, braces_are_formulas_only_in_scenes_that_vary) {
  EXPECT_EQ(read_scene_text(scene_of(R"("nodes": [{"name": "a {i}"}])"), "s").scene.nodes.at(0).name, "a {i}");
  const SceneFile file = read_scene_text(scene_of(R"("parameters": {"N": 2}, "bodies": [{"name": "a {{N}} {2*N - 1}",
                   "kind": "point_mass", "mass": 1, "comment": "{not read"}])"),
                                         "s");
  ASSERT_TRUE(file.ok()) << texts(file.problems);
  EXPECT_EQ(file.scene.bodies.at(0).name, "a {N} 3");
  expect_problem(R"("parameters": {"N": 2}, "nodes": [{"name": "a {N"}])", {"/nodes/0/name", "write {{"});
  expect_problem(R"("parameters": {"N": 2}, "title": "{N}", "nodes": [{"name": "a {1 +}"}])",
                 {"/nodes/0/name", "{1 +}"});
}

TEST(SceneVary, overrides_change_the_source_before_it_is_evaluated) {
  const std::vector<std::string> more = {"/parameters/N=5", "/repeat/0/bodies/rod {i}/mass=7"};
  const SceneFile file = read_scene_text(scene_of(chain), "s", more);
  ASSERT_TRUE(file.ok()) << texts(file.problems);
  ASSERT_EQ(file.scene.bodies.size(), 5u);
  for (const scene::Body& b : file.scene.bodies) EXPECT_EQ(b.mass, 7.0);
  const std::vector<std::string> unknown = {"/parameters/n=5"};
  const SceneFile refused = read_scene_text(scene_of(chain), "s", unknown);
  ASSERT_EQ(refused.problems.size(), 1u);
  EXPECT_NE(refused.problems[0].text().find("no parameter"), std::string::npos) << refused.problems[0].text();
  EXPECT_NE(refused.problems[0].text().find("\"N\""), std::string::npos) << refused.problems[0].text();
}

TEST(SceneVary, a_parameter_without_use_is_told) {
  const SceneFile file =
      read_scene_text(scene_of(R"("parameters": {"m": 1, "k": 2}, )" + body(R"({"expression": "m"})")), "s");
  ASSERT_TRUE(file.ok());
  ASSERT_EQ(file.warnings.size(), 1u);
  EXPECT_EQ(file.warnings[0].pointer, "/parameters/k");
}

TEST(SceneVary, what_is_expanded_reads_back_as_the_same_scene) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data" / "scenarios")) {
    if (entry.path().extension() != ".json") continue;
    const ExpandedScene expanded = expanded_scene(entry.path());
    ASSERT_TRUE(expanded.ok()) << entry.path() << texts(expanded.problems);
    EXPECT_EQ(canonical_scene(expanded.text, {}), canonical_scene(read_text(entry.path()), {})) << entry.path();
    EXPECT_EQ(expanded.text.find("\"expression\": \"(N"), std::string::npos);
    EXPECT_EQ(expanded.text.find("\"repeat\""), std::string::npos) << entry.path();
    EXPECT_EQ(expanded_scene_text(expanded.text).text, expanded.text) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 30);
}

/// Pieces of scenes that vary, put together at random: every text is dealt with in words.
TEST(SceneVary, hostile_texts_are_dealt_with_in_words) {
  const std::vector<std::string> pieces = {"{",  "}",   "{{", "}}", "{i}", "{i+1}",   "{N}",           "i",
                                           "N",  "a",   "(",  ")",  "+",   "-1",      "1e308",         "1e-308",
                                           "/0", "^",   "t",  "pi", "e",   "sin(",    "min(1,",        "\\\"",
                                           " ",  "i*N", "9",  ".",  "_",   "\\u0000", "\\ud83d\\ude00"};
  const ::bough::test::Untrapped untrapped;  // laws as 1/0
  std::mt19937 random(28);
  const auto integer = [&](int low, int high) {
    return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
  };
  const auto piece = [&] { return pieces[random() % pieces.size()]; };
  int good = 0;
  for (int k = 0; k < 4000; ++k) {
    const auto text = [&] {
      std::string s;
      if (integer(0, 2) > 0) return std::string("j");
      for (int n = integer(0, 5); n > 0; --n) s += piece();
      return s;
    };
    const auto number = [&] {
      return integer(0, 3) > 0 ? std::to_string(integer(-1, 40) / 10) : R"({"expression": ")" + text() + "\"}";
    };
    const std::string members = R"("parameters": {"N": )" + number() + R"(, "a": )" + number() + R"(, "b": )" +
                                number() + R"(}, "repeat": [{"index": "i", "count": )" + number() + R"(, "first": )" +
                                number() + R"(, "bodies": [{"kind": "point_mass", "mass": 1, "name": "n )" + text() +
                                R"(", "position": [)" + number() +
                                R"(, 0, 0]}],
        "repeat": [{"index": ")" +
                                text() + R"(", "count": )" + number() +
                                R"(, "loads": [{"at": "n {i}", "law": {"expression": ")" + text() + R"("}}]}]}])";
    const SceneFile file = read_scene_text(scene_of(members), "s");
    good += file.ok() ? 1 : 0;
    for (const Problem& p : file.problems) EXPECT_FALSE(p.rule.empty()) << members;
    EXPECT_EQ(expanded_scene_text(scene_of(members)).ok(), file.ok()) << members;
  }
  EXPECT_GT(good, 10);
  EXPECT_LT(good, 3980);
}

}  // namespace
}  // namespace bough::io
