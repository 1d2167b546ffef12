#pragma once
/// Changes to a scene file that are sure: a key, word or name of which only one is near, a number in quotes, a comma
/// before a closing bracket. Everything else of the file keeps its bytes.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/read_scene.hpp"

namespace bough::io {

/// A text with parts of it replaced. Of parts that overlap the first one counts.
std::string with_fixes(std::string_view text, std::vector<Fix> fixes);

/// A change that was made: the fault, and the text that gave way.
struct FixDone {
  Problem problem;
  std::string before;
};

struct FixedScene {
  std::string text;           ///< with all changes
  std::vector<FixDone> done;  ///< in the order in which they were made
  SceneFile file;             ///< the text as read: what is left to be done by hand
};

/// Reads a scene, makes the changes that its faults are sure of, and reads it again until there are none: a fault can
/// hide others. After 200 rounds, or 64 MB of text, what is left stays. folder: where files that the scene names are
/// found.
FixedScene fixed_scene(std::string_view text, const std::filesystem::path& folder);

/// The difference of two texts of equally many lines, as of `diff -u`; empty: they are equal.
std::string diff_of(const std::string& name, std::string_view before, std::string_view after);

}  // namespace bough::io
