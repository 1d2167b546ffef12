#include "frame_blocks.hpp"

#include <zlib.h>

#include <cstring>
#include <stdexcept>

namespace bough::io {

std::string packed_frame(double time, double turn, std::string_view floats) {
  const std::size_t count = floats.size() / sizeof(float);
  std::string planes(floats.size(), '\0');
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t b = 0; b < sizeof(float); ++b) planes[b * count + k] = floats[sizeof(float) * k + b];
  uLongf room = compressBound(static_cast<uLong>(planes.size()));
  std::string block(frame_head_bytes + room, '\0');
  // Level 1: higher levels take longer and save a twentieth of the bytes.
  if (compress2(reinterpret_cast<Bytef*>(block.data() + frame_head_bytes), &room,
                reinterpret_cast<const Bytef*>(planes.data()), static_cast<uLong>(planes.size()), 1) != Z_OK)
    throw std::runtime_error("zlib cannot compress a picture");
  block.resize(frame_head_bytes + room);
  const std::uint64_t size = room;
  std::memcpy(block.data(), &time, sizeof time);
  std::memcpy(block.data() + sizeof time, &turn, sizeof turn);
  std::memcpy(block.data() + sizeof time + sizeof turn, &size, sizeof size);
  return block;
}

FrameHead frame_head(std::string_view bytes) {
  FrameHead head;
  std::memcpy(&head.time, bytes.data(), sizeof head.time);
  std::memcpy(&head.turn, bytes.data() + sizeof head.time, sizeof head.turn);
  std::memcpy(&head.size, bytes.data() + sizeof head.time + sizeof head.turn, sizeof head.size);
  return head;
}

std::optional<std::string> unpacked_frame(std::string_view packed, std::size_t size) {
  std::string planes(size, '\0');
  uLongf got = static_cast<uLongf>(size);
  if (uncompress(reinterpret_cast<Bytef*>(planes.data()), &got, reinterpret_cast<const Bytef*>(packed.data()),
                 static_cast<uLong>(packed.size())) != Z_OK ||
      got != size)
    return std::nullopt;
  const std::size_t count = size / sizeof(float);
  std::string floats(size, '\0');
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t b = 0; b < sizeof(float); ++b) floats[sizeof(float) * k + b] = planes[b * count + k];
  return floats;
}

}  // namespace bough::io
