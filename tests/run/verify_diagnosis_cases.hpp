#pragma once
/// Scenes that are wrong, or look wrong: what is done with each and which names have to be said.
#include <string>
#include <vector>

namespace bough::verify {

enum class Fate {
  runs,     ///< to its end, with a note that says all words
  fails,    ///< status failed, the cause says all words
  refused,  ///< by the check of the scene, the problems say all words
};

struct Diagnosis {
  std::string name;
  Fate fate;
  std::vector<std::string> words;
  std::string text;  ///< of a scene file, without schema_version
};

/// Constraints that depend on each other, consistently or not.
std::vector<Diagnosis> over_constrained_cases();
/// Something that nothing holds, or that nothing gives inertia to.
std::vector<Diagnosis> under_constrained_cases();
/// Jumps, branches, numbers that are not finite, equilibria that do not exist.
std::vector<Diagnosis> hard_cases();

}  // namespace bough::verify
