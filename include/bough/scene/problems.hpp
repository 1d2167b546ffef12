#pragma once
/// Checks of a whole scene: names, references, geometry, and data with which nothing can be computed.
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::scene {

struct SceneProblem {
  std::string section;      ///< name of the list or struct in Scene: "beams", "point_loads", "analysis" ...
  int index = -1;           ///< index in the list; -1 where the section is a struct
  std::string key;          ///< key within the entry, with '/' into nested ones ("drives/0/coordinate"); may be empty
  std::string value;        ///< the value at fault
  std::string rule;         ///< the rule that the value breaks
  std::string hint;         ///< what to do; may be empty
  bool is_warning = false;  ///< legal, but probably not meant
  std::size_t more = 0;     ///< set in the last problem and in the last warning: how many more were found, which are
                            ///< counted but not listed
};

/// Finds all problems. defective: names of parts that are already known to be wrong and were left out of the scene.
/// References to them are not reported, nor are faults that cannot be judged without them. The name "/analysis" stands
/// for the analysis.
std::vector<SceneProblem> problems_in(const Scene& scene, std::span<const std::string> defective = {});

}  // namespace bough::scene
