#pragma once
/// Chains of moving frames with a point, from JSON files (`bough kinematics razi --chain`).
#include "bough/io/read_scene.hpp"
#include "bough/scene/moving_frame.hpp"

namespace bough::io {

/// A chain as far as it could be read. It is usable only when `problems` is empty.
struct FrameFile {
  scene::FrameStudy study;
  std::vector<Problem> problems;  ///< in the order of the file; at most max_problems
  std::vector<Problem> warnings;  ///< legal, but probably not meant
  bool ok() const { return problems.empty(); }
};

/// Reads and checks a chain. Never throws on bad input (only std::bad_alloc may pass). FrameStudy::name is the file's
/// name without its ending.
FrameFile read_frames(const std::filesystem::path& file);

/// The same from a text in memory. name: becomes FrameStudy::name.
FrameFile read_frames_text(std::string_view text, std::string name);

/// The JSON Schema (draft-07) of such files, made from the table that checks them.
std::string frames_schema_text();

}  // namespace bough::io
