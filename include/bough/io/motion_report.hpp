#pragma once
/// Everything about one motion as a table and as JSON.
#include <string>
#include <vector>

#include "bough/motion/describe.hpp"

namespace bough::io {

/// Rows of a table for people: the name of a quantity, then its numbers to nine digits, one per cell. For a quantity
/// that does not exist (the axis of no rotation, the pitch of a translation) the row says so.
std::vector<std::vector<std::string>> motion_rows(const motion::MotionReport& report);

/// The report as JSON, with numbers that read back to the same bits. Quantities that do not exist are omitted.
std::string motion_json(const motion::MotionReport& report);

}  // namespace bough::io
