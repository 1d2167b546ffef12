#pragma once
/// Parts of accelerations as line plots.
#include <string>

#include "bough/io/split_table.hpp"

namespace bough::report {

/// Magnitudes over the abscissa, one panel a series, on equal axes from 0; parts that are zero throughout (below
/// 1e-12 of the largest) are left out. A file of its own, with the styles for light and dark.
std::string split_svg(const io::SplitTable& table);

}  // namespace bough::report
