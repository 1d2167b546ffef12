#pragma once
/// Histories of a run for the script of a view.
#include <string>

#include "bough/io/history.hpp"
#include "packed.hpp"

namespace bough::report {

/// One entry a plot (view_data.hpp), its numbers added to the arrays: at most 1500 groups of rows of equal length in
/// time, of each those rows that hold the smallest and the largest value of a column, so that no peak is lost.
/// round_off: of each column the magnitude below which it is zero (round_off.hpp).
/// bands: of each column how far its values may be off (error_bands.hpp); empty: nothing is known.
std::string plot_data(const io::History& history, const std::vector<double>& round_off,
                      const std::vector<std::vector<double>>& bands, Arrays& arrays);

}  // namespace bough::report
