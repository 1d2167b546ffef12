#pragma once
/// The one way in which files are read.
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>

namespace bough::io {

inline constexpr std::uint64_t max_file_bytes = 32u << 20u;  ///< of a document: a scene, a sweep, a table of values
inline constexpr std::uint64_t any_size = std::numeric_limits<std::uint64_t>::max();

/// A file that cannot be read. what(): "cannot read <file>: <why>".
class Unreadable : public std::runtime_error {
 public:
  Unreadable(const std::filesystem::path& file, const std::string& why)
      : std::runtime_error("cannot read " + file.string() + ": " + why), why_(why) {}
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  std::string why_;
};

/// A regular file, open to be read. The open never waits, as that of a pipe without a writer would, and the kind and
/// the size of the file are known before its first byte is read: pipes, devices, sockets, folders and files larger than
/// `most_bytes` are refused. All members but size() and path() throw Unreadable.
class InputFile {
 public:
  explicit InputFile(std::filesystem::path file, std::uint64_t most_bytes = any_size);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }  ///< [bytes] when it was opened

  /// Reads up to `count` bytes that begin at `offset`; fewer only at the end of the file. Returns their number.
  std::size_t read(std::uint64_t offset, char* bytes, std::size_t count) const;
  /// The bytes from `offset` to the end of the file, at most `most_bytes` of the constructor.
  [[nodiscard]] std::string text(std::uint64_t offset = 0) const;
  /// The next line without its end, the first one at first; false at the end of the file. The last line may lack its
  /// end: `ends_with_line_end` says whether it did. A line of more than `max_line_bytes` is refused.
  bool next_line(std::string& line);
  [[nodiscard]] bool ends_with_line_end() const { return has_line_end_; }

  static constexpr std::size_t max_line_bytes = std::size_t{256} << 20u;

 private:
  std::filesystem::path path_;
  std::uint64_t size_ = 0, most_bytes_ = 0;
  int descriptor_ = -1;
  std::uint64_t next_offset_ = 0;  ///< of next_line: what follows `buffer_`
  std::string buffer_;             ///< of next_line
  std::size_t taken_ = 0;          ///< bytes of it that lines have taken
  bool has_line_end_ = true;
};

/// All bytes of a file.
std::string read_text(const std::filesystem::path& file, std::uint64_t most_bytes = any_size);

/// "32 MB": a limit of size, in words of a message.
std::string too_large_text(std::uint64_t most_bytes);

}  // namespace bough::io
