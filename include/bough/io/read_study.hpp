#pragma once
/// Studies from JSON files (`bough study`).
#include "bough/io/read_scene.hpp"
#include "bough/io/study_spec.hpp"

namespace bough::io {

/// The readable content of a study file. It is usable only if `problems` is empty; the scene of every run is then
/// valid, too.
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

/// Canonical form of a scene: the checked document with all defaults, keys sorted, numbers in full. Two texts are equal
/// if the scenes are. Empty if the scene has problems.
std::string canonical_scene(std::string_view text, std::span<const std::string> overrides);

/// A JSON text without spaces and comments, keys sorted, numbers in full: equal for equivalent texts. A text that is
/// not JSON is returned unchanged.
std::string canonical_text(std::string_view text);

}  // namespace bough::io
