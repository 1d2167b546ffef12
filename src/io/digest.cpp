#include "bough/io/digest.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "bough/io/input_file.hpp"

namespace bough::io {

static_assert(std::endian::native == std::endian::little, "whole words are read as they stand in memory");

namespace {

/// A step of FNV-1a on words instead of bytes. The rotation moves high bits down, which a product alone never does.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  constexpr std::uint64_t prime = 0x9E3779B97F4A7C15u;
  return std::rotl((hash ^ word) * prime, 29);
}

}  // namespace

/// The hashes of the words in a stripe are independent of each other and stay in registers from stripe to stripe.
void Digest::mix(const char* stripes, std::size_t count) {
  Stripe<std::uint64_t> hashes = hashes_, words;
  for (; count-- > 0; stripes += stripe_size) {
    std::memcpy(words.data(), stripes, stripe_size);
    for (std::size_t k = 0; k < words.size(); ++k) hashes[k] = mixed(hashes[k], words[k]);
  }
  hashes_ = hashes;
}

void Digest::add(std::string_view bytes) {
  const std::size_t filled = num_bytes_ % stripe_size;
  num_bytes_ += bytes.size();
  if (filled > 0) {
    const std::size_t taken = std::min(stripe_size - filled, bytes.size());
    std::memcpy(rest_.data() + filled, bytes.data(), taken);
    bytes.remove_prefix(taken);
    if (filled + taken < stripe_size) return;
    mix(rest_.data(), 1);
  }
  const std::size_t whole = bytes.size() / stripe_size;
  mix(bytes.data(), whole);
  bytes.remove_prefix(whole * stripe_size);
  std::copy(bytes.begin(), bytes.end(), rest_.begin());
}

std::string Digest::text() const {
  Digest end = *this;
  std::fill(end.rest_.begin() + static_cast<std::ptrdiff_t>(num_bytes_ % stripe_size), end.rest_.end(), '\0');
  end.mix(end.rest_.data(), 1);
  std::uint64_t hash = mixed(0, num_bytes_);
  for (const std::uint64_t of_words : end.hashes_) hash = mixed(hash, of_words);
  hash = mixed(hash, 0);
  std::string digits(16, '0');
  for (std::size_t k = 16; k-- > 0; hash >>= 4u) digits[k] = "0123456789abcdef"[hash & 15u];
  return digits;
}

std::string digest_of(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.text();
}

std::string digest_of_file(const std::filesystem::path& path) {
  const InputFile file(path);
  Digest digest;
  std::vector<char> buffer(std::size_t{1} << 16);
  while (const std::size_t count = file.read(digest.num_bytes(), buffer.data(), buffer.size()))
    digest.add({buffer.data(), count});
  return digest.text();
}

}  // namespace bough::io
