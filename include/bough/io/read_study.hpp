#pragma once
/// Studies from JSON files (`bough study`).
#include "bough/io/read_scene.hpp"
#include "bough/io/study_spec.hpp"

namespace bough::io {

/// A study as far as it could be read. It is usable only when `problems` is empty; then the scene of every run is
/// sound, too.
struct StudyFile {
  StudySpec spec;
  std::vector<Problem> problems;  ///< in the order of the file; at most max_problems
  std::vector<Problem> warnings;
  bool ok() const { return problems.empty(); }
};

/// Reads and checks a study with its scene, tables and all combinations of choices. Never throws on bad input. Names
/// of files are relative to the study's folder.
StudyFile read_study(const std::filesystem::path& file);
StudyFile read_study_text(std::string_view text, std::string name, const std::filesystem::path& folder);

/// The JSON Schema (draft-07) of such files.
std::string study_schema_text();

/// What a scene amounts to: the checked document with all defaults, keys sorted, numbers in full. Two texts are equal
/// where the scenes are. Empty where it has problems.
std::string canonical_scene(std::string_view text, std::span<const std::string> overrides);

/// A JSON text without spaces and comments, keys sorted, numbers in full: equal for texts that say the same. A text
/// that is no JSON stays as it is.
std::string canonical_text(std::string_view text);

}  // namespace bough::io
