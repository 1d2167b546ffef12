#pragma once
/// A file that appears under its name only when it is complete and on disk.
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "bough/io/digest.hpp"

namespace bough::io {

/// What `commit` waits for. now: content and name are on disk. content: the content only. soon: neither, but the system
/// begins to write the content. later: neither.
enum class Durability { now, content, soon, later };

/// Another writer has the file.
class BeingWritten : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes to `<name>.partial` beside the final name; `commit` makes the file durable and renames it. An existing file
/// of the final name stays untouched until then. Without `commit` the destructor removes the partial file; after a
/// crash the next writer takes it over. If the final name is not a regular file (a device, a pipe, a folder), it is
/// refused and left unchanged; a link to a file is replaced, not followed. Every failure (no space, no permission, a
/// second writer) is a std::runtime_error that names the file and the system's reason; of a second writer it is
/// BeingWritten.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path final_path);
  /// Opens what was written of a file before, under either of its names, to go on from a place in it: `checkpoint` has
  /// to be read before anything is written.
  static std::unique_ptr<AtomicFile> reopen(std::filesystem::path final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends to a buffer, which is passed to the system when it is large.
  void write(std::string_view bytes);

  /// Passes the buffer to the system. On failure the file is cut back to the end of the last successful flush and the
  /// buffer is dropped, so that the file is always a sequence of complete flushes.
  void flush();

  /// Flushes, then replaces the first bytes by as many others. The hash is computed again by reading the file.
  void replace_front(std::string_view bytes);

  /// Flushes, and starts writing to the disk without waiting. If several files are started in this way, the first fsync
  /// waits for most of the work of all.
  void start_writing_out();

  /// Writes what goes before to the disk, and its length and hash to the archive. Reading cuts the file back to that
  /// length; throws std::runtime_error if it is shorter, or holds something else there.
  void checkpoint(records::Archive& archive);

  /// Flush, fsync of the file, rename, fsync of the directory. On failure the final name keeps its former content.
  /// content: without the fsync of the directory; soon, later: without both. A caller with many files then calls
  /// `sync_file` on each and `sync_directory` once when all are written.
  void commit(Durability durability = Durability::now);

  /// False after `commit`, and after a failed write that could not be undone.
  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
  [[nodiscard]] std::size_t bytes_flushed() const { return flushed_; }
  /// Hash of the flushed content.
  [[nodiscard]] std::string digest() const { return digest_anew_.empty() ? digest_.text() : digest_anew_; }
  [[nodiscard]] const std::filesystem::path& path() const { return final_path_; }

 private:
  enum class Content { replaced, kept };
  AtomicFile(std::filesystem::path final_path, Content content);
  [[noreturn]] void fail(int error) const;
  void give_up();

  std::filesystem::path final_path_, partial_path_;
  std::string buffer_;
  std::size_t flushed_ = 0;
  Digest digest_;
  std::string digest_anew_;  ///< after the front was replaced
  int descriptor_ = -1;
  bool keeps_ = false;  ///< reopened, and nothing was written since: it is not removed
};

/// Writes a whole text in one go through an `AtomicFile`.
void write_file(const std::filesystem::path& path, std::string_view text, Durability durability = Durability::now);

/// Makes the content of a file that is already there durable.
void sync_file(const std::filesystem::path& path);

/// Makes the entries of a directory (a rename, a removal) durable; file systems that do not support this are ignored.
void sync_directory(const std::filesystem::path& directory);

}  // namespace bough::io
