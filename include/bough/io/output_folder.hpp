#pragma once
/// A folder of results that changes as a whole: it is written under another name beside its own and takes its place
/// when all is there.
#include <filesystem>
#include <string>
#include <vector>

#include "bough/io/folder_lock.hpp"
#include "bough/io/manifest.hpp"

namespace bough::io {

/// Rules, for every verb that writes a folder:
///   - One process at a time writes it; another is refused.
///   - What is there and is not bough's (`foreign_entries`), or is read by the same process, is never touched: the
///     constructor refuses.
///   - Files are written into `staging()`. Until `publish` the former results stand whole under the final name, and
///     after it the new ones: one rename, or one exchange of two names, parts them. Where the folder cannot be
///       renamed (a
///     mount point, a parent that cannot be written, the folder that the process stands in) or the file system cannot
///     exchange names, entries are moved one by one, the manifest last; what a kill leaves half-way is put back by the
///     next writer, and told from whole results by its missing manifest.
///   - Results of work that failed never replace good ones: they stand in `<name>.failed` beside, as does what meets
///     files of others at its end.
///   - Folders within that have manifests of their own go along.
/// Throws OutputRefused where it refuses, std::runtime_error or filesystem_error where the system does.
class OutputFolder {
 public:
  /// names: the files that may be written below `staging()`, as in a manifest.
  OutputFolder(std::filesystem::path folder, std::string made_by, std::vector<std::string> names,
               const std::vector<std::filesystem::path>& inputs = {});
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& staging() const { return staging_; }
  /// The same of whoever writes a folder, where somebody does.
  static std::filesystem::path staging_of(const std::filesystem::path& folder);
  /// Where the results stand, as the user named it; after `publish` perhaps `<name>.failed`.
  [[nodiscard]] const std::filesystem::path& folder() const { return shown_; }
  /// Whether `publish` had to leave what stands under the folder's name, and put these results beside it. why_beside:
  /// what that is, in words.
  [[nodiscard]] bool stands_beside() const { return !obstacle_.empty(); }
  [[nodiscard]] std::string why_beside() const { return final_.string() + " " + obstacle_; }

  /// Lists a file that was written below `staging()`.
  void add(FileRecord record) { files_.push_back(std::move(record)); }
  /// Writes a file there and lists it.
  void write(const std::string& name, std::string_view text);
  /// The same of a file that tells of all others: where one of them cannot be made durable, it is taken away, too.
  void write_index(const std::string& name, std::string_view text);

  /// Makes all that is listed durable, together, and gives the results their name. Without a summary to trust, say
  /// after a full disk, they are marked as failed.
  void publish(FolderState state);

 private:
  void claim_staging();
  void make_durable();
  void prepare_staging();
  void settle_former_staging();
  void replace_final(const std::filesystem::path& target);
  void move_entries(const std::filesystem::path& target);
  std::filesystem::path place_beside() const;
  std::string taken_by_another() const;
  std::string obstacle(FolderState state) const;

  std::filesystem::path shown_, final_, staging_;
  std::string made_by_;
  std::vector<std::string> names_;
  std::vector<FileRecord> files_;
  std::string index_;         ///< file that tells of all others
  bool is_in_place_ = false;  ///< staging lies within the final folder
  std::string obstacle_;      ///< why the results stand beside
  bool is_whole_ = false;     ///< all that is wanted of it is in the staging folder
  FolderLock lock_, final_lock_;
};

/// Files of a folder of many results (a batch, several studies), each of which changes by itself. Makes the folder,
/// refuses as OutputFolder.
class OutputCollection {
 public:
  OutputCollection(std::filesystem::path folder, std::string made_by,
                   const std::vector<std::filesystem::path>& inputs = {});
  void write(const std::string& name, std::string_view text) const;
  /// The same, where the file is not there yet: of what many processes write alike.
  void write_once(const std::string& name, std::string_view text) const;
  /// Lists a file that somebody else writes there.
  void list(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::string made_by_;
};

}  // namespace bough::io
