#pragma once
/// Difference of two histories, column by column.
#include <string>
#include <vector>

#include "bough/io/history.hpp"

namespace bough::io {

struct CompareOptions {
  double relative = 1e-9;  ///< largest difference over the column's scale, >= 0
  double absolute = 0.0;   ///< smaller differences are accepted whatever the scale [unit of the column], >= 0
};

/// Largest differences of one column:
///   absolute = max_i |a_i - b_i|,   relative = absolute / scale.
/// scale: the largest range max - min in A among the components of the sensor that share a unit (so a coordinate that
/// stays at zero is measured by the motion of the point); the largest magnitude if nothing moves. 0/0 is 0.
struct ColumnDifference {
  std::string name;
  double absolute = 0.0, relative = 0.0, scale = 0.0;
  double time = 0.0;            ///< of the largest difference
  bool is_judged = true;        ///< false: iterations and step counts, which are shown only
  bool has_non_finite = false;  ///< in either file: never equal
  bool holds = false;
};

struct Comparison {
  std::vector<ColumnDifference> columns;
  std::vector<std::string> problems;  ///< missing columns, different numbers of rows: never equal
  bool equal = false;
};

/// Compares the common columns over rows of equal times; where times do not grow, over the first rows of both.
Comparison compare_histories(const History& a, const History& b, const CompareOptions& options);

}  // namespace bough::io
