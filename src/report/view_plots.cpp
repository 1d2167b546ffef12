#include "view_plots.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/columns.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"

namespace bough::report {
namespace {

constexpr std::size_t most_groups = 1500, most_plots = 64;

/// Rows that are kept, in order; the first and the last among them.
std::vector<std::size_t> rows_of(const io::History& history, const std::vector<std::size_t>& columns) {
  const std::size_t n = history.rows.size();
  std::vector<std::size_t> rows;
  if (n <= 2 * most_groups) {
    for (std::size_t k = 0; k < n; ++k) rows.push_back(k);
    return rows;
  }
  for (std::size_t g = 0; g < most_groups; ++g) {
    const std::size_t begin = g * n / most_groups, end = (g + 1) * n / most_groups;
    rows.push_back(begin);
    for (const std::size_t c : columns) {
      std::size_t low = begin, high = begin;
      for (std::size_t k = begin; k < end; ++k) {
        const double v = history.rows[k].values[c];
        if (v < history.rows[low].values[c]) low = k;
        if (v > history.rows[high].values[c]) high = k;
      }
      rows.push_back(low);
      rows.push_back(high);
    }
  }
  rows.push_back(n - 1);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

/// A number near values that vary by less than a thousandth of themselves: single precision would show them in stairs.
/// 0 where they vary more.
double middle_of(const std::vector<double>& values) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const double v : values)
    if (std::isfinite(v)) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  const bool varies_little = high > low && high - low < 1e-3 * std::max(std::abs(low), std::abs(high));
  return varies_little ? low + 0.5 * (high - low) : 0.0;
}

}  // namespace

std::string plot_data(const io::History& history, const std::vector<double>& round_off,
                      const std::vector<std::vector<double>>& bands, Arrays& arrays) {
  std::string json = "[";
  if (history.rows.empty()) return json + "]";
  const std::vector<io::ColumnGroup> groups = io::group_columns(history.header.columns);
  for (std::size_t g = 0; g < std::min(groups.size(), most_plots); ++g) {
    const io::ColumnGroup& group = groups[g];
    const std::vector<std::size_t> rows = rows_of(history, group.columns);
    const std::string prefix = "p" + std::to_string(g);
    std::vector<double> times;
    for (const std::size_t r : rows) times.push_back(history.rows[r].time);
    arrays.add(prefix, "f64", times);
    const records::HistoryHeader::About about = group.columns.front() < history.header.about.size()
                                                    ? history.header.about[group.columns.front()]
                                                    : records::HistoryHeader::About{};
    json += (g > 0 ? ",{" : "{") + ("\"title\":" + io::json_string(io::title_of(group))) +
            ",\"unit\":" + io::json_string(about.unit) + ",\"part\":" + io::json_string(about.part) +
            ",\"roundOff\":" + io::rounded_text(round_off[group.columns.front()], 3) + ",\"times\":\"" + prefix +
            "\",\"columns\":[";
    for (std::size_t k = 0; k < group.columns.size(); ++k) {
      const std::size_t c = group.columns[k];
      std::vector<double> exact;
      for (const std::size_t r : rows) exact.push_back(history.rows[r].values[c]);
      const double middle = middle_of(exact);
      std::vector<float> values;
      for (const double v : exact) values.push_back(static_cast<float>(v - middle));
      const std::string name = prefix + "." + std::to_string(k);
      arrays.add(name, "f32", values);
      json += (k > 0 ? ",{" : "{") +
              ("\"label\":" + io::json_string(io::split_column(history.header.columns[c]).component)) +
              ",\"values\":\"" + name + "\"";
      if (middle != 0.0) {
        json += ",\"from\":";
        io::append_number(json, middle);
      }
      if (!bands.empty()) {
        std::vector<float> band;
        for (const std::size_t r : rows) band.push_back(static_cast<float>(bands[c][r]));
        arrays.add(name + ".e", "f32", band);
        json += ",\"errors\":\"" + name + ".e\"";
      }
      json += '}';
    }
    json += "]}";
  }
  return json + "]";
}

}  // namespace bough::report
