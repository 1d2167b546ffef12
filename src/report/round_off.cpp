#include "round_off.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "bough/report/projection.hpp"

namespace bough::report {
namespace {

constexpr double share = 1e-14;  // about fifty units in the last place of the related quantity

/// The largest extent of all recorded motion; without it, the largest length that a sensor shows.
double size_of(const RunFiles& run, double largest_length) {
  const Box box = box_of(run.motion);
  double size = 0.0;
  for (std::size_t c = 0; c < 3 && !box.empty; ++c) size = std::max(size, box.high[c] - box.low[c]);
  return size > 0.0 ? size : largest_length;
}

}  // namespace

std::vector<double> round_off_of(const RunFiles& run) {
  const records::HistoryHeader& header = run.history.header;
  const auto unit_of = [&](std::size_t c) { return c < header.about.size() ? header.about[c].unit : std::string(); };
  std::map<std::string, double> largest;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    double& most = largest[unit_of(c)];
    for (const records::HistoryRow& row : run.history.rows)
      if (std::isfinite(row.values[c])) most = std::max(most, std::abs(row.values[c]));
  }
  const double size = size_of(run, largest["m"]);
  const double duration =
      run.history.rows.empty() || is_static(run) ? 0.0 : run.history.rows.back().time - run.history.rows.front().time;
  const auto at_least = [&](const char* unit, double value) {
    if (std::isfinite(value)) largest[unit] = std::max(largest[unit], value);
  };
  const double force = largest["N"], moment = largest["N m"];
  if (size > 0.0) {
    at_least("N", moment / size);
    at_least("N m", force * size);
    at_least("m", size);
  }
  at_least("rad", 1.0);
  if (duration > 0.0) {
    at_least("m/s", size / duration);
    at_least("rad/s", 1.0 / duration);
    at_least("m/s^2", size / (duration * duration));
    at_least("rad/s^2", 1.0 / (duration * duration));
  }
  std::vector<double> least;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const std::string unit = unit_of(c);
    least.push_back(unit.empty() ? 0.0 : share * largest[unit]);
  }
  return least;
}

}  // namespace bough::report
