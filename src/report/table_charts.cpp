#include "table_charts.hpp"

#include <algorithm>

namespace bough::report {

namespace {

constexpr std::size_t most_curves = 8;

double number_of(const records::Table::Cell& cell) {
  const double* number = std::get_if<double>(&cell);
  return number != nullptr ? *number : 0.0;
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " [" + unit + "]";
}

/// Curves over the first column of the columns of one unit whose name ends so, without that ending.
std::vector<Chart> over_frequency(const records::Table& table, const std::string& ending, const std::string& quantity,
                                  Scale scale) {
  std::vector<Chart> charts;
  std::vector<std::string> units;
  const bool is_even = table.rows.size() > 2 && number_of(table.rows.front()[0]) > 0.0 &&
                       number_of(table.rows.back()[0]) > 8.0 * number_of(table.rows.front()[0]);
  for (std::size_t c = 1; c < table.columns.size(); ++c) {
    const records::Table::Column& column = table.columns[c];
    if (column.name.size() < ending.size() ||
        column.name.compare(column.name.size() - ending.size(), ending.size(), ending) != 0)
      continue;
    auto unit = std::find(units.begin(), units.end(), column.unit);
    if (unit == units.end()) {
      charts.push_back({with_unit(quantity, column.unit),
                        {with_unit(table.columns[0].name, table.columns[0].unit), is_even ? Scale::log : Scale::linear},
                        {with_unit(quantity, column.unit), scale},
                        {}});
      unit = units.insert(units.end(), column.unit);
    }
    Chart& chart = charts[static_cast<std::size_t>(unit - units.begin())];
    if (chart.series.size() == most_curves) continue;
    ChartSeries& series = chart.series.emplace_back();
    series.name = column.name.substr(0, column.name.size() - ending.size());
    series.has_marks = table.rows.size() <= 40;
    for (const auto& row : table.rows) series.points.push_back({number_of(row[0]), number_of(row[c])});
  }
  return charts;
}

/// Removes curves of amplitudes that are round-off beside the largest of their chart, and their phases.
void leave_out_round_off(std::vector<Chart>& amplitudes, std::vector<Chart>& phases) {
  constexpr double round_off = 1e-9;
  const auto largest_of = [](const ChartSeries& series) {
    double most = 0.0;
    for (const ChartPoint& p : series.points) most = std::max(most, p.y);
    return most;
  };
  for (Chart& chart : amplitudes) {
    double most = 0.0;
    for (const ChartSeries& series : chart.series) most = std::max(most, largest_of(series));
    std::erase_if(chart.series, [&](const ChartSeries& series) {
      if (largest_of(series) > round_off * most) return false;
      for (Chart& phase : phases)
        std::erase_if(phase.series, [&](const ChartSeries& other) { return other.name == series.name; });
      return true;
    });
  }
}

/// A curve a branch over the values, with the lines of excitations.
Chart over_values(const records::Table& table, std::size_t quantity, bool with_lines) {
  Chart chart{with_unit(table.columns[quantity].name, table.columns[quantity].unit),
              {"value"},
              {with_unit(table.columns[quantity].name, table.columns[quantity].unit)},
              {}};
  double most = 0.0;
  for (const auto& row : table.rows)
    if (std::get<std::string>(row[0]).back() != 'x') most = std::max(most, number_of(row[quantity]));
  for (const auto& row : table.rows) {
    const std::string& branch = std::get<std::string>(row[0]);
    const bool is_line = branch.back() == 'x';
    if (is_line && (!with_lines || number_of(row[quantity]) > 1.05 * most)) continue;
    if (chart.series.empty() || chart.series.back().name != branch) {
      if (chart.series.size() == 24) break;
      chart.series.push_back({branch, {}});
      chart.series.back().has_marks = !is_line;
    }
    chart.series.back().points.push_back(
        {number_of(row[1]), number_of(row[quantity]), std::get<std::string>(row.back())});
  }
  return chart;
}

}  // namespace

std::vector<Chart> charts_of(const records::Table& table) {
  std::vector<Chart> charts;
  if (table.rows.size() < 2) return charts;
  if (table.name == "response") {
    charts = over_frequency(table, " amplitude", "amplitude", Scale::log);
    std::vector<Chart> phases = over_frequency(table, " phase", "phase", Scale::linear);
    leave_out_round_off(charts, phases);
    for (Chart& phase : phases) charts.push_back(std::move(phase));
  } else if (table.name == "spectra") {
    charts = over_frequency(table, "", "density", Scale::log);
  } else if (table.name == "campbell") {
    charts.push_back(over_values(table, 2, true));
    charts.push_back(over_values(table, 5, false));
  }
  return charts;
}

}  // namespace bough::report
