#pragma once
/// `manifest.json` lists the files of a folder that bough wrote. No other file is ever replaced or removed.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace bough::io {

inline constexpr const char* manifest_name = "manifest.json";

/// A file below a folder.
struct FileRecord {
  std::string name;         ///< relative, with slashes; a star at its end matches any text: "motion/frame_*"
  std::uint64_t bytes = 0;  ///< size, if `hash` is given
  std::string hash = {};    ///< Digest; empty: any content
};

/// Outcome of the work whose results are in a folder.
enum class FolderState { unfinished, good, failed };

struct Manifest {
  std::string made_by;  ///< verb
  FolderState state = FolderState::unfinished;
  std::string instead_of = {};  ///< name of a neighbouring folder whose good results these did not replace; otherwise
                                ///< empty
  std::vector<FileRecord> files = {};
};

/// Thrown before anything is touched, where output would destroy something.
class OutputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string manifest_text(const Manifest& manifest);

/// None if there is no manifest, or if a file of this name was not written by bough.
std::optional<Manifest> read_manifest(const std::filesystem::path& folder);

/// Entries of a folder that bough did not write. Not among them are files listed by its manifest with the size listed
/// there, folders with a manifest of their own, and what remains of a listed file when its writer is killed. Relative
/// names, at most `limit`. Links are never followed and always foreign.
std::vector<std::string> foreign_entries(const std::filesystem::path& folder, std::size_t limit = 3);
/// As above, with the result of read_manifest for the folder.
std::vector<std::string> foreign_entries(const std::filesystem::path& folder, const std::optional<Manifest>& manifest,
                                         std::size_t limit);

/// Removes the files that the folder's manifest lists, the manifest itself, and folders that become empty, this one
/// included. Everything else stays. Throws std::runtime_error if something cannot be removed.
void remove_listed(const std::filesystem::path& folder);

/// Throws OutputRefused if `folder` exists and is no folder, or has foreign entries.
void require_ours(const std::filesystem::path& folder);

/// Throws OutputRefused if one of the outputs is one of the inputs or is named twice, by whatever path. Empty paths are
/// ignored.
void refuse_to_overwrite(const std::vector<std::filesystem::path>& inputs,
                         const std::vector<std::filesystem::path>& outputs);

/// Throws OutputRefused if one of the inputs lies in the output folder.
void refuse_inputs_within(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& folder);

/// Writes an additional file of a folder: a page, a table of many results. It is listed in the folder's manifest, which
/// is made (by `made_by`) if there is none, and then written by `write_file`.
void write_listed_file(const std::filesystem::path& folder, const std::string& made_by, const std::string& name,
                       std::string_view text);
/// For a file that many processes write with equal content: the first one writes it, the others leave it.
void write_listed_file_once(const std::filesystem::path& folder, const std::string& made_by, const std::string& name,
                            std::string_view text);
/// Lists a file without writing it.
void list_file(const std::filesystem::path& folder, const std::string& made_by, const std::string& name);

}  // namespace bough::io
