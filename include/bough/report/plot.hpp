#pragma once
/// Histories as small line plots.
#include <string>
#include <vector>

#include "bough/io/history.hpp"

namespace bough::report {

/// One plot of the columns of one sensor over time.
struct Plot {
  std::string svg;
};

/// columns: indices into the header, of one unit. At most two points per pixel column and curve are drawn: the
/// smallest and the largest value, so that no peak is lost. Non-finite values leave a gap. Where no value is above
/// `round_off` the plot says so, and shows a straight line at zero. bands: by column and row of the history, how far
/// values may be off; thin lines show values that much larger and smaller. Empty: nothing is known.
Plot make_plot(const io::History& history, const std::string& title, const std::vector<std::size_t>& columns,
               std::string_view time_label, double round_off = 0.0, const std::vector<std::vector<double>>& bands = {});

/// Round numbers, about `wanted` of them, that cover [low, high] from inside; low < high, both finite.
std::vector<double> round_ticks(double low, double high, int wanted);
/// Their texts, six digits. If neighbouring texts would be equal, all except the roundest show their difference from
/// it.
std::vector<std::string> tick_labels(const std::vector<double>& ticks);

}  // namespace bough::report
