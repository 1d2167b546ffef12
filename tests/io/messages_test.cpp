// What a message shows beside its rule: code, excerpt, second place, and the changes that are sure.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "bough/io/fault_codes.hpp"
#include "bough/io/fix_scene.hpp"
#include "bough/io/schema_words.hpp"
#include "scene_base.hpp"
#include "scene_table_cases.hpp"
#include "support/source_dir.hpp"

namespace bough::io {
namespace {

Problem only_problem(const std::string& text) {
  const SceneFile file = read_scene_text(text, "scene");
  EXPECT_EQ(file.problems.size(), 1u) << text;
  return file.problems.empty() ? Problem{} : file.problems.front();
}

Problem problem_of(const std::string& from, const std::string& to) {
  const std::string text = test::spoilt(from, to);
  EXPECT_FALSE(text.empty()) << from;
  return only_problem(text);
}

TEST(Messages, each_rule_has_its_code) {
  const struct {
    const char *from, *to, *code;
  } cases[] = {{"\"title\": \"base\"", "\"titel\": \"base\"", "unknown-key"},
               {"\"width\": 0.02, ", "", "missing-key"},
               {"\"width\": 0.02", "\"width\": -0.02", "out-of-range"},
               {"\"width\": 0.02", "\"width\": \"0.02\"", "not-a-number"},
               {"\"title\": \"base\"", "\"title\": 7", "wrong-type"},
               {"\"title\": \"base\"", "\"title\": null", "null-value"},
               {"[0, 0, -9.81]", "[0, -9.81]", "wrong-count"},
               {"\"kind\": \"rectangle\"", "\"kind\": \"rectangel\"", "unknown-word"},
               {"\"name\": \"rubber\"", "\"name\": \"ro.ot\"", "bad-name"},
               {"\"name\": \"rubber\"", "\"name\": \"knee\"", "duplicate-name"},
               {"\"section\": \"bar\"", "\"section\": \"baar\"", "unknown-name"},
               {"\"start\": \"root\"", "\"start\": \"bench\"", "wrong-reference"},
               {"\"start\": \"root\"", "\"start\": \"ground\"", "wrong-reference"},
               {"\"start\": \"root\", \"end\": \"knee\"", "\"start\": \"root\", \"end\": \"root\"", "geometry"},
               {"[0.1, 0.2, 0.25]", "[0.1, 0.2, 0.35]", "impossible-mass"},
               {"\"mass\": 2, ", "\"mass\": 2, \"mass\": 3, ", "duplicate-key"},
               {"\"young\": 2.1e11,", "\"young\": 2.1e11, \"shear\": 1,", "missing-key"},
               {"\"stiffness\": 10 }", "\"stiffness\": 1e-400 }", "not-computable"},
               {"\"name\": \"bench\", ", "\"name\": \"bench\", \"frame\": \"bench\", ", "circle"},
               {"\"stiffness\": 10 }", "\"stiffness\": { \"expression\": \"2*\" } }", "bad-formula"},
               {"\"title\": \"base\",", "\"title\": \"base\"", "not-json"}};
  for (const auto& c : cases) EXPECT_EQ(problem_of(c.from, c.to).code, c.code) << c.to;
}

TEST(Messages, every_fault_of_the_table_has_a_code_that_is_listed) {
  std::set<std::string_view> codes;
  for (const FaultCode& code : fault_codes()) EXPECT_TRUE(codes.insert(code.code).second) << code.code << " twice";
  for (const test::Bad& bad : test::table_cases) {
    std::string text = test::spoilt(bad.from, bad.to);
    text.erase(std::remove(text.begin(), text.end(), '@'), text.end());
    for (const Problem& p : read_scene_text(text, "scene").problems) {
      EXPECT_TRUE(codes.count(p.code) > 0) << p.code;
      EXPECT_NE(p.code, "contradiction") << p.text();
    }
  }
}

TEST(Messages, the_manual_has_a_section_of_each_code) {
  std::ifstream in(support::source_dir() / "data/manual/guides/messages.md");
  std::set<std::string> sections;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("## ")) sections.insert(line.substr(3));
  for (const FaultCode& code : fault_codes())
    EXPECT_EQ(sections.count(std::string(code.code)), 1u) << code.code << " has no section";
}

TEST(Messages, the_mark_stands_below_the_value) {
  const Problem p = problem_of("\"section\": \"bar\"", "\"section\": \"baar\"");
  EXPECT_EQ(p.excerpt.line, p.line);
  EXPECT_EQ(p.excerpt.text.substr(p.excerpt.before, p.excerpt.marked), "\"baar\"");
  const std::string text = p.long_text();
  EXPECT_NE(text.find(" [unknown-name]\n"), std::string::npos) << text;
  EXPECT_NE(text.find("^^^^^^\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n  help: did you mean \"bar\"?\n"), std::string::npos) << text;
}

TEST(Messages, marks_count_characters_and_end_with_the_line) {
  // Characters of two and three bytes and tabs before the place, lines that end in CR LF, and a value over two lines.
  const Problem p = only_problem(
      "{\"schema_version\": 1,\r\n\t\"comment\": \"\xC3\xA4 \xE2\x82\xAC\", \"gravity\": [0,\r\n 0], "
      "\"bodies\": [{\"name\": \"a\", \"kind\": \"point_mass\", \"mass\": 1}], \"analysis\": {\"kind\": \"dynamic\", "
      "\"end_time\": 1, \"step_size\": 0.1}}");
  EXPECT_EQ(p.code, "wrong-count");
  EXPECT_EQ(p.line, 2);
  EXPECT_EQ(p.column, 31);
  EXPECT_EQ(p.excerpt.before + 1, 31u);
  EXPECT_EQ(p.excerpt.marked, 3u) << p.long_text();  // "[0," of this line
  EXPECT_EQ(p.excerpt.text.find('\r'), std::string::npos);
}

TEST(Messages, long_lines_are_cut_on_both_sides) {
  std::string text = test::spoilt("\"elements\": 4", "\"elements\": \"four\"");
  std::replace(text.begin(), text.end(), '\n', ' ');
  const Problem p = only_problem(text);
  EXPECT_LT(p.excerpt.text.size(), 200u);
  EXPECT_EQ(p.excerpt.text.substr(p.excerpt.before, p.excerpt.marked), "\"four\"");
  EXPECT_TRUE(p.excerpt.text.starts_with("...") && p.excerpt.text.ends_with("..."));
}

TEST(Messages, a_second_place_shows_what_one_needs_to_see) {
  const Problem twice = problem_of("\"name\": \"rubber\"", "\"name\": \"knee\"");
  EXPECT_EQ(twice.second_about, "defined first here");
  EXPECT_EQ(twice.second.text.substr(twice.second.before, twice.second.marked), "\"knee\"");
  EXPECT_LT(twice.second.line, twice.line);
  const Problem kind = problem_of("\"start\": \"root\"", "\"start\": \"bench\"");
  EXPECT_EQ(kind.second_about, "defined here, in \"frames\"");
  const Problem near = problem_of("\"section\": \"bar\"", "\"section\": \"baar\"");
  EXPECT_EQ(near.second_about, "a near name is defined here");
  EXPECT_EQ(near.second.text.substr(near.second.before, near.second.marked), "\"bar\"");
  const Problem key = problem_of("\"mass\": 2, ", "\"mass\": 2, \"mass\": 3, ");
  EXPECT_EQ(key.second_about, "given first here");
}

TEST(Messages, what_is_sure_hides_no_other_fault) {
  // A misspelt key, kind or number in quotes, and a name that nothing has, in one part and in one pass.
  const struct {
    const char *good, *bad;
    std::vector<const char*> codes;
  } cases[] = {
      {"\"section\": \"bar\", \"start\": \"root\", \"end\": \"knee\", \"axis_2\": [0, 1, 0], \"elements\": 4",
       "\"section\": \"bar\", \"start\": \"nobody\", \"end\": \"knee\", \"axis_2\": [0, 1, 0], \"elemnts\": \"4\"",
       {"unknown-name", "unknown-key", "not-a-number"}},
      {"\"kind\": \"prismatic\", \"first\": \"ground\", \"second\": \"cart\"",
       "\"kind\": \"prismtic\", \"first\": \"ground\", \"second\": \"nobody\"",
       {"unknown-word", "unknown-name"}},
      {"\"analysis\": { \"kind\": \"dynamic\", \"end_time\": 1",
       "\"anaylsis\": { \"kind\": \"dynamic\", \"end_time\": -1",
       {"unknown-key", "out-of-range"}},
      {"\"stiffness\": 10 }", "\"stiffness\": \"-10\" }", {"not-a-number", "out-of-range"}}};
  for (const auto& c : cases) {
    const std::string text = test::spoilt(c.good, c.bad);
    ASSERT_FALSE(text.empty()) << c.good;
    const SceneFile file = read_scene_text(text, "scene");
    std::vector<std::string> codes;
    for (const Problem& p : file.problems) codes.push_back(p.code);
    EXPECT_EQ(codes, std::vector<std::string>(c.codes.begin(), c.codes.end())) << c.bad;
  }
}

TEST(Fixes, what_is_sure_is_changed_and_nothing_else) {
  const struct {
    const char *good, *bad;
  } cases[] = {{"\"section\": \"bar\"", "\"section\": \"baar\""},
               {"\"section\": \"bar\"", "\"section\": \"Bar\""},
               {"\"second\": \"cart\", \"position\"", "\"second\": \"crat\", \"position\""},
               {"\"title\": \"base\"", "\"titel\": \"base\""},
               {"\"kind\": \"rectangle\"", "\"kind\": \"rectangel\""},
               {"\"kind\": \"prismatic\"", "\"kind\": \"prismtic\""},
               {"\"elements\": 4", "\"elemnts\": 4"},
               {"\"width\": 0.02", "\"width\": \"0.02\""},
               {"\"stride\": 2 }", "\"stride\": 2, }"},
               {"\"tolerance\": 5 } ]", "\"tolerance\": 5 }, ]"},
               {"\"poisson\": 0.3", "\"poisson\": +0.3"},
               {"\"poisson\": 0.3", "\"poisson\": .3"}};
  for (const auto& c : cases) {
    const std::string bad = test::spoilt(c.good, c.bad);
    ASSERT_FALSE(bad.empty()) << c.good;
    const FixedScene fixed = fixed_scene(bad, {});
    EXPECT_EQ(fixed.text, test::base_scene()) << c.bad;
    EXPECT_TRUE(fixed.file.ok()) << c.bad;
    EXPECT_EQ(fixed.done.size(), 1u) << c.bad;
    EXPECT_EQ(fixed_scene(fixed.text, {}).text, fixed.text) << "not idempotent: " << c.bad;
  }
}

TEST(Fixes, all_faults_are_changed_at_once_and_those_behind_them) {
  std::string bad = test::base_scene();
  for (const auto& [good, wrong] :
       {std::pair{"\"elements\": 4", "\"elemnts\": \"4\""}, std::pair{"\"stride\": 2 }", "\"stride\": 2, }"},
        std::pair{"\"section\": \"bar\"", "\"section\": \"baar\""}})
    bad.replace(bad.find(good), std::string(good).size(), wrong);
  const FixedScene fixed = fixed_scene(bad, {});
  EXPECT_EQ(fixed.text, test::base_scene());
  EXPECT_EQ(fixed.done.size(), 4u);
}

TEST(Fixes, a_right_file_and_what_is_not_sure_stay_as_they_are) {
  EXPECT_EQ(fixed_scene(test::base_scene(), {}).text, test::base_scene());
  const struct {
    const char *good, *bad;
  } cases[] = {// another thing may be missing
               {"\"start\": \"root\"", "\"start\": \"root2\""},
               {"\"start\": \"root\"", "\"start\": \"roots\""},
               {"\"start\": \"root\"", "\"start\": \"boot\""},
               // two keys are near, or the digits are others
               {"\"EI2\": 20", "\"EI4\": 20"},
               {"\"axis_2\": [0, 1, 0]", "\"axis_1\": [0, 1, 0]"},
               // no number alone
               {"\"width\": 0.02", "\"width\": \"20 mm\""},
               {"\"width\": 0.02", "\"width\": \"0.02 \""},
               {"\"width\": 0.02", "\"width\": -0.02"},
               // the key is given as well
               {"\"mass\": 2, ", "\"mass\": 2, \"amss\": 3, "},
               {"\"title\": \"base\",", "\"title\": \"base\",,"}};
  for (const auto& c : cases) {
    const std::string bad = test::spoilt(c.good, c.bad);
    ASSERT_FALSE(bad.empty()) << c.good;
    EXPECT_FALSE(fixed_scene(bad, {}).file.ok()) << c.bad;
    EXPECT_EQ(fixed_scene(bad, {}).text, bad) << c.bad;
  }
}

TEST(Fixes, ends_of_lines_marks_and_characters_keep_their_bytes) {
  std::string good = test::base_scene();
  for (std::size_t at = 0; (at = good.find('\n', at)) != std::string::npos; at += 2) good.replace(at, 1, "\r\n");
  good.replace(good.find("\"base\""), 6, "\"\xC3\xA4\xE2\x82\xAC \\u00e4\"");
  good.insert(0, "\xEF\xBB\xBF");
  std::string bad = good;
  bad.replace(bad.find("\"section\": \"bar\""), 16, "\"section\": \"baar\"");
  bad.replace(bad.find("\"elements\": 4"), 13, "\"elemnts\": 4");
  const FixedScene fixed = fixed_scene(bad, {});
  EXPECT_TRUE(fixed.file.ok());
  EXPECT_EQ(fixed.text, good);
}

TEST(Fixes, copies_of_a_repeated_part_are_changed_where_they_are_written) {
  const std::string good = R"({"schema_version": 1, "nodes": [{"name": "root"}],
    "repeat": [{"index": "i", "count": 3, "nodes": [{"name": "tip {i}", "position": [{"expression": "1 + i"}, 0, 0]}],
      "springs": [{"name": "s {i}", "first": "root", "second": "tip {i}", "stiffness": 10}]}],
    "analysis": {"kind": "static"}})";
  std::string bad = good;
  bad.replace(bad.find("\"stiffness\""), 11, "\"stifness\"");
  bad.replace(bad.find("\"first\": \"root\""), 15, "\"first\": \"rooot\"");
  EXPECT_EQ(fixed_scene(bad, {}).text, good);
}

TEST(Fixes, the_difference_is_one_that_patch_reads) {
  std::string before, after;
  for (int i = 1; i <= 20; ++i) {
    before += "line " + std::to_string(i) + "\n";
    after += (i == 5 || i == 6 || i == 15 ? "other " : "line ") + std::to_string(i) + "\n";
  }
  const std::string diff = diff_of("a.json", before, after);
  EXPECT_NE(diff.find("@@ -2,8 +2,8 @@\n line 2\n line 3\n line 4\n-line 5\n-line 6\n+other 5\n+other 6\n line 7\n"),
            std::string::npos)
      << diff;
  EXPECT_NE(diff.find("@@ -12,7 +12,7 @@\n line 12\n"), std::string::npos) << diff;
  EXPECT_EQ(diff_of("a.json", before, before), "");
}

TEST(SchemaWords, keys_and_kinds_tell_where_they_stand) {
  const std::vector<SchemaEntry> keys = schema_entries("spectral_radius");
  ASSERT_FALSE(keys.empty());
  EXPECT_NE(keys.front().place.find("spectral_radius"), std::string::npos);
  EXPECT_FALSE(keys.front().about.empty());
  const std::vector<SchemaEntry> kinds = schema_entries("prismatic");
  ASSERT_FALSE(kinds.empty());
  EXPECT_EQ(kinds.front().format, "scene");
  EXPECT_TRUE(schema_entries("no such word").empty());
  for (const std::string& word : schema_words()) EXPECT_FALSE(schema_entries(word).empty()) << word;
  for (const char* const place : {"springs[].damping", "/springs/3/damping"}) {
    ASSERT_EQ(schema_entries(place).size(), 1u) << place;
    EXPECT_EQ(schema_entries(place).front().place, "springs[].damping");
  }
  EXPECT_TRUE(schema_entries("/springs/3/nothing").empty());
}

}  // namespace
}  // namespace bough::io
