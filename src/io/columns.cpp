#include "bough/io/columns.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include "bough/io/input_file.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"

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
      sensors.push_back({sensor, {c}, {}});
    else
      found->columns.push_back(c);
  }
  std::vector<ColumnGroup> groups;
  for (const ColumnGroup& sensor : sensors) {
    if (sensor.columns.size() > 6) {
      std::size_t begin = groups.size();
      for (const std::size_t c : sensor.columns) {
        const std::string component = split_column(columns[c]).component;
        const std::string word = component.substr(0, component.find('_'));
        if (groups.size() == begin || groups.back().word != word) groups.push_back({sensor.sensor, {}, word});
        groups.back().columns.push_back(c);
      }
      continue;
    }
    if (sensor.columns.size() != 6) {
      groups.push_back(sensor);
      continue;
    }
    const auto middle = sensor.columns.begin() + 3;
    groups.push_back({sensor.sensor, {sensor.columns.begin(), middle}, {}});
    groups.push_back({sensor.sensor, {middle, sensor.columns.end()}, {}});
  }
  return groups;
}

std::string title_of(const ColumnGroup& group) {
  return group.word.empty() ? group.sensor : group.sensor + ", " + group.word;
}

std::string columns_text(const records::HistoryHeader& header, const records::HistoryHeader* errors) {
  JsonText json;
  const auto column = [&](const std::string& name, const records::HistoryHeader::About& about) {
    json.begin_object();
    json.member("name", name);
    json.member("unit", about.unit);
    json.member("quantity", about.quantity);
    json.member("part", about.part);
    json.end_object();
  };
  const auto list = [&](const char* key, const records::HistoryHeader& of) {
    json.key(key);
    json.begin_array();
    column("time", {of.runs_over_load ? "" : "s", of.runs_over_load ? "load_factor" : "time", ""});
    column("step_size", {of.runs_over_load ? "" : "s", "step_size", ""});
    column("iterations", {"", "iterations", ""});
    for (std::size_t k = 0; k < of.columns.size(); ++k)
      column(of.columns[k], k < of.about.size() ? of.about[k] : records::HistoryHeader::About{});
    json.end_array();
  };
  json.begin_object();
  list("columns", header);
  if (errors != nullptr) list("errors", *errors);
  json.end_object();
  return json.text();
}

void read_columns(const std::filesystem::path& path, records::HistoryHeader& header) {
  if (std::error_code ignored; !std::filesystem::exists(path, ignored)) return;
  const std::string text = read_text(path, max_file_bytes);
  std::vector<JsonFault> faults;
  const std::optional<JsonValue> root = parse_json(text, source_file, faults);
  const JsonValue* list = root && faults.empty() && root->is(JsonKind::object) ? root->find("columns") : nullptr;
  constexpr std::size_t before = 3;  // time, step_size, iterations
  bool good = list != nullptr && list->is(JsonKind::array) && list->items.size() == header.columns.size() + before;
  std::vector<records::HistoryHeader::About> about;
  for (std::size_t k = before; good && k < list->items.size(); ++k) {
    const JsonValue& item = list->items[k];
    const auto member = [&](const char* key) {
      const JsonValue* v = item.is(JsonKind::object) ? item.find(key) : nullptr;
      good = good && v != nullptr && v->is(JsonKind::string);
      return good ? v->text.str() : std::string();
    };
    good = good && member("name") == header.columns[k - before];
    about.push_back({member("unit"), member("quantity"), member("part")});
  }
  if (!good) throw std::runtime_error(path.string() + ": does not describe the columns of history.csv");
  header.about = std::move(about);
}

}  // namespace bough::io
