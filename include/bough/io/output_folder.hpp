#pragma once
/// A folder of results that is replaced as a whole: it is written under another name beside its own, and takes its
/// place when it is complete.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bough/io/folder_lock.hpp"
#include "bough/io/manifest.hpp"
#include "bough/io/text_sink.hpp"

namespace bough::io {

/// Rules, for every verb that writes a folder:
///   - Results of another owner (`require_ours`) are replaced only if the owner says so.
///   - One process at a time writes it; another is refused.
///  - What exists and is foreign (`foreign_entries`), or is read by the same process, is never touched: the
///      constructor refuses.
///   - Files are written into `staging()`. The final name has the complete former results until `publish` and the
///      complete new ones after it, by one rename or one exchange of two names. If the folder cannot be renamed (a
///      mount point, a parent that cannot be written, the working directory of the process), or if the file system
///      cannot exchange names, entries are moved one by one, the manifest last. The next writer undoes what a kill
///      left incomplete; until then it is recognised by its missing manifest.
///   - Results of failed work never replace good ones: they are put into `<name>.failed` beside them. The same
///      applies if files of others are found at the end.
///   - Folders within that have manifests of their own are moved along.
/// Throws OutputRefused where it refuses, std::runtime_error or filesystem_error where the system does.
class OutputFolder {
 public:
  /// names: the files that may be written below `staging()`, as in a manifest.
  /// resumed: a place of `unfinished_in`, whose files stay in `staging()` to be gone on with; empty: there is none.
  OutputFolder(std::filesystem::path folder, Owner owner, std::vector<std::string> names,
               const std::vector<std::filesystem::path>& inputs = {}, const std::filesystem::path& resumed = {});
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& staging() const { return staging_; }
  /// Staging folder of the process that presently writes a folder, if there is one.
  static std::filesystem::path staging_of(const std::filesystem::path& folder);
  /// Where results of this owner stand that did not come to their end: those of a writer that was killed, then those
  /// that were published as failed, under the folder's name or beside it.
  static std::vector<std::filesystem::path> unfinished_in(const std::filesystem::path& folder, const Owner& owner);
  /// Gives the rows that a writer had recorded for a folder before it was killed the folder's name, as failed results.
  /// Returns the folder; empty where there are no rows, or where the writer is still at work.
  static std::filesystem::path keep_of_killed(const std::filesystem::path& folder, const Owner& owner);
  /// Where a writer that was killed had left results, which stand beside the folder now; empty: nowhere.
  [[nodiscard]] const std::filesystem::path& kept_of_killed() const { return kept_of_killed_; }
  /// Place of the results, as the user named it; after `publish` perhaps `<name>.failed`.
  [[nodiscard]] const std::filesystem::path& folder() const { return shown_; }
  /// Whether `publish` could not replace what exists under the folder's name and put these results beside it.
  /// why_beside: the reason.
  [[nodiscard]] bool stands_beside() const { return !obstacle_.empty(); }
  [[nodiscard]] std::string why_beside() const { return final_.string() + " " + obstacle_; }

  /// Lists a file that was written below `staging()`.
  void add(FileRecord record) { files_.push_back(std::move(record)); }
  /// Writes a file there and lists it.
  void write(const std::string& name, std::string_view text);
  /// As write(), for a file that describes all others: if one of them cannot be made durable, this one is removed, too.
  void write_index(const std::string& name, std::string_view text);

  /// Makes all listed files durable together, and gives the results their name. Results without a trustworthy summary,
  /// for example after the disk was full, are marked as failed.
  void publish(FolderState state);

 private:
  void claim_staging();
  void take_over(const std::filesystem::path& resumed);
  void remove_added();
  void keep_of_killed();
  void lock_final();
  void make_durable();
  void prepare_staging();
  void settle_former_staging();
  void replace_final(const std::filesystem::path& target);
  void move_entries(const std::filesystem::path& target);
  std::filesystem::path place_beside() const;
  std::string taken_by_another() const;
  std::string obstacle(FolderState state) const;
  Manifest manifest() const;

  std::filesystem::path shown_, final_, staging_, kept_of_killed_;
  Owner owner_;
  std::vector<std::string> names_;
  std::vector<FileRecord> files_;
  std::string index_;         ///< file that describes all others
  bool is_in_place_ = false;  ///< staging lies within the final folder
  std::string obstacle_;      ///< why the results were put beside
  bool is_whole_ = false;     ///< the staging folder is complete
  FolderLock lock_, final_lock_;
};

/// Who writes into a folder of many results at the same time.
enum class Writers {
  one,   ///< the folder is locked until the collection, and all processes forked in the meantime, have ended
  many,  ///< it is locked for each line of its manifest
};

/// Files of a folder with many results (a batch, several studies), each of which is replaced by itself. Makes the
/// folder, and refuses as OutputFolder does.
class OutputCollection {
 public:
  OutputCollection(std::filesystem::path folder, Owner owner, const std::vector<std::filesystem::path>& inputs = {},
                   Writers writers = Writers::many);
  void write(const std::string& name, std::string_view text);
  /// A long text, which is never in memory as a whole.
  void write(const std::string& name, const TextWriter& writer);
  /// For files that many processes write with equal content: written only if it does not exist yet.
  void write_once(const std::string& name, std::string_view text);
  /// Lists a file that another process writes there.
  void list(const std::string& name);
  /// Gives the folder its state, and the files written so far their hashes, with which they were written together. For
  /// one writer: until then the folder is unfinished. If they are good, the former results are removed that
  /// `Owner::replaces` allowed to replace: they stand as a whole under <name>.former until then.
  /// Returns where they are kept, if they are.
  std::optional<std::filesystem::path> publish(FolderState state);

 private:
  void claim();
  void set_aside(const std::filesystem::path& final);
  void record(FileRecord record);

  std::filesystem::path folder_;
  Owner owner_;
  Writers writers_;
  std::vector<FileRecord> written_;  ///< by write(), with hashes
  FolderLock lock_;
};

}  // namespace bough::io
