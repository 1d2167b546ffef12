#pragma once
/// Which values of a history are zero but for round-off.
#include <string>
#include <vector>

#include "bough/report/page.hpp"

namespace bough::report {

/// Of each column the magnitude below which its values are zero to round-off: 1e-14 of the largest of its unit in the
/// run. Forces and moments are held against each other by the size of the structure, angles against 1 rad, lengths
/// against that size, rates against what crosses it, or turns by 1 rad, in the time of the run. A column of no unit is
/// held against itself alone, and 0 stands for it.
std::vector<double> round_off_of(const RunFiles& run);

inline constexpr std::string_view round_off_words = "zero to round-off";

}  // namespace bough::report
