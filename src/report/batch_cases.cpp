#include "batch_cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/report/batch_page.hpp"

namespace bough::report {
namespace {

using study::CaseResult;

std::string unquoted(const std::string& text) {
  return text.size() >= 2 && text.front() == '"' ? text.substr(1, text.size() - 2) : text;
}

/// Writes the value of an input: a number or a text.
void write_input(io::JsonText& json, const std::string& text) {
  double number = 0.0;
  if (io::read_number(text, number) && std::isfinite(number))
    json.value(number);
  else
    json.value(std::string_view(unquoted(text)));
}

std::string cause_of(const CaseResult& r) { return io::shown(r.cause, 200); }

std::string doubts_of(const CaseResult& r) {
  std::string doubts;
  for (const std::string& d : r.report.doubts) doubts += (doubts.empty() ? "" : ", ") + d;
  return doubts;
}

const std::string* input_of(const CaseResult& r, const std::string& name) {
  const auto at =
      std::find_if(r.which.inputs.begin(), r.which.inputs.end(), [&](const auto& in) { return in.first == name; });
  return at == r.which.inputs.end() ? nullptr : &at->second;
}

std::optional<double> measure_of(const CaseResult& r, const std::string& name) {
  const auto at = std::find_if(r.report.measures.begin(), r.report.measures.end(),
                               [&](const records::MeasureResult& m) { return m.name == name; });
  return at == r.report.measures.end() ? std::nullopt : at->value;
}

}  // namespace

std::vector<Measured> measured_in(const study::CaseTable& results) {
  std::vector<Measured> all;
  for (const study::CaseTable::Measure& measure : results.measures()) {
    Measured m{measure.name, {}, {}, measure.unit, measure.is_indicator};
    const std::vector<std::optional<double>> values = results.values_of(measure.name);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i]) m.cases.push_back(static_cast<std::uint32_t>(i));
    std::stable_sort(m.cases.begin(), m.cases.end(),
                     [&values](std::uint32_t a, std::uint32_t b) { return *values[a] < *values[b]; });
    for (const std::uint32_t i : m.cases) m.values.push_back(*values[i]);
    all.push_back(std::move(m));
  }
  return all;
}

std::vector<std::uint32_t> ended_cases(const study::CaseTable& results, bool goes_on) {
  std::vector<std::uint32_t> ended;
  for (std::size_t i = 0; i < results.size(); ++i)
    if (!goes_on || results.has(i)) ended.push_back(static_cast<std::uint32_t>(i));
  return ended;
}

std::vector<std::size_t> cases_shown(const study::CaseTable& results, const std::vector<std::uint32_t>& ended,
                                     const std::vector<Measured>& measured, std::size_t most) {
  if (ended.size() <= most) return {ended.begin(), ended.end()};
  std::set<std::size_t> chosen;
  for (std::size_t k = 0; chosen.size() < most / 2 && k < ended.size(); ++k) {  // the extreme values, from outside in
    const std::size_t before = chosen.size();
    for (const Measured& m : measured) {
      if (2 * k >= m.cases.size()) continue;
      chosen.insert(m.cases[k]);
      chosen.insert(m.cases[m.cases.size() - 1 - k]);
    }
    if (chosen.size() == before && k > ended.size() / 2) break;
  }
  for (std::size_t i = 0; i < ended.size() && chosen.size() < 3 * most / 4; ++i)
    if (!is_good(results.status(ended[i]))) chosen.insert(ended[i]);
  // A sample at equal distances: cases of random designs have no order.
  const std::size_t left = most - std::min(most, chosen.size());
  for (std::size_t k = 0; k < left; ++k) chosen.insert(ended[k * ended.size() / left]);
  return {chosen.begin(), chosen.end()};
}

Cases cases_of(const study::CaseTable& results, const std::vector<std::uint32_t>& ended,
               const std::vector<Measured>& measured) {
  Cases cases{{}, {"case", "status", "cause", "doubts"}, {}, {}};
  for (const std::size_t i : cases_shown(results, ended, measured, most_cases_shown)) {
    cases.shown.push_back(results.at(i));
    for (const auto& [name, value] : cases.shown.back().which.inputs)
      if (std::find(cases.inputs.begin(), cases.inputs.end(), name) == cases.inputs.end()) cases.inputs.push_back(name);
  }
  cases.columns.insert(cases.columns.end(), cases.inputs.begin(), cases.inputs.end());
  cases.headings = cases.columns;
  for (const Measured& m : measured) {
    cases.columns.push_back(m.name);
    cases.headings.push_back(m.title());
  }
  cases.columns.emplace_back("steps");
  cases.headings.emplace_back("steps");
  return cases;
}

Table case_table(const Cases& cases, const std::vector<Measured>& measured) {
  Table table{cases.headings, {}};
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const CaseResult& r : cases.shown) {
    std::vector<Cell> row{{r.which.name},
                          {std::string(study::text_of(r.status)), is_good(r.status) ? Tone::good : Tone::bad},
                          {cause_of(r)},
                          {doubts_of(r)}};
    for (const std::string& name : cases.inputs) {
      const std::string* text = input_of(r, name);
      double number = none;
      const bool is_text = text != nullptr && !(io::read_number(*text, number) && std::isfinite(number));
      row.push_back(is_text ? Cell{unquoted(*text)} : number_cell(number, 6));
    }
    for (const Measured& m : measured) row.push_back(number_cell(measure_of(r, m.name).value_or(none), 6));
    row.push_back(number_cell(static_cast<double>(r.report.accepted), 9));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string cases_json(const Cases& cases, const std::vector<Measured>& measured) {
  io::JsonText json;
  json.begin_object();
  json.member("inputs", static_cast<long long>(cases.inputs.size()));
  json.key("columns");
  json.begin_array();
  for (const std::string& name : cases.columns) json.value(std::string_view(name));
  json.end_array();
  json.key("headings");
  json.begin_array();
  for (const std::string& heading : cases.headings) json.value(std::string_view(heading));
  json.end_array();
  json.key("numeric");
  json.begin_array();
  for (std::size_t k = 0; k < cases.columns.size(); ++k) json.value(k >= 4);
  json.end_array();
  json.key("rows");
  json.begin_array();
  for (const CaseResult& r : cases.shown) {
    json.begin_array();
    json.value(std::string_view(r.which.name));
    json.value(study::text_of(r.status));
    json.value(std::string_view(cause_of(r)));
    json.value(std::string_view(doubts_of(r)));
    for (const std::string& name : cases.inputs)
      if (const std::string* text = input_of(r, name))
        write_input(json, *text);
      else
        json.raw("null");
    for (const Measured& m : measured)
      if (const std::optional<double> value = measure_of(r, m.name))
        json.value(*value);
      else
        json.raw("null");
    json.value(static_cast<long long>(r.report.accepted));
    json.end_array();
  }
  json.end_array();
  json.end_object();
  return json.text();
}

}  // namespace bough::report
