#pragma once
/// Numbers of a page as text: arrays one after the other, compressed by zlib, in base64; also the hash with which a
/// page permits a script.
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace bough::report {

std::string base64(std::string_view bytes);
std::string deflated(std::string_view bytes);  ///< zlib format (RFC 1950)
std::string sha256(std::string_view bytes);    ///< 32 bytes (FIPS 180-4)

/// Arrays, each at a multiple of 8 bytes, and their positions as JSON.
class Arrays {
 public:
  template <class T>
  void add(const std::string& name, const char* type, const std::vector<T>& values) {
    bytes_.resize((bytes_.size() + 7) / 8 * 8);
    list_ += (list_.empty() ? "\"" : ",\"") + name + "\":[\"" + type + "\"," + std::to_string(bytes_.size()) + "," +
             std::to_string(values.size()) + "]";
    const std::size_t at = bytes_.size();
    bytes_.resize(at + values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes_.data() + at, values.data(), values.size() * sizeof(T));
  }
  /// Values of `num_frames` frames, as differences from one to the next modulo 2^24, 2^16 or 2^8, low bytes before high
  /// ones.
  void add_frames(const std::string& name, const std::vector<std::uint32_t>& values, std::size_t num_frames);
  void add_frames(const std::string& name, const std::vector<std::uint16_t>& values, std::size_t num_frames);
  void add_frames(const std::string& name, const std::vector<std::uint8_t>& values, std::size_t num_frames);

  [[nodiscard]] std::string list() const { return "{" + list_ + "}"; }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_, list_;
};

}  // namespace bough::report
