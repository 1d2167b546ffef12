#pragma once
/// `manifest.json` lists the files of a folder that bough wrote. No other file is ever replaced or removed.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bough/records/archive.hpp"

namespace bough::io {

inline constexpr const char* manifest_name = "manifest.json";

/// A file below a folder.
struct FileRecord {
  std::string name;         ///< relative, with slashes; a star at its end matches any text: "motion/frame_*"
  std::uint64_t bytes = 0;  ///< size, if `hash` is given
  std::string hash = {};    ///< Digest; empty: any content
  void checkpoint(records::Archive& archive) { archive(name, bytes, hash); }
};

/// Outcome of the work whose results are in a folder.
enum class FolderState { unfinished, good, failed };

/// Whose results a folder holds, or is to hold.
struct Owner {
  std::string verb;                   ///< "run", "sweep"
  std::filesystem::path source = {};  ///< file or folder that it reads; empty or "-": none that could be another one
  std::string key = {};               ///< of a case of a batch: its identity; otherwise empty
  bool replaces = false;              ///< whether results of another owner may be replaced (--replace)
};

struct Manifest {
  std::string made_by;  ///< verb
  FolderState state = FolderState::unfinished;
  std::string instead_of = {};  ///< name of a neighbouring folder whose good results these did not replace, or whose
                                ///< new ones will replace these; otherwise empty
  std::vector<FileRecord> files = {};
  std::string source = {};  ///< Owner::source, relative to the folder, so that both may be moved together
  std::string key = {};     ///< Owner::key
};
/// Of results of this owner in a folder.
Manifest manifest_of(const Owner& owner, const std::filesystem::path& folder);

/// Thrown before anything is touched, where output would destroy something.
class OutputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string manifest_text(const Manifest& manifest);

/// None if there is no manifest, or if a file of this name was not written by bough.
std::optional<Manifest> read_manifest(const std::filesystem::path& folder);

/// Entries of a folder that bough did not write. Not among them are files listed by its manifest with the hash listed
/// there, folders with a manifest of their own, and what remains of a listed file when its writer is killed. Relative
/// names, at most `limit`. Links are never followed and always foreign.
std::vector<std::string> foreign_entries(const std::filesystem::path& folder, std::size_t limit = 3);
/// As above, with the result of read_manifest for the folder.
std::vector<std::string> foreign_entries(const std::filesystem::path& folder, const std::optional<Manifest>& manifest,
                                         std::size_t limit);

/// Removes the files that the folder's manifest lists, the manifest itself, and folders that become empty, this one
/// included. Everything else stays. Throws std::runtime_error if something cannot be removed.
void remove_listed(const std::filesystem::path& folder);
/// The same with all folders within that have manifests of their own: cases of a batch, references of a study.
/// remove_whole_within: this folder and its manifest stay.
void remove_whole(const std::filesystem::path& folder);
void remove_whole_within(const std::filesystem::path& folder);
/// Folders directly within that have manifests of their own.
std::vector<std::filesystem::path> listed_folders(const std::filesystem::path& folder);

/// Whether a folder holds results of another owner: another verb, another source, a case of a batch.
bool is_of_another(const std::filesystem::path& folder, const Owner& owner);

/// Throws OutputRefused if `folder` exists and is no folder, has foreign entries, or holds results of another owner.
/// `owner.replaces` allows these; then the folders within may have no
/// foreign entries either.
void require_ours(const std::filesystem::path& folder, const Owner& owner);

/// Makes the manifest of a folder anew, unfinished, where it is damaged: it lists those of the names that are there.
/// Returns whether it was. Precondition: something else in the folder shows that it is this owner's.
bool repair_manifest(const std::filesystem::path& folder, const Owner& owner, const std::vector<std::string>& names);

/// Throws OutputRefused if one of the outputs is one of the inputs or is named twice, by whatever path. Empty paths are
/// ignored.
void refuse_to_overwrite(const std::vector<std::filesystem::path>& inputs,
                         const std::vector<std::filesystem::path>& outputs);

/// Throws OutputRefused if one of the inputs lies in the output folder.
void refuse_inputs_within(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& folder);

/// Writes an additional file of a folder: a page, a table of many results. It is listed in the folder's manifest, which
/// is made (by the owner) if there is none, and then written by `write_file`.
void write_listed_file(const std::filesystem::path& folder, const Owner& owner, const std::string& name,
                       std::string_view text);
/// For a file that many processes write with equal content: the first one writes it, the others leave it.
void write_listed_file_once(const std::filesystem::path& folder, const Owner& owner, const std::string& name,
                            std::string_view text);
/// Lists a file without writing it. list_file_in_locked: for a caller that holds the folder's lock.
void list_file(const std::filesystem::path& folder, const Owner& owner, const std::string& name);
void list_file_in_locked(const std::filesystem::path& folder, const Owner& owner, const std::string& name);

}  // namespace bough::io
