#pragma once
/// What writer and reader of motion.bin share.
#include <string>

#include "bough/records/run.hpp"

namespace bough::io {

inline constexpr const char* motion_format = "bough motion 3";

/// Numbers of a frame, float32.
std::size_t frame_floats_of(const records::MotionFrame& frame);
/// The start, float64.
std::string start_of(const records::MotionFrame& frame);

}  // namespace bough::io
