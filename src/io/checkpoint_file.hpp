#pragma once
/// The file of a checkpoint as bytes, whoever has written it.
#include <filesystem>
#include <string>
#include <string_view>

namespace bough::io {

struct CheckpointHead {
  std::string program_hash, identity;  ///< of the scene
  long number = 0;                     ///< of those that the run has made
  double time = 0.0;                   ///< [s], or load factor
};

/// A line of words, so that it can be told what a file is that cannot be used:
///   format, hash of the program, identity of the scene, number, time, bytes that follow, their hash
/// then the state of the run, which begins with a records::StoredState, and the positions in all files.
struct CheckpointFile {
  std::string fault;  ///< why it cannot be used, in words; empty: it can
  CheckpointHead head;
  std::string state, files;
};

/// All but the fault has no meaning where there is one.
CheckpointFile read_checkpoint_file(const std::filesystem::path& file);
/// The file is on the disk before it gets its name.
void write_checkpoint_file(const std::filesystem::path& file, const CheckpointHead& head, std::string_view state,
                           std::string_view files);

}  // namespace bough::io
