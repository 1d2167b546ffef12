#include "bough/io/digest.hpp"

#include <bit>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace bough::io {

static_assert(std::endian::native == std::endian::little, "whole words are read as they stand in memory");

/// A step of FNV-1a on words instead of bytes; the rotation carries high bits down, which a product alone never does.
void Digest::mix(std::uint64_t word) {
  constexpr std::uint64_t prime = 0x9E3779B97F4A7C15u;
  hash_ = std::rotl((hash_ ^ word) * prime, 29);
}

void Digest::add(std::string_view bytes) {
  constexpr std::size_t size = sizeof word_;
  while (!bytes.empty()) {
    const std::size_t filled = num_bytes_ % size;
    if (filled == 0 && bytes.size() >= size) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data(), size);
      mix(word);
      num_bytes_ += size;
      bytes.remove_prefix(size);
      continue;
    }
    word_ |= std::uint64_t{static_cast<unsigned char>(bytes.front())} << (8 * filled);
    ++num_bytes_;
    bytes.remove_prefix(1);
    if (filled + 1 < size) continue;
    mix(word_);
    word_ = 0;
  }
}

std::string Digest::text() const {
  Digest end = *this;
  end.mix(word_);
  end.mix(num_bytes_);
  end.mix(0);
  std::string digits(16, '0');
  for (std::size_t k = 16; k-- > 0; end.hash_ >>= 4u) digits[k] = "0123456789abcdef"[end.hash_ & 15u];
  return digits;
}

std::string digest_of(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.text();
}

std::string digest_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  Digest digest;
  std::vector<char> buffer(std::size_t{1} << 16);
  while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || file.gcount() > 0)
    digest.add({buffer.data(), static_cast<std::size_t>(file.gcount())});
  if (!file.eof()) throw std::runtime_error("cannot read " + path.string());
  return digest.text();
}

}  // namespace bough::io
