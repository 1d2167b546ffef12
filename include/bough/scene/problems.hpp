#pragma once
/// What is wrong with a scene as a whole: names, references, geometry, what can not be computed.
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::scene {

struct SceneProblem {
  std::string section;      ///< name of the list or struct in Scene: "beams", "point_loads", "analysis" ...
  int index = -1;           ///< in the list; -1 for a struct
  std::string key;          ///< key in the thing, with '/' into nested ones ("drives/0/coordinate"); may be empty
  std::string value;        ///< at fault
  std::string rule;         ///< what is asked
  std::string hint;         ///< what to do; may be empty
  bool is_warning = false;  ///< legal, but probably not meant
  std::size_t more = 0;  ///< of the last problem and the last warning: how many more there are, which are only counted
};

/// All of them. defective: names of things that were left out of the scene because they are wrong already; references
/// to them are not reported, nor what can not be judged without them. "/analysis" stands for the analysis.
std::vector<SceneProblem> problems_in(const Scene& scene, std::span<const std::string> defective = {});

}  // namespace bough::scene
