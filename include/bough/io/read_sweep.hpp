#pragma once
/// Sweeps from JSON files (`bough sweep`).
#include "bough/io/read_scene.hpp"
#include "bough/io/sweep_spec.hpp"

namespace bough::io {

/// The readable content of a sweep file. It is usable only if `problems` is empty; the scene is then valid with some
/// values of its variables. Faults with others are those of their cases, found when they run.
struct SweepFile {
  SweepSpec spec;
  std::vector<Problem> problems;  ///< in the order of the file; at most max_problems
  std::vector<Problem> warnings;
  bool ok() const { return problems.empty(); }
};

/// Reads and checks a sweep with its scene and tables. Never throws on bad input. Names of files are relative to the
/// sweep's folder.
SweepFile read_sweep(const std::filesystem::path& file);
SweepFile read_sweep_text(std::string_view text, std::string name, const std::filesystem::path& folder);

/// The JSON Schema (draft-07) of such files.
std::string sweep_schema_text();

}  // namespace bough::io
