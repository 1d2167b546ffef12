#pragma once
/// The file of a checkpoint as bytes, whoever has written it.
#include <filesystem>
#include <string>
#include <string_view>

#include "bough/io/unfinished_run.hpp"

namespace bough::io {

/// After the head comes the state of the run, which begins with a records::StoredState, then the positions in all files.
struct CheckpointFile {
  std::string fault;  ///< why it cannot be used, in words; empty: it can
  CheckpointHead head;
  std::string state, files;
};

/// All but the fault has no meaning where there is one.
CheckpointFile read_checkpoint_file(const std::filesystem::path& file);
/// Format, length and hash of the head are those of what is written. The file is on the disk before it gets its name.
void write_checkpoint_file(const std::filesystem::path& file, CheckpointHead head, std::string_view state,
                           std::string_view files);

}  // namespace bough::io
