#pragma once
/// The file of a checkpoint as bytes, whoever has written it.
#include <filesystem>
#include <string>
#include <string_view>

namespace bough::io {

/// A line of words, so that it can be told what a file is that cannot be used:
///   format, hash of the program, identity of the scene, number, time, bytes that follow, their hash
/// then the state of the run, which begins with a records::StoredState, and the positions in all files.
struct CheckpointFile {
  std::string fault;  ///< why it cannot be used, in words; empty: it can
  std::string program_hash, identity;
  long number = 0;
  double time = 0.0;
  std::string state, files;
};

/// All but the fault has no meaning where there is one.
CheckpointFile read_checkpoint_file(const std::filesystem::path& file);
std::string checkpoint_text(const CheckpointFile& checkpoint);

}  // namespace bough::io
