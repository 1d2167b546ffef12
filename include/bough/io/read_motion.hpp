#pragma once
/// One motion, from numbers or a JSON file (`bough kinematics motion`).
#include <optional>
#include <span>

#include "bough/io/read_scene.hpp"
#include "bough/motion/describe.hpp"

namespace bough::io {

/// The motion to be described takes the axes `from` to the axes `to`; both poses are in the inertial frame.
struct MotionInput {
  std::optional<motion::Frame<double>> from;  ///< none: the inertial frame itself
  motion::Frame<double> to = motion::Frame<double>::identity();
  motion::SeenFrom seen_from = motion::SeenFrom::inertial;
};

/// The report of the motion. Throws std::invalid_argument if a pose is not valid (motion::describe_motion).
motion::MotionReport describe(const MotionInput& input);

/// The readable content of a file. It is usable only if `problems` is empty.
struct MotionFile {
  MotionInput input;
  std::vector<Problem> problems;  ///< in the order of the file; at most max_problems
  std::vector<Problem> warnings;  ///< legal, but probably not meant
  bool ok() const { return problems.empty(); }
};

/// Reads and checks a file. Never throws on bad input (only std::bad_alloc may pass).
MotionFile read_motion(const std::filesystem::path& file);
MotionFile read_motion_text(std::string_view text);

/// A pose from 3 numbers (position [m]), 6 (position, rotation vector [rad]) or 7 (position, quaternion, scalar
/// first, within 1e-3 of unit length). Returns what is wrong, empty where nothing is.
std::string read_pose(std::span<const double> numbers, motion::Frame<double>& pose);

/// The JSON Schema (draft-07) of such files, made from the table that checks them.
std::string motion_schema_text();

}  // namespace bough::io
