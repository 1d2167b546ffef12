#pragma once
/// Frames of motion.bin as compressed blocks.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace bough::io {

/// One frame as it stands in the file:  time (float64), number of packed bytes (uint64), packed bytes: the float32
/// numbers, their lowest bytes first, then the next ones up to the highest, compressed by zlib. Bytes of one place
/// are alike, which halves the size.
std::string packed_frame(double time, std::string_view floats);

struct FrameHead {
  double time = 0.0;
  std::uint64_t size = 0;  ///< of the packed bytes that follow
};
inline constexpr std::size_t frame_head_bytes = 16;
FrameHead frame_head(std::string_view bytes);

/// The numbers of a frame, float32 as they stand in memory; nullopt where the bytes hold anything else than `size` of
/// them.
std::optional<std::string> unpacked_frame(std::string_view packed, std::size_t size);

}  // namespace bough::io
