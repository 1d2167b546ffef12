// The reader of JSON texts against the grammar of RFC 8259: what has to be taken, what has to be refused, and what
// was decided where the grammar leaves it open.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

#include "bough/io/json_value.hpp"
#include "bough/io/read_scene.hpp"
#include "support/untrapped.hpp"

namespace bough::io {
namespace {

using namespace std::string_literals;

std::optional<JsonValue> parse(const std::string& text, std::vector<JsonFault>& faults) {
  return parse_json(text, source_file, faults);
}

bool accepted(const std::string& text) {
  std::vector<JsonFault> faults;
  const bool read = parse(text, faults).has_value();
  return read && faults.empty();
}

TEST(SceneJson, every_form_of_the_grammar_is_read) {
  const std::string good[] = {"[]",
                              "{}",
                              "0",
                              "-0",
                              "1",
                              "-1.5",
                              "1e3",
                              "1E+3",
                              "1e-3",
                              "1.0e0",
                              "\"\"",
                              "\"a\"",
                              "true",
                              "false",
                              "null",
                              " [ 1 , 2 ] ",
                              "{\"a\":{\"b\":[]}}",
                              "[[],[[]]]",
                              "\"\\\"\\\\\\/\\b\\f\\n\\r\\t\"",
                              "\"\\u0041\"",
                              "\"\\uD834\\uDD1E\"",
                              "\"\xE2\x82\xAC\"",
                              "\"\xF0\x9D\x84\x9E\"",
                              "\t[\n1\r]\n",
                              "{\"\":0}",
                              "{\"a b\":0}",
                              "[1,\n2]",
                              "\"\x7F\"",
                              "123456789012345678901234567890",
                              "0.1",
                              "[-0.0]",
                              "{\"a\":1,\"b\":2}",
                              "\"\\u0000\"",
                              "[true,false,null]",
                              "1.7976931348623157e308",
                              "5e-324",
                              "2.2250738585072014e-308"};
  for (const std::string& text : good) EXPECT_TRUE(accepted(text)) << text;
}

TEST(SceneJson, everything_outside_the_grammar_is_refused) {
  const std::string bad[] = {"",
                             " ",
                             "[",
                             "]",
                             "{",
                             "}",
                             "[1",
                             "[1,",
                             "[1,]",
                             "[,1]",
                             "[1,,2]",
                             "[1 2]",
                             "{\"a\"}",
                             "{\"a\":}",
                             "{\"a\":1,}",
                             "{\"a\" 1}",
                             "{a:1}",
                             "{1:1}",
                             "{'a':1}",
                             "['a']",
                             "[1]]",
                             "{}}",
                             "[1}",
                             "{\"a\":1]",
                             "1 2",
                             "[1] x",
                             "nul",
                             "tru",
                             "True",
                             "NULL",
                             "NaN",
                             "nan",
                             "Infinity",
                             "-Infinity",
                             "inf",
                             "+1",
                             ".5",
                             "5.",
                             "01",
                             "-01",
                             "1e",
                             "1e+",
                             "1.e3",
                             "0x10",
                             "1_000",
                             "--1",
                             "- 1",
                             "1,5",
                             "\"",
                             "\"a",
                             "\"\\x\"",
                             "\"\\u12\"",
                             "\"\\u12G4\"",
                             "\"\n\"",
                             "\"\t\"",
                             "\"\\uD834\"",
                             "\"\\uDD1E\"",
                             "// a\n1",
                             "/* a */ 1",
                             "# a\n1",
                             "[1] // a",
                             "\"\xFF\"",
                             "\"\xC0\x80\"",
                             "\"\xED\xA0\x80\"",
                             "\"\xE2\x82\"",
                             "\"\xF4\x90\x80\x80\"",
                             "\xFF\xFE[\0]\0"s,
                             "\0"s,
                             "[\0]"s,
                             "\"a\0b\""s,
                             "[1\0]"s,
                             "[1]\0"s,
                             "{}\0 and more"s,
                             "\xEF\xBB",
                             "undefined",
                             "[1;2]",
                             "{\"a\"=1}",
                             "\xC2\xA0[]"};
  for (const std::string& text : bad) EXPECT_FALSE(accepted(text)) << shown(text);
}

TEST(SceneJson, open_questions_are_decided) {
  const ::bough::test::Untrapped untrapped;  // the C library's strtod raises overflow
  EXPECT_TRUE(accepted("\xEF\xBB\xBF{}")) << "a byte order mark at the start is skipped";
  EXPECT_FALSE(accepted("{\"a\":1,\"a\":1}")) << "a key is given once";
  EXPECT_FALSE(accepted("1e400")) << "a number too large for a double";
  EXPECT_FALSE(accepted("1e-400")) << "a number that would become 0";
  EXPECT_TRUE(accepted("0e-400")) << "0 is 0 with any exponent";
}

TEST(SceneJson, duplicate_keys_are_all_reported_and_the_first_value_counts) {
  std::vector<JsonFault> faults;
  const auto v = parse(R"({"a":1,"b":{"c":1,"c":[2,{"d":3}]},"a":4})", faults);
  ASSERT_TRUE(v);
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0].pointer, "/b/c");
  EXPECT_EQ(faults[0].offset, 18u);
  EXPECT_EQ(faults[1].pointer, "/a");
  EXPECT_EQ(v->find("a")->number, 1.0);
  EXPECT_EQ(v->items.size(), 2u);
}

TEST(SceneJson, every_value_knows_where_it_stands) {
  const std::string text = "{ \"a\" : [ 10 , -2e1, \"x,:\\\"\" ] ,\n  \"b\": {\"c\" :true} }";
  std::vector<JsonFault> faults;
  const auto v = parse(text, faults);
  ASSERT_TRUE(v);
  const auto piece = [&](const JsonValue& x) { return text.substr(x.offset, x.length); };
  EXPECT_EQ(piece(*v), text);
  EXPECT_EQ(piece(*v->find("a")), "[ 10 , -2e1, \"x,:\\\"\" ]");
  EXPECT_EQ(piece(v->find("a")->items[0]), "10");
  EXPECT_EQ(piece(v->find("a")->items[1]), "-2e1");
  EXPECT_EQ(piece(v->find("a")->items[2]), "\"x,:\\\"\"");
  EXPECT_EQ(piece(*v->find("b")->find("c")), "true");
  EXPECT_EQ(text.substr(v->find("b")->find("c")->key_offset, 3), "\"c\"");
}

TEST(SceneJson, columns_count_characters_and_a_byte_order_mark_is_none) {
  const std::string text = "\xEF\xBB\xBF[\"\xE2\x82\xAC\xE2\x82\xAC\", 1]\n[2]";
  LineIndex lines(text);
  EXPECT_EQ(lines.at(text.find('[')).column, 1);
  EXPECT_EQ(lines.at(text.find('1')).column, 8);
  EXPECT_EQ(lines.at(text.find('2')).line, 2);
  EXPECT_EQ(lines.at(text.find('2')).column, 2);
}

TEST(SceneJson, faults_of_the_text_name_the_place_and_the_remedy) {
  const ::bough::test::Untrapped untrapped;  // 1e400
  const struct {
    std::string text;
    int line, column;
    std::string pointer, message;
  } cases[] = {{"{\"a\": [1, 2,]}", 1, 13, "/a/2", "remove the comma"},
               {"{\"a\": NaN}", 1, 7, "/a", "numbers are finite"},
               {"{\n  \"a\": 1\n  \"b\": 2\n}", 3, 3, "", "a comma may be missing"},
               {"{\n // note\n}", 2, 2, "", "comment"},
               {"{'a': 1}", 1, 2, "", "double quotes"},
               {"{\"a\": .5}", 1, 7, "/a", "0.5"},
               {"{\"a\": 007}", 1, 8, "", "leading zeros"},
               {"{\"a\": 1e400}", 1, 7, "/a", "too large"},
               {"{\"a\": [1, 2", 1, 12, "/a", "ends too early"},
               {"{\"a\": True}", 1, 7, "/a", "true or false"}};
  for (const auto& c : cases) {
    const SceneFile file = read_scene_text(c.text, "text");
    ASSERT_EQ(file.problems.size(), 1u) << c.text;
    const Problem& p = file.problems[0];
    EXPECT_EQ(p.line, c.line) << p.text();
    EXPECT_EQ(p.column, c.column) << p.text();
    EXPECT_NE(p.text().find(c.message), std::string::npos) << p.text();
    EXPECT_EQ(p.pointer.substr(0, c.pointer.size()), c.pointer) << p.text();
  }
}

TEST(SceneJson, texts_in_other_encodings_are_told_as_such) {
  const struct {
    std::string text, message;
    int column;
  } cases[] = {{"\xFF\xFE{\0}\0"s, "is UTF-16; save the file as UTF-8", 1},
               {"{\0}\0"s, "is UTF-16", 1},
               {"\0{\0}"s, "is UTF-16", 1},
               {"\xFF\xFE\0\0{\0\0\0"s, "is UTF-32", 1},
               {"{\0\0\0}\0\0\0"s, "is UTF-32", 1},
               {"\0\0\0{\0\0\0}"s, "is UTF-32", 1},
               {"{\0}"s, "holds a zero byte", 2},
               {"{\"title\": \"Gr\xF6\xDF"
                "e\"}",
                "the byte \\xf6 is not UTF-8; save the file as UTF-8", 14}};
  for (const auto& c : cases) {
    const SceneFile file = read_scene_text(c.text, "text");
    ASSERT_EQ(file.problems.size(), 1u);
    EXPECT_NE(file.problems[0].text().find(c.message), std::string::npos) << file.problems[0].text();
    EXPECT_EQ(file.problems[0].column, c.column) << file.problems[0].text();
  }
}

TEST(SceneJson, nesting_is_limited_and_deep_texts_are_refused_at_once) {
  const auto nested = [](std::size_t n) { return std::string(n, '[') + std::string(n, ']'); };
  EXPECT_TRUE(accepted(nested(max_json_depth)));
  EXPECT_FALSE(accepted(nested(max_json_depth + 1)));
  EXPECT_FALSE(accepted(std::string(1'000'000, '[')));
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"a\":";
  EXPECT_FALSE(accepted(objects));
}

TEST(SceneJson, large_objects_and_long_strings_take_linear_time) {
  const auto cpu_of = [](int size) {
    std::string many = "{";
    for (int i = 0; i < size; ++i) many += (i == 0 ? "\"" : ",\"") + std::to_string(i) + "\":0";
    many += "}";
    const auto length = static_cast<std::size_t>(50 * size);
    const std::clock_t start = std::clock();
    EXPECT_FALSE(read_scene_text(many, "many").ok());
    EXPECT_FALSE(
        read_scene_text("{\"" + std::string(length, 'a') + "\": \"" + std::string(length, 'b') + "\"}", "long").ok());
    return static_cast<double>(std::clock() - start);
  };
  constexpr int times = 16;
  EXPECT_LT(cpu_of(times * 4000), 4.0 * times * cpu_of(4000)) << "quadratic work would take 256 times as long";
}

TEST(SceneJson, a_file_that_is_not_there_or_no_file_is_a_problem_not_a_crash) {
  EXPECT_NE(read_scene("/nonexistent/scene.json").problems.at(0).rule.find("no such file"), std::string::npos);
  EXPECT_NE(read_scene("/").problems.at(0).rule.find("directory"), std::string::npos);
}

TEST(SceneJson, pointers_split_into_what_they_were_made_of) {
  EXPECT_EQ(pointer_to("/a", "b/c~d"), "/a/b~1c~0d");
  EXPECT_EQ(split_pointer("/a/b~1c~0d"), (std::vector<std::string>{"a", "b/c~d"}));
  EXPECT_EQ(split_pointer("a"), std::nullopt);
  EXPECT_EQ(split_pointer("/a~2"), std::nullopt);
}

}  // namespace
}  // namespace bough::io
