#include <algorithm>
#include <cmath>
#include <sstream>

#include "bough/io/columns.hpp"
#include "bough/io/history.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"
#include "study_converter.hpp"

namespace bough::io {
namespace {

constexpr double same_time = 1e-9;  // relative to the end of the run: times within it are equal

/// Columns of a CSV file with one header line; `trouble` says what is wrong with it.
struct NumberTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  std::string trouble;
};

NumberTable read_number_table(const std::filesystem::path& file) {
  NumberTable table;
  std::istringstream in;
  try {
    in.str(read_text(file, max_file_bytes));
  } catch (const Unreadable& fault) {
    table.trouble = fault.why();
    return table;
  }
  std::string line;
  std::vector<std::string> fields;
  for (long number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    bool good = split_csv_line(line, fields);
    if (number == 1 && good) {
      table.names = fields;
      continue;
    }
    std::vector<double> row;
    for (const std::string& field : fields) {
      double x = 0.0;
      good = good && read_number(field, x) && std::isfinite(x);
      row.push_back(x);
    }
    if (!good || row.size() != table.names.size()) {
      table.trouble = "line " + std::to_string(number) + " of this file is not " + std::to_string(table.names.size()) +
                      " finite numbers";
      return table;
    }
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) table.trouble = "this file holds no figures";
  return table;
}

}  // namespace

void StudyConverter::read_quantity(const Value& v, const std::string& at) {
  StudyQuantity q;
  q.name = v.find("name")->text;
  q.unit = v.find("unit")->text;
  q.source = v.find("source")->text;
  q.uncertainty = v.find("uncertainty")->number;
  for (const StudyQuantity& other : spec.quantities)
    if (other.name == q.name) fault(at + "/name", "this name is taken already", "names are used once");
  if (find_columns(v, at, q)) {
    read_formula(v, at, q);
    if (const Value* table = v.find("table")) read_table(*table, at + "/table", q);
  }
  spec.quantities.push_back(std::move(q));
}

/// A sensor's columns, and whether they are a rotation.
bool StudyConverter::find_columns(const Value& v, const std::string& at, StudyQuantity& q) {
  const std::string& sensor = v.find("sensor")->text;
  std::vector<std::string> known, components;
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const ColumnName split = split_column(columns_[c]);
    if (known.empty() || known.back() != split.sensor) known.push_back(split.sensor);
    if (split.sensor != sensor) continue;
    all.push_back(c);
    components.push_back(split.component);
  }
  if (all.empty()) {
    fault(at + "/sensor", "no sensor of the scene has this name", did_you_mean(sensor, known));
    return false;
  }
  const Value* wanted = v.find("components");
  if (wanted == nullptr) {
    for (const scene::Sensor& s : base_->sensors) {
      if (s.name != sensor) continue;
      if (s.kind == scene::SensorKind::rotation) q.kind = QuantityKind::rotation;
      if (s.kind == scene::SensorKind::quaternion) q.kind = QuantityKind::quaternion;
    }
    q.columns = all;
    return true;
  }
  for (std::size_t i = 0; i < wanted->items.size(); ++i) {
    const auto found = std::find(components.begin(), components.end(), wanted->items[i].text);
    if (found == components.end()) {
      fault(at + "/components/" + std::to_string(i), "the sensor has no such component",
            did_you_mean(wanted->items[i].text, components));
      return false;
    }
    q.columns.push_back(all[static_cast<std::size_t>(found - components.begin())]);
  }
  return true;
}

void StudyConverter::read_formula(const Value& v, const std::string& at, StudyQuantity& q) {
  const Value* formula = v.find("formula");
  if (formula == nullptr) return;
  for (std::size_t i = 0; i < formula->items.size(); ++i)
    q.formula.push_back(law(formula->items[i], at + "/formula/" + std::to_string(i)));
  if (q.formula.size() != q.columns.size()) {
    fault(at + "/formula", "needs one law for each of the " + std::to_string(q.columns.size()) + " components");
    return;
  }
  const std::vector<double> times = sample_times(spec);
  for (std::size_t i = 0; i < q.formula.size(); ++i) {
    const auto bad =
        std::find_if(times.begin(), times.end(), [&](double t) { return !std::isfinite(q.formula[i].at(t).value); });
    if (bad != times.end())
      fault(at + "/formula/" + std::to_string(i), "the law is not finite at t = " + rounded_text(*bad, 9));
  }
}

void StudyConverter::read_table(const Value& v, const std::string& at, StudyQuantity& q) {
  const std::filesystem::path file = path_of(v.find("file")->text.str());
  const NumberTable table = read_number_table(file);
  if (!table.trouble.empty()) {
    fault(at + "/file", table.trouble, "names are relative to the study's folder: " + shown(file.string(), 200));
    return;
  }
  const auto column = [&](const Value& name, const std::string& here) {
    const auto found = std::find(table.names.begin(), table.names.end(), name.text);
    if (found != table.names.end()) return static_cast<std::size_t>(found - table.names.begin());
    fault(here, "the table has no such column", did_you_mean(name.text, table.names));
    return table.names.size();
  };
  const Value& wanted = *v.find("columns");
  std::vector<std::size_t> columns{column(*v.find("time"), at + "/time")};
  for (std::size_t i = 0; i < wanted.items.size(); ++i)
    columns.push_back(column(wanted.items[i], at + "/columns/" + std::to_string(i)));
  if (std::find(columns.begin(), columns.end(), table.names.size()) != columns.end()) return;
  const bool is_vector = q.kind == QuantityKind::vector;
  if (const std::size_t n = wanted.items.size(); is_vector ? n != q.columns.size() : n != 3 && n != 4) {
    fault(at + "/columns", is_vector
                               ? "needs one column for each of the " + std::to_string(q.columns.size()) + " components"
                               : "needs the 3 columns of a rotation vector or the 4 of a quaternion");
    return;
  }
  for (const double t : sample_times(spec)) {
    const auto row = std::find_if(table.rows.begin(), table.rows.end(), [&](const std::vector<double>& r) {
      return std::abs(r[columns[0]] - t) <= same_time * spec.end;
    });
    // values given at the start are not results
    if (row == table.rows.end() && t == 0.0) continue;
    if (row == table.rows.end()) {
      fault(at + "/file", "the table has no row at the sample time " + rounded_text(t, 9),
            "choose a sample_interval that its times divide");
      return;
    }
    q.table_times.push_back(t);
    q.table_rows.emplace_back();
    for (std::size_t c = 1; c < columns.size(); ++c) q.table_rows.back().push_back((*row)[columns[c]]);
  }
}

}  // namespace bough::io
