// One motion from numbers and JSON, and everything about it as a table and as JSON.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bough/io/json_value.hpp"
#include "bough/io/motion_report.hpp"
#include "bough/io/read_motion.hpp"
#include "support/untrapped.hpp"

namespace bough::io {
namespace {

constexpr double quarter = 0.5 * std::numbers::pi;

JsonValue parsed(const std::string& text) {
  std::vector<JsonFault> faults;
  const auto root = parse_json(text, source_file, faults);
  EXPECT_TRUE(root.has_value());
  EXPECT_TRUE(faults.empty());
  return root.value_or(JsonValue{});
}
std::vector<double> numbers_of(const JsonValue* v) {
  std::vector<double> r;
  if (v == nullptr) return r;
  for (const JsonValue& x : v->items)
    if (x.is(JsonKind::number))
      r.push_back(x.number);
    else
      for (const double y : numbers_of(&x)) r.push_back(y);
  return r;
}

TEST(ReadPose, takes_three_six_and_seven_numbers) {
  motion::Frame<double> a, b, c;
  EXPECT_EQ(read_pose(std::vector<double>{1, 2, 3}, a), "");
  EXPECT_EQ(a.x[2], 3.0);
  EXPECT_EQ(a.R(0, 0), 1.0);
  EXPECT_EQ(read_pose(std::vector<double>{1, 2, 3, 0, 0, quarter}, b), "");
  EXPECT_EQ(read_pose(std::vector<double>{1, 2, 3, std::sqrt(0.5), 0, 0, std::sqrt(0.5)}, c), "");
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(b.R.m[k], c.R.m[k], 1e-15);
  EXPECT_NEAR(b.R(1, 0), 1.0, 1e-15);
}

TEST(ReadPose, says_what_is_wrong) {
  const bough::test::Untrapped untrapped;
  motion::Frame<double> pose;
  EXPECT_NE(read_pose(std::vector<double>{1, 2, 3, 4}, pose).find("not 4"), std::string::npos);
  EXPECT_NE(read_pose(std::vector<double>{1, 2, 3, 1, 1, 0, 0}, pose).find("length 1"), std::string::npos);
  EXPECT_NE(read_pose(std::vector<double>{1, 2, 3, NAN, 0, 0, 0}, pose).find("length 1"), std::string::npos);
  EXPECT_NE(read_pose(std::vector<double>{1, 2, 1e200}, pose), "");
  EXPECT_NE(read_pose(std::vector<double>{NAN, 2, 3}, pose), "");
  EXPECT_NE(read_pose(std::vector<double>{1, 2, 3, 1e200, 0, 0}, pose), "");
}

TEST(ReadMotion, reads_poses_as_scenes_do) {
  const MotionFile file = read_motion_text(R"({"schema_version": 1, "seen_from": "first",
    "from": {"position": [0, 1, 0], "rotation": {"rotation_vector": [0, 0, 1]}},
    "to": {"rotation": {"axes": {"1": [0, 1, 0], "2": [-1, 0, 0]}}}})");
  for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
  ASSERT_TRUE(file.input.from);
  EXPECT_EQ(file.input.from->x[1], 1.0);
  EXPECT_NEAR(file.input.from->R(1, 0), std::sin(1.0), 1e-15);
  EXPECT_EQ(file.input.to.R(1, 0), 1.0);
  EXPECT_EQ(file.input.seen_from, motion::SeenFrom::first);
}

TEST(ReadMotion, tells_all_faults_at_their_places) {
  const bough::test::Untrapped untrapped;
  const MotionFile file = read_motion_text(
      "{\"schema_version\": 1,\n\"from\": {\"position\": [0, 1e101, 0]},\n"
      "\"to\": {\"rotation\": {\"quaternion\": [2, 0, 0, 0]}},\n"
      "\"seen_form\": \"first\"}");
  ASSERT_EQ(file.problems.size(), 3u);
  EXPECT_EQ(file.problems[0].pointer, "/from");
  EXPECT_EQ(file.problems[0].line, 2);
  EXPECT_EQ(file.problems[1].pointer, "/to/rotation/quaternion");
  EXPECT_EQ(file.problems[1].line, 3);
  EXPECT_EQ(file.problems[2].pointer, "/seen_form");
  EXPECT_NE(file.problems[2].text().find("did you mean \"seen_from\"?"), std::string::npos);
  for (const char* text : {"", "[]", "{}", "{\"schema_version\": 1}", "{\"schema_version\": 1, \"to\": []}",
                           "{\"schema_version\": 1, \"to\": {\"rotation\": {\"rotation_vector\": [1e200, 0, 0]}}}"})
    EXPECT_FALSE(read_motion_text(text).ok()) << text;
}

TEST(MotionReport, json_holds_the_report_to_the_last_bit) {
  motion::Frame<double> H;
  ASSERT_EQ(read_pose(std::vector<double>{1.1, -0.3, 0.7, 0.4, 0.9, -1.2}, H), "");
  const motion::MotionReport r = describe({.from = std::nullopt, .to = H});
  const JsonValue root = parsed(motion_json(r));
  const auto same = [](const std::vector<double>& read, const double* given) {
    EXPECT_FALSE(read.empty());
    for (std::size_t k = 0; k < read.size(); ++k) EXPECT_EQ(read[k], given[k]) << k;
  };
  same(numbers_of(root.find("displacement")), r.motion.x.v);
  same(numbers_of(root.find("rotation")->find("matrix")), r.motion.R.m);
  same(numbers_of(root.find("rotation")->find("rotation_vector")), r.rotation_vector.v);
  same(numbers_of(root.find("screw")->find("axis_line")), r.axis_line->v);
  EXPECT_EQ(root.find("screw")->find("pitch")->number, *r.pitch);
  EXPECT_EQ(root.find("screw")->find("displacement")->number, r.intrinsic.d);
  same(numbers_of(root.find("motion_tensor")), r.motion_tensor.m);
  same(numbers_of(root.find("inverse_motion_tensor")), r.inverse_motion_tensor.m);
  same(numbers_of(root.find("second_eigenvector")), r.second_eigenvector->v);
  ASSERT_EQ(root.find("parameters")->items.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k)
    same(numbers_of(root.find("parameters")->items[k].find("motion")), r.parameters[k].motion->v);
}

TEST(MotionReport, what_does_not_exist_is_left_out_and_said) {
  motion::Frame<double> H;
  ASSERT_EQ(read_pose(std::vector<double>{0, 3, 4}, H), "");
  const motion::MotionReport translation = describe({.from = std::nullopt, .to = H});
  const JsonValue root = parsed(motion_json(translation));
  EXPECT_EQ(root.find("screw")->find("kind")->text, "translation");
  EXPECT_EQ(root.find("screw")->find("displacement")->number, 5.0);
  for (const char* key : {"pitch", "axis_point", "axis_line", "moment"})
    EXPECT_EQ(root.find("screw")->find(key), nullptr) << key;
  EXPECT_EQ(root.find("rotation")->find("axis"), nullptr);
  const JsonValue rest = parsed(motion_json(describe({})));
  EXPECT_EQ(rest.find("screw")->find("kind")->text, "none");
  EXPECT_EQ(rest.find("first_eigenvector"), nullptr);
  const auto cell = [](const motion::MotionReport& r, const std::string& name) {
    for (const auto& row : motion_rows(r))
      if (row[0].find(name) == 0) return row.at(1);
    return std::string("no such row");
  };
  EXPECT_EQ(cell(translation, "pitch"), "none: infinite");
  EXPECT_EQ(cell(translation, "rotation axis"), "none: no rotation");
  EXPECT_EQ(cell(describe({}), "pitch"), "none: no motion");
}

TEST(MotionReport, of_two_poses_is_the_motion_between_them) {
  motion::Frame<double> a, b;
  ASSERT_EQ(read_pose(std::vector<double>{1, 0, 0, 0, 0, 0.3}, a), "");
  ASSERT_EQ(read_pose(std::vector<double>{1, 0, 2, 0, 0, 0.3 + quarter}, b), "");
  // About the axis through (1, 0) along z: one turn would climb 8 m, whoever looks.
  for (const motion::SeenFrom from : {motion::SeenFrom::inertial, motion::SeenFrom::first})
    EXPECT_NEAR(*describe({.from = a, .to = b, .seen_from = from}).pitch, 8.0, 1e-14);
  EXPECT_NEAR((*describe({.from = a, .to = b}).axis_point)[0], 1.0, 1e-15);
  EXPECT_NEAR((*describe({.from = a, .to = b, .seen_from = motion::SeenFrom::first}).axis_point)[0], 0.0, 1e-15);
}

}  // namespace
}  // namespace bough::io
