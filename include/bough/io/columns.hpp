#pragma once
/// Names of history columns: "<sensor>.<component>" or "<sensor>".
#include <string>
#include <string_view>
#include <vector>

namespace bough::io {

struct ColumnName {
  std::string sensor, component;  ///< component empty: a scalar sensor
};
ColumnName split_column(std::string_view column);

/// Columns of one sensor that share a unit and so one scale and one plot. Six components are two groups of three: forces and moments,
/// displacements and rotations.
struct ColumnGroup {
  std::string sensor;
  std::vector<std::size_t> columns;  ///< indices
};
std::vector<ColumnGroup> group_columns(const std::vector<std::string>& columns);

}  // namespace bough::io
