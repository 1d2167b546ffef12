#include "error_bands.hpp"

#include <cmath>
#include <limits>

namespace bough::report {

std::vector<std::vector<double>> error_bands(const io::History& history, const io::History& errors) {
  constexpr std::size_t parts = 3;  // extrapolated value, error in time, error of the mesh
  const std::size_t columns = history.header.columns.size(), rows = history.rows.size();
  if (errors.rows.size() != rows || rows == 0 || errors.header.columns.size() != parts * columns) return {};
  std::vector<std::vector<double>> bands(columns, std::vector<double>(rows));
  for (std::size_t c = 0; c < columns; ++c)
    for (std::size_t r = 0; r < rows; ++r) {
      const double in_time = errors.rows[r].values[parts * c + 1], of_mesh = errors.rows[r].values[parts * c + 2];
      const bool has_any = !std::isnan(in_time) || !std::isnan(of_mesh);
      const double sum =
          (std::isnan(in_time) ? 0.0 : std::abs(in_time)) + (std::isnan(of_mesh) ? 0.0 : std::abs(of_mesh));
      bands[c][r] = has_any ? sum : std::numeric_limits<double>::quiet_NaN();
    }
  return bands;
}

}  // namespace bough::report
