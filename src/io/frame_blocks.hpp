#pragma once
/// Frames of motion.bin as compressed blocks.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace bough::io {

/// One frame in the format of the file: time and turn (float64), number of packed bytes (uint64), packed bytes. These are the
/// float32 numbers, compressed by zlib: the lowest bytes of all numbers first, then the next ones, up to the highest.
/// Bytes of equal significance are similar, so this order halves the size.
std::string packed_frame(double time, double turn, std::string_view floats);

struct FrameHead {
  double time = 0.0;
  double turn = 0.0;       ///< since the frame before [rad]
  std::uint64_t size = 0;  ///< of the packed bytes that follow
};
inline constexpr std::size_t frame_head_bytes = 24;
FrameHead frame_head(std::string_view bytes);

/// The bytes of a frame's float32 numbers in their order in memory; nullopt if they are not `size` bytes.
std::optional<std::string> unpacked_frame(std::string_view packed, std::size_t size);

}  // namespace bough::io
