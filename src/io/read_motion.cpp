#include "bough/io/read_motion.hpp"

#include <cmath>

#include "bough/io/schema_rule.hpp"
#include "document_report.hpp"
#include "kinematics_rules.hpp"
#include "read_values.hpp"
#include "schema_parts.hpp"

namespace bough::io {
namespace {

constexpr double largest_length = 1e100;  ///< [m]; products of two still fit a double

RuleTable make_motion_rules() {
  RuleTable t;
  add_part_rules(t);
  t.named["pose"] = made(object_of("A pose in the inertial frame.",
                                   {may("position", named_rule("vector"), "Of the origin [m].", "[0, 0, 0]"),
                                    may("rotation", named_rule("rotation"), "Of the axes. Default: none.")}));
  t.root = made(object_of(
      "A motion, for bough kinematics motion: from one pose to another, or to one from the inertial frame. SI units "
      "and "
      "radians. A \"comment\" string is allowed in every object.",
      {may("$schema", text_rule(""), "Address of this schema, for editors; not read."),
       need("schema_version", integer_rule("", 1, 1), "Version of the format: 1."),
       may("from", named_rule("pose"), "Pose before. Default: the inertial frame."),
       need("to", named_rule("pose"), "Pose after."),
       may("seen_from", word_rule("", {"inertial", "first"}),
           "Axes and reference point of the motion: those of the inertial frame, or those of the pose before.",
           "\"inertial\"")}));
  return t;
}

}  // namespace

const RuleTable& motion_rules() {
  static const RuleTable table = make_motion_rules();
  return table;
}

namespace {

std::string fault_of(const motion::Frame<double>& pose) {
  for (const double r : pose.R.m)
    if (!std::isfinite(r)) return "the rotation is too large to be computed";
  for (const double x : pose.x.v)
    if (!(std::abs(x) <= largest_length)) return "a position has components of at most 1e100 m";
  return {};
}

class MotionConverter : private ValueConverter {
 public:
  using ValueConverter::faults;
  using ValueConverter::warnings;
  MotionInput input;

  void convert(const JsonValue& root) {
    if (const Value* from = root.find("from"); from != nullptr && from->sound) input.from = pose(*from, "/from");
    if (const Value* to = root.find("to"); to != nullptr && to->sound) input.to = pose(*to, "/to");
    if (const Value* seen = root.find("seen_from"); seen != nullptr && seen->sound)
      input.seen_from = seen->text == "first" ? motion::SeenFrom::first : motion::SeenFrom::inertial;
  }

 private:
  motion::Frame<double> pose(const Value& v, const std::string& at) {
    motion::Frame<double> H = motion::Frame<double>::identity();
    H.x = vector(*v.find("position"));
    if (const Value* r = v.find("rotation")) H.R = rotation(*r, at + "/rotation");
    if (const std::string what = fault_of(H); !what.empty()) fault(at, what);
    return H;
  }
};

}  // namespace

motion::MotionReport describe(const MotionInput& input) {
  if (!input.from) return motion::describe_motion(input.to);
  return motion::describe_relative_motion(*input.from, input.to, input.seen_from);
}

MotionFile read_motion_text(std::string_view text) {
  MotionFile file;
  MotionConverter converter;
  read_document(text, motion_rules(), converter, file);
  file.input = converter.input;
  return file;
}

MotionFile read_motion(const std::filesystem::path& file) {
  return read_document_file<MotionFile>(file, [](const std::string& text) { return read_motion_text(text); });
}

std::string read_pose(std::span<const double> numbers, motion::Frame<double>& pose) {
  if (numbers.size() != 3 && numbers.size() != 6 && numbers.size() != 7)
    return "a pose is 3 numbers (position), 6 (position, rotation vector) or 7 (position, quaternion with the scalar "
           "first), not " +
           std::to_string(numbers.size());
  pose = motion::Frame<double>::identity();
  for (int k = 0; k < 3; ++k) pose.x[k] = numbers[static_cast<std::size_t>(k)];
  if (numbers.size() == 6) pose.R = motion::exp_so3(motion::Vec3<double>{{numbers[3], numbers[4], numbers[5]}});
  if (numbers.size() == 7) {
    const double length = std::hypot(std::hypot(numbers[3], numbers[4]), std::hypot(numbers[5], numbers[6]));
    if (!(std::abs(length - 1.0) <= 1e-3)) return "a rotation is a quaternion of length 1, scalar first";
    pose.R = motion::rotation_of(
        motion::normalise(motion::Quaternion<double>{numbers[3], {{numbers[4], numbers[5], numbers[6]}}}));
  }
  return fault_of(pose);
}

std::string motion_schema_text() { return schema_text_of(motion_rules(), "bough motion"); }

}  // namespace bough::io
