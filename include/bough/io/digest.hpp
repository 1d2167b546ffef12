#pragma once
/// A short hash of bytes, to tell whether files are those that were written together. It finds accidents, no forgery.
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace bough::io {

/// 64 bits of whatever was added, in order; how it was cut into pieces does not matter. Eight bytes cost one
/// multiplication, so that it may run beside everything that is written.
class Digest {
 public:
  void add(std::string_view bytes);
  /// Sixteen hexadecimal digits.
  std::string text() const;
  std::uint64_t num_bytes() const { return num_bytes_; }

 private:
  void mix(std::uint64_t word);

  std::uint64_t hash_ = 14695981039346656037u, num_bytes_ = 0;
  std::uint64_t word_ = 0;  ///< bytes that do not fill a word yet, the first one lowest
};

std::string digest_of(std::string_view bytes);
/// Of a whole file. Throws std::runtime_error where it cannot be read.
std::string digest_of_file(const std::filesystem::path& path);

}  // namespace bough::io
