#pragma once
/// `manifest.json`: which files of a folder bough wrote. Only what it lists is ever replaced or removed.
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
  std::string name;         ///< relative, with slashes; a star at its end stands for anything: "motion/frame_*"
  std::uint64_t bytes = 0;  ///< where `hash` is given
  std::string hash = {};    ///< Digest; empty: any content
};

/// How the work whose results a folder holds has ended.
enum class FolderState { unfinished, good, failed };

struct Manifest {
  std::string made_by;  ///< verb
  FolderState state = FolderState::unfinished;
  std::string instead_of = {};  ///< name of the folder beside, whose good results these did not replace; else empty
  std::vector<FileRecord> files = {};
};

/// Output that would destroy something, told before anything is touched.
class OutputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::string manifest_text(const Manifest& manifest);

/// None where there is no manifest, or what is called so was not written by bough.
std::optional<Manifest> read_manifest(const std::filesystem::path& folder);

/// What of a folder is not bough's: neither listed by its manifest with the size listed there, nor a folder with a
/// manifest of its own, nor what a listed file leaves behind when its writer is killed. Relative names, at most
/// `limit`. Links are never followed and never bough's.
std::vector<std::string> foreign_entries(const std::filesystem::path& folder, std::size_t limit = 3);
/// The same with what read_manifest gave for the folder.
std::vector<std::string> foreign_entries(const std::filesystem::path& folder, const std::optional<Manifest>& manifest,
                                         std::size_t limit);

/// Removes what the folder's manifest lists, the manifest itself, and folders that are empty then, itself among them.
/// What else lies there stays. Throws std::runtime_error where something cannot be removed.
void remove_listed(const std::filesystem::path& folder);

/// Throws OutputRefused where `folder` is there and is no folder, or holds what is not bough's.
void require_ours(const std::filesystem::path& folder);

/// Throws OutputRefused where one of the outputs is one of the inputs or is named twice, by whatever path. Empty
/// paths are left out.
void refuse_to_overwrite(const std::vector<std::filesystem::path>& inputs,
                         const std::vector<std::filesystem::path>& outputs);

/// Throws OutputRefused where one of the inputs lies in the folder that output goes to.
void refuse_inputs_within(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& folder);

/// A file that belongs to a folder besides what made the folder: a page, a table of many results. It is listed in the
/// folder's manifest, which is made (by `made_by`) where there is none, and then written as `write_file` does.
void write_listed_file(const std::filesystem::path& folder, const std::string& made_by, const std::string& name,
                       std::string_view text);
/// The same of a file that many processes write alike: the first one does, and the others leave it.
void write_listed_file_once(const std::filesystem::path& folder, const std::string& made_by, const std::string& name,
                            std::string_view text);
/// Lists a file without writing it.
void list_file(const std::filesystem::path& folder, const std::string& made_by, const std::string& name);

}  // namespace bough::io
