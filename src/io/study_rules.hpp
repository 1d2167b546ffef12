#pragma once
#include <string>

#include "bough/io/schema_rule.hpp"

namespace bough::io {

/// The table of study files.
const RuleTable& study_rules();

/// Pointers into the scene for the axes with known names; `*` stands for every item of a list. "threads" has no
/// pointer, since it is not part of a scene.
struct KnownAxis {
  const char* name;
  const char* pointer;
  bool larger_is_finer;
};
const std::vector<KnownAxis>& known_axes();

}  // namespace bough::io
