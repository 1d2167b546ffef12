#pragma once
#include <string>

#include "bough/io/schema_rule.hpp"

namespace bough::io {

/// The table of study files.
const RuleTable& study_rules();

/// Where the axes with known names lead in the scene; `*` stands for every item of a list. "threads" leads nowhere:
/// it is no part of a scene.
struct KnownAxis {
  const char* name;
  const char* pointer;
  bool larger_is_finer;
};
const std::vector<KnownAxis>& known_axes();

}  // namespace bough::io
