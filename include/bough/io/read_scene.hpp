#pragma once
/// Reads scenes from JSON files, and reports all their faults with the position of each.
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/input_file.hpp"
#include "bough/io/json_value.hpp"
#include "bough/scene/scene.hpp"

namespace bough::io {

/// A line of a file with a part of it marked.
struct Excerpt {
  int line = 0;                        ///< from 1; 0: there is none
  std::string text;                    ///< the line, or what of it is near the mark, for display
  std::size_t before = 0, marked = 0;  ///< characters before the mark, and of the mark, in `text`
};

/// One fault of a file.
struct Problem {
  std::string pointer;            ///< JSON pointer (RFC 6901) of the value or key at fault
  int line = 0;                   ///< from 1; 0: not in the file (given by an override, or the file itself)
  int column = 0;                 ///< from 1, counted in characters
  std::string value;              ///< the text at fault as written, shortened
  std::string rule;               ///< the rule that it breaks
  std::string hint;               ///< what to do, or the nearest known name; may be empty
  std::string owner = {};         ///< name of the part to which the pointer leads; empty if the value shows it
  std::string instance = {};      ///< which copy of a repeated part: "i = 3, j = 0"; empty: none
  std::string code = {};          ///< of the rule (fault_codes.hpp): what `bough explain` takes
  Excerpt excerpt = {};           ///< of the place at fault
  Excerpt second = {};            ///< another place that one needs to see
  std::string second_about = {};  ///< what is there: "defined here"
  std::optional<Fix> fix = {};    ///< what can only have been meant, where that is sure (sure_names.hpp)

  /// "line 12, column 7, /beams/0/section: "stel": no section has this name; did you mean "steel"?"
  std::string text() const;
  /// The same on several lines: code, excerpts with a mark below the places, and the hint on a line of its own.
  ///   line 12, column 7, /beams/0/section of "arm" ("stel"): no section has this name [unknown-name]
  ///      12 |   "section": "stel",
  ///         |              ^^^^^^
  ///     help: did you mean "steel"?
  std::string long_text() const;
};

/// The readable content of a scene file. It is usable only if `problems` is empty.
struct SceneFile {
  scene::Scene scene;
  std::vector<Problem> problems;  ///< in the order of the file; at most max_problems
  std::vector<Problem> warnings;  ///< legal, but probably not meant
  /// Numbers of the items of each list as written, with copies made: a scene can hold more parts, since some are made
  /// of others (a servo of signals, a spring with a law of a strut).
  std::map<std::string, std::size_t, std::less<>> counts;
  std::string hash;  ///< digest of the text, and of the files that it names (digest.hpp)
  bool ok() const { return problems.empty(); }
};

inline constexpr std::size_t max_problems = 200;           ///< further ones are counted in the last one
inline constexpr std::size_t max_json_depth = 64;          ///< of arrays and objects in each other
inline constexpr std::size_t max_json_values = 2'000'000;  ///< numbers, strings, arrays and objects together

/// Reads and checks a scene. Never throws on bad input (only std::bad_alloc may pass), never returns a half-checked
/// scene as good. set_overrides: "/pointer=value", applied before the check; the value is JSON, or a bare word taken
/// as a string; an array item may be given by its number or by its "name". Scene::name is that of the file
/// (name_of_file). The file "-" is standard input, and its scene is named "scene".
SceneFile read_scene(const std::filesystem::path& file, std::span<const std::string> set_overrides = {});

/// Name that a file gives to its scene and to folders of results: the file name without its last ending, or all of it
/// if only dots would remain, which would lead out of a folder.
std::string name_of_file(const std::filesystem::path& file);

/// The same from a text in memory. name: becomes Scene::name.
/// folder: where files that the scene names are found; empty: it may name none.
SceneFile read_scene_text(std::string_view text, std::string name, std::span<const std::string> set_overrides = {},
                          const std::filesystem::path& folder = {});

/// A scene in which parameters and formulas are replaced by numbers, and repeated parts by their copies, as a file of
/// its own. When read, it gives the same scene to the last bit. text: empty if there are problems.
struct ExpandedScene {
  std::string text;
  std::vector<Problem> problems, warnings;
  bool ok() const { return problems.empty(); }
};
ExpandedScene expanded_scene(const std::filesystem::path& file, std::span<const std::string> set_overrides = {});
ExpandedScene expanded_scene_text(std::string_view text, std::span<const std::string> set_overrides = {},
                                  const std::filesystem::path& folder = {});

/// The JSON Schema (draft-07) of scene files, made from the table that checks them.
std::string schema_text();

}  // namespace bough::io
