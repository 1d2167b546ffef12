#pragma once
/// Everything about one motion as a table and as JSON.
#include <string>
#include <vector>

#include "bough/motion/describe.hpp"

namespace bough::io {

/// Rows of a table for people: what it is, then its numbers to nine digits, one cell each. What does not exist for
/// this motion (the axis of no rotation, the pitch of a translation) says so.
std::vector<std::vector<std::string>> motion_rows(const motion::MotionReport& report);

/// The report as JSON, numbers that read back to the same bits. What does not exist is left out.
std::string motion_json(const motion::MotionReport& report);

}  // namespace bough::io
