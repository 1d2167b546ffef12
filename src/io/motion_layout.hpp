#pragma once
/// Definitions shared by the writer and the reader of motion.bin.
#include <algorithm>
#include <string>

#include "bough/motion/types.hpp"
#include "bough/records/run.hpp"

namespace bough::io {

inline constexpr const char* motion_format = "bough motion 4";

/// Number of float32 values of a frame.
std::size_t frame_floats_of(const records::MotionFrame& frame);
/// The motion at the start, float64.
std::string start_of(const records::MotionFrame& frame);

/// The rotation whose nine entries are given row by row.
inline motion::Mat3<double> matrix_of(const double* axes) {
  motion::Mat3<double> R;
  std::copy_n(axes, 9, R.m);
  return R;
}

}  // namespace bough::io
