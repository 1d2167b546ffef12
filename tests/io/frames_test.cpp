// Chains of frames from JSON, and the split of accelerations as CSV and JSON.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bough/io/json_value.hpp"
#include "bough/io/read_frames.hpp"
#include "bough/io/split_table.hpp"
#include "frames_base.hpp"
#include "support/untrapped.hpp"

namespace bough::io {
namespace {

using test::BadChain;

// Text, names and laws: what only the reader sees.
const BadChain reader_cases[] = {
    {"\"from\": \"car\"", "\"from\": @\"cart\"", "/from", "did you mean \"car\"?"},
    {"\"in\": \"gimbal\"", "\"in\": @\"gimball\"", "/in", "did you mean \"gimbal\"?"},
    {"\"frame\": \"rotor\"", "\"frame\": @\"rotr\"", "/point/frame", "did you mean \"rotor\"?"},
    {"\"name\": \"gimbal\"", "\"name\": @\"car\"", "/frames/1/name", "taken already"},
    {"\"axis\": [0, 0, 2]", "\"axis\": @[0, 0, 0]", "/frames/0/turns/0/axis", "length other than 0"},
    {"{ \"expression\": \"10*t\" }", "{ \"expression\": @\"10*(t\" }", "/frames/0/position/0/expression", "character"},
    {"{ \"expression\": \"10*t\" }", "@{ \"expression\": \"sqrt(t)\" }", "/frames/0/position/0",
     "not finite at t = 0 s: rate is infinite"},
    {"\"angle\": 20,", "\"angle\": @{ \"expression\": \"1/(t-1)\" },", "/frames/2/turns/0/angle", "not finite"},
    {"{ \"expression\": \"0.1*t^2\" }", "@{ \"expression\": \"1/(t-1.5)\" }", "/point/position/2",
     "not finite at t = 1.5"},
    {"\"start\": 0, \"end\": 2", "\"start\": 2, \"end\": @2", "/time/end", "after the start"},
    {"\"title\": \"rotor\",", "\"title\": \"rotor\", @\"title\": \"again\",", "/title", "given before"},
    {"\"angle\": 20,", "\"angle\": @1e999,", "/frames/2/turns/0/angle", "large"},
};

void expect_told(const BadChain& bad) {
  const bough::test::Untrapped untrapped;  // laws with poles
  std::string text = test::spoilt_chain(bad);
  ASSERT_FALSE(text.empty()) << bad.from;
  const std::size_t mark = text.find('@');
  LineColumn place;
  if (mark != std::string::npos) {
    text.erase(mark, 1);
    place = LineIndex(text).at(mark);
  }
  const FrameFile file = read_frames_text(text, "bad");
  ASSERT_FALSE(file.ok()) << bad.to;
  for (const Problem& p : file.problems) {
    if (p.pointer != bad.pointer || p.text().find(bad.rule) == std::string::npos) continue;
    if (mark != std::string::npos) {
      EXPECT_EQ(p.line, place.line) << bad.to;
      EXPECT_EQ(p.column, place.column) << bad.to;
    }
    return;
  }
  ADD_FAILURE() << bad.to << ": not told; the first problem is: " << file.problems.front().text();
}

TEST(ReadFrames, every_fault_is_told_at_its_place) {
  for (const BadChain& bad : test::chain_table_cases) expect_told(bad);
  for (const BadChain& bad : reader_cases) expect_told(bad);
}

TEST(ReadFrames, a_fault_is_told_once) {
  for (const BadChain& bad : test::chain_table_cases) {
    std::string text = test::spoilt_chain(bad);
    std::erase(text, '@');
    const FrameFile file = read_frames_text(text, "bad");
    EXPECT_EQ(file.problems.size(), 1u) << bad.to << ": " << file.problems.back().text();
  }
}

TEST(ReadFrames, all_faults_are_told_in_the_order_of_the_file) {
  std::string text = test::base_chain();
  text.replace(text.find("10*t"), 4, "10*+");
  text.replace(text.find("[1, 0, 0]"), 9, "[0, 0, 0]");
  text.replace(text.find("\"from\": \"car\""), 13, "\"from\": \"nobody\"");
  const FrameFile file = read_frames_text(text, "bad");
  ASSERT_EQ(file.problems.size(), 3u);
  EXPECT_EQ(file.problems[0].pointer, "/frames/0/position/0/expression");
  EXPECT_EQ(file.problems[1].pointer, "/frames/1/turns/0/axis");
  EXPECT_EQ(file.problems[2].pointer, "/from");
}

TEST(ReadFrames, nothing_that_is_no_chain_is_taken_for_one) {
  for (const char* text : {"", "{", "[]", "7", "null", "{}", "{\"schema_version\": 1, \"frames\": []}",
                           "{\"schema_version\": 1, \"frames\": 3, \"point\": 1, \"time\": [], \"from\": \"x\"}"})
    EXPECT_FALSE(read_frames_text(text, "bad").ok()) << text;
  EXPECT_FALSE(read_frames("/nowhere/at/all.json").ok());
  EXPECT_NE(read_frames("/nowhere/at/all.json").problems.at(0).text().find("no such file"), std::string::npos);
}

TEST(ReadFrames, a_good_chain_is_read_as_it_says) {
  const FrameFile file = read_frames_text(test::base_chain(), "chain");
  for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
  const scene::FrameStudy& s = file.study;
  EXPECT_EQ(s.name, "chain");
  EXPECT_EQ(s.title, "rotor");
  ASSERT_EQ(s.frames.size(), 3u);
  EXPECT_EQ(s.point_frame, 3);
  EXPECT_EQ(s.from, 1);
  EXPECT_EQ(s.in, 2);
  EXPECT_EQ(s.num_points, 5);
  EXPECT_EQ(s.end_time, 2.0);
  EXPECT_EQ(s.frames[0].position[0].at(2.0).value, 20.0);
  EXPECT_EQ(s.frames[0].turns[0].axis[2], 1.0);  // made a unit vector
  EXPECT_EQ(s.frames[0].turns[0].angle.at(2.0).value, 1.5);
  EXPECT_NEAR(s.frames[1].rotation(0, 2), std::sin(0.4), 1e-15);
  EXPECT_EQ(s.frames[2].turns[0].angle.at(0.5).value, 10.0);  // a rate, integrated
  EXPECT_EQ(s.frames[2].turns[0].angle.at(0.5).rate, 20.0);
  EXPECT_NEAR(s.point[2].at(2.0).acceleration, 0.2, 1e-15);
}

SplitTable small_table() {
  SplitTable t{.title = "t",
               .abscissa = "time",
               .seen_from = "ground",
               .axes = "a",
               .columns = {Part::razi, Part::total},
               .series = {{{{"spin", 5.0}}, {}}}};
  SplitRow row{.at = 0.5};
  row.parts[static_cast<std::size_t>(Part::razi)] = {{3.0, 0.0, -4.0}};
  row.parts[static_cast<std::size_t>(Part::total)] = {{0.0, 0.1, 0.0}};
  t.series[0].rows = {row};
  return t;
}

TEST(SplitTable, csv_holds_magnitudes_and_tells_series_apart) {
  SplitTable t = small_table();
  EXPECT_EQ(split_csv(t), "time,razi,total\n0.5,5,0.1\n");
  t.series.push_back(t.series[0]);
  t.series[1].parameters[0].second = 2.0;
  EXPECT_EQ(split_csv(t), "spin,time,razi,total\n5,0.5,5,0.1\n2,0.5,5,0.1\n");
}

TEST(SplitTable, json_holds_vectors_observer_and_axes) {
  std::vector<JsonFault> faults;
  const auto root = parse_json(split_json(small_table()), source_file, faults);
  ASSERT_TRUE(root);
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(root->find("seen_from")->text, "ground");
  EXPECT_EQ(root->find("axes")->text, "a");
  const JsonValue& series = root->find("series")->items.at(0);
  EXPECT_EQ(series.find("spin")->number, 5.0);
  EXPECT_EQ(series.find("magnitudes")->find("razi")->items.at(0).number, 5.0);
  EXPECT_EQ(series.find("vectors")->find("razi")->items.at(0).items.at(2).number, -4.0);
}

}  // namespace
}  // namespace bough::io
