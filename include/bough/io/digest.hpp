#pragma once
/// A short hash of bytes, to check that files were written together. It detects accidents, not forgery.
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "bough/records/archive.hpp"

namespace bough::io {

/// A 64-bit hash of all bytes added, in order, independent of their division into pieces. 32 bytes cost four
/// independent multiplications, so that it can be computed for everything that is written.
class Digest {
 public:
  void add(std::string_view bytes);
  /// Sixteen hexadecimal digits.
  std::string text() const;
  std::uint64_t num_bytes() const { return num_bytes_; }
  void checkpoint(records::Archive& archive) { archive(hashes_, rest_, num_bytes_); }

 private:
  template <class T>
  using Stripe = std::array<T, 32 / sizeof(T)>;
  static constexpr std::size_t stripe_size = sizeof(Stripe<char>);
  void mix(const char* stripes, std::size_t count);

  Stripe<std::uint64_t> hashes_ = {14695981039346656037u, 1099511628211u, 2862933555777941757u,
                                   3037000493u};  ///< any that differ
  Stripe<char> rest_ = {};                        ///< bytes that do not fill a stripe yet
  std::uint64_t num_bytes_ = 0;
};

std::string digest_of(std::string_view bytes);
/// Of a whole file. Throws Unreadable (input_file.hpp).
std::string digest_of_file(const std::filesystem::path& path);

}  // namespace bough::io
