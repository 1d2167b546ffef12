#pragma once
/// Accelerations of a point split into their parts, as CSV and JSON.
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bough/motion/types.hpp"

namespace bough::io {

/// The parts in the order of columns; the last is the sum of the others.
enum class Part { centripetal, razi, coriolis, tangential, local, origin, total };
inline constexpr std::array<std::string_view, 7> part_names = {"centripetal", "razi",   "coriolis", "tangential",
                                                               "local",       "origin", "total"};

/// One place of one series.
struct SplitRow {
  double at = 0.0;                              ///< of the abscissa
  std::array<motion::Vec3<double>, 7> parts{};  ///< by Part [m/s^2]
  const motion::Vec3<double>& operator[](Part p) const { return parts[static_cast<std::size_t>(p)]; }
  double magnitude(Part p) const;
};

/// Rows along the abscissa, and the parameters that are fixed.
struct SplitSeries {
  std::vector<std::pair<std::string, double>> parameters;
  std::vector<SplitRow> rows;
};

struct SplitTable {
  std::string title;
  std::string abscissa;         ///< name of its column: "psi_deg", "time"
  std::string seen_from, axes;  ///< the observer and the axes of the vectors, in words
  std::vector<Part> columns;    ///< those that are written
  std::vector<SplitSeries> series;
};

/// `<abscissa>,<part>,...`: magnitudes [m/s^2], shortest numbers that read back to the same bits. With several series
/// the first columns hold their parameters.
std::string split_csv(const SplitTable& table);

/// Magnitudes and vectors with the observer and the axes; one object a series, one array a column.
std::string split_json(const SplitTable& table);

}  // namespace bough::io
