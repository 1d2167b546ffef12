#include "bough/io/split_table.hpp"

#include <cmath>

#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"

namespace bough::io {
namespace {

std::string_view name_of(Part part) { return part_names[static_cast<std::size_t>(part)]; }

void append_cells(std::string& text, const SplitTable& table, const SplitSeries& series, const SplitRow& row) {
  if (table.series.size() > 1)
    for (const auto& [name, value] : series.parameters) {
      append_number(text, value);
      text += ',';
    }
  append_number(text, row.at);
  for (const Part part : table.columns) {
    text += ',';
    append_number(text, row.magnitude(part));
  }
  text += '\n';
}

void write_series(JsonText& json, const SplitTable& table, const SplitSeries& series) {
  json.begin_object();
  for (const auto& [name, value] : series.parameters) json.member(name, value);
  json.key(table.abscissa);
  json.begin_array();
  for (const SplitRow& row : series.rows) json.value(row.at);
  json.end_array();
  json.key("magnitudes");
  json.begin_object();
  for (const Part part : table.columns) {
    json.key(name_of(part));
    json.begin_array();
    for (const SplitRow& row : series.rows) json.value(row.magnitude(part));
    json.end_array();
  }
  json.end_object();
  json.key("vectors");
  json.begin_object();
  for (const Part part : table.columns) {
    json.key(name_of(part));
    json.begin_array();
    for (const SplitRow& row : series.rows) {
      json.begin_array();
      for (int k = 0; k < 3; ++k) json.value(row[part][k]);
      json.end_array();
    }
    json.end_array();
  }
  json.end_object();
  json.end_object();
}

}  // namespace

double SplitRow::magnitude(Part p) const {
  const motion::Vec3<double>& a = (*this)[p];
  return std::hypot(a[0], a[1], a[2]);
}

std::string split_csv(const SplitTable& table) {
  std::string text;
  if (table.series.size() > 1)
    for (const auto& [name, value] : table.series.front().parameters) text += name + ",";
  text += table.abscissa;
  for (const Part part : table.columns) text.append(",").append(name_of(part));
  text += '\n';
  for (const SplitSeries& series : table.series)
    for (const SplitRow& row : series.rows) append_cells(text, table, series, row);
  return text;
}

std::string split_json(const SplitTable& table) {
  JsonText json;
  json.begin_object();
  json.member("title", table.title);
  json.member("unit", "m/s^2");
  json.member("seen_from", table.seen_from);
  json.member("axes", table.axes);
  json.key("series");
  json.begin_array();
  for (const SplitSeries& series : table.series) write_series(json, table, series);
  json.end_array();
  json.end_object();
  return json.text();
}

}  // namespace bough::io
