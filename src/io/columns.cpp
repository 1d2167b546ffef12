#include "bough/io/columns.hpp"

#include <algorithm>

namespace bough::io {

ColumnName split_column(std::string_view column) {
  const std::size_t dot = column.rfind('.');
  if (dot == std::string_view::npos || dot == 0 || dot + 1 == column.size()) return {std::string(column), ""};
  return {std::string(column.substr(0, dot)), std::string(column.substr(dot + 1))};
}

std::vector<ColumnGroup> group_columns(const std::vector<std::string>& columns) {
  std::vector<ColumnGroup> sensors;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string sensor = split_column(columns[c]).sensor;
    const auto found =
        std::find_if(sensors.begin(), sensors.end(), [&](const ColumnGroup& g) { return g.sensor == sensor; });
    if (found == sensors.end())
      sensors.push_back({sensor, {c}});
    else
      found->columns.push_back(c);
  }
  std::vector<ColumnGroup> groups;
  for (const ColumnGroup& sensor : sensors) {
    if (sensor.columns.size() != 6) {
      groups.push_back(sensor);
      continue;
    }
    const auto middle = sensor.columns.begin() + 3;
    groups.push_back({sensor.sensor, {sensor.columns.begin(), middle}});
    groups.push_back({sensor.sensor, {middle, sensor.columns.end()}});
  }
  return groups;
}

}  // namespace bough::io
