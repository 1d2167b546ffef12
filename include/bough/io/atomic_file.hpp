#pragma once
/// A file that appears under its name only when it is whole and on disk.
#include <filesystem>
#include <string>
#include <string_view>

#include "bough/io/digest.hpp"

namespace bough::io {

/// What `commit` waits for: now: the content and the name are on disk; content: the content alone; soon: neither, but
/// the disk begins to take the content; later: neither.
enum class Durability { now, content, soon, later };

/// Writes to `<name>.partial` beside the final name; `commit` makes it durable and renames it. A former file of the
/// final name stays untouched until then. Without `commit` the destructor removes the partial file; after a crash the
/// next writer takes it over. A name that is taken by anything but a file (a device, a pipe, a folder) is refused and
/// left as it is; a link to a file is replaced, not followed. Every failure (no space, no permission, a second
/// writer) is a std::runtime_error that names the file and the system's reason.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends to a buffer that is handed to the system when it is large.
  void write(std::string_view bytes);

  /// Hands the buffer to the system. On failure the file is cut back to the end of the last flush that went through
  /// and the buffer is dropped, so that what is in the file is always a sequence of whole flushes.
  void flush();

  /// Flush, then other bytes in the place of as many first ones. The hash is taken anew, by reading the file.
  void replace_front(std::string_view bytes);

  /// Flush, and the disk begins to take what was flushed; nobody waits for it. Of several files that are handed over
  /// so, the first fsync waits for all, and those after it find little left to do.
  void start_writing_out();

  /// Flush, fsync of the file, rename, fsync of the directory. On failure the final name keeps its former content.
  /// content: without the fsync of the directory; soon, later: without both. Whoever writes many files calls
  /// `sync_file` on each that lacks it and `sync_directory` once when all are written.
  void commit(Durability durability = Durability::now);

  /// False after `commit`, and where a failed write could not be undone.
  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
  [[nodiscard]] std::size_t buffered() const { return buffer_.size(); }
  [[nodiscard]] std::size_t bytes_flushed() const { return flushed_; }
  /// Of what was flushed.
  [[nodiscard]] std::string digest() const { return digest_anew_.empty() ? digest_.text() : digest_anew_; }
  [[nodiscard]] const std::filesystem::path& path() const { return final_path_; }

 private:
  [[noreturn]] void fail(int error) const;
  void give_up();

  std::filesystem::path final_path_, partial_path_;
  std::string buffer_;
  std::size_t flushed_ = 0;
  Digest digest_;
  std::string digest_anew_;  ///< after the front was replaced
  int descriptor_ = -1;
};

/// Writes a whole text in one go through an `AtomicFile`.
void write_file(const std::filesystem::path& path, std::string_view text, Durability durability = Durability::now);

/// Makes the content of a file that is already there durable.
void sync_file(const std::filesystem::path& path);

/// Makes the entries of a directory (a rename, a removal) durable; file systems that cannot do so are let pass.
void sync_directory(const std::filesystem::path& directory);

}  // namespace bough::io
