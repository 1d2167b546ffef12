#include "bough/scene/joint_efforts.hpp"

#include <algorithm>
#include <utility>

#include "bough/scene/joint_kinds.hpp"

namespace bough::scene {

const std::vector<std::string>& effort_words() {
  static const std::vector<std::string>& words =
      *new std::vector<std::string>{"all", "drive", "spring", "damper", "effort"};  // texts refer to it to the end
  return words;
}

std::optional<EffortParts> effort_parts(const std::string& of, const Joint& joint) {
  if (of.empty() || of == "all") return EffortParts{true, true, true, true, {}};
  if (of == "drive") return EffortParts{.drive = true};
  if (of == "spring") return EffortParts{.spring = true};
  if (of == "damper") return EffortParts{.damper = true};
  if (of == "effort") return EffortParts{.effort = true};
  if (std::any_of(joint.forces.begin(), joint.forces.end(), [&of](const JointForce& f) { return f.name == of; }))
    return EffortParts{false, true, true, true, of};
  return std::nullopt;
}

std::string_view effort_word_meant(std::string_view word) {
  static constexpr std::pair<std::string_view, std::string_view> others[] = {
      {"net", "all"},        {"total", "all"},        {"sum", "all"},        {"everything", "all"},
      {"motor", "drive"},    {"rod", "drive"},        {"drives", "drive"},   {"constraint", "drive"},
      {"elastic", "spring"}, {"stiffness", "spring"}, {"springs", "spring"}, {"dashpot", "damper"},
      {"damping", "damper"}, {"viscous", "damper"},   {"dampers", "damper"}, {"friction", "effort"},
      {"limit", "effort"},   {"stop", "effort"},      {"law", "effort"},     {"signal", "effort"},
      {"servo", "effort"},   {"actuator", "effort"},  {"efforts", "effort"}, {"torque", "effort"},
      {"force", "effort"},   {"applied", "effort"}};
  const auto* const found =
      std::find_if(std::begin(others), std::end(others), [word](const auto& o) { return o.first == word; });
  return found == std::end(others) ? std::string_view{} : found->second;
}

std::string_view effort_kind_meant(std::string_view word) {
  constexpr std::string_view ends[] = {"torque", "effort", "force", "moment"},
                             begins[] = {"", "joint_", "drive_", "motor_", "actuator_", "servo_", "driving_"};
  for (const std::string_view begin : begins)
    for (const std::string_view end : ends)
      if (word.size() == begin.size() + end.size() && word.starts_with(begin) && word.ends_with(end))
        return "joint_effort";
  return {};
}

bool acts_along(const std::string& given, const JointType& type, const JointCoordinate& coordinate) {
  const JointCoordinate* own = type.coordinates.size() == 1 ? &type.coordinates[0] : type.coordinate(given);
  return own != nullptr && own->kind == coordinate.kind;
}

}  // namespace bough::scene
