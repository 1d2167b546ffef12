#pragma once
/// The parts of the effort along a coordinate of a joint, by the words with which signals and sensors name them.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/scene/joint_kinds.hpp"
#include "bough/scene/scene.hpp"

namespace bough::scene {

/// What is read of all that acts along a coordinate, on the second:
///   -(drive's or rod's multiplier) + sum over forces of (-k (q - rest) - c q' + law).
struct EffortParts {
  bool drive = false, spring = false, damper = false, effort = false;
  std::string force = {};  ///< the name of the one force that is read; empty: all of them
  bool takes(const JointForce& f) const { return force.empty() || f.name == force; }
};

/// The words that every joint knows: "all", "drive", "spring", "damper", "effort". Others are names of forces.
const std::vector<std::string>& effort_words();
/// Nothing where `of` is neither a word nor the name of a force of the joint. Empty: all.
std::optional<EffortParts> effort_parts(const std::string& of, const Joint& joint);
/// The word meant by one of the field's other words for a part ("motor" is a drive, "friction" an effort); empty: none.
std::string_view effort_word_meant(std::string_view word);
/// The kind of signal or sensor meant by words as "joint_torque" or "motor_force": "joint_effort"; empty: none.
std::string_view effort_kind_meant(std::string_view word);

/// Whether a force or drive, whose coordinate may be left out where the joint has but one, acts along a coordinate.
bool acts_along(const std::string& given, const JointType& type, const JointCoordinate& coordinate);

}  // namespace bough::scene
