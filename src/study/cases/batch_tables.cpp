#include <unordered_map>
#include <utility>

#include "bough/io/history.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"
#include "bough/study/batch.hpp"

namespace bough::study {
namespace {

/// An input is JSON text: a number or a word as it is, a string without its quotes.
std::string input_field(const std::string& json) {
  double number = 0.0;
  if (io::read_number(json, number)) return json;
  return io::csv_field(json.size() >= 2 && json.front() == '"' ? json.substr(1, json.size() - 2) : json);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : "; ") + w;
  return text;
}

/// Names in the order of their first occurrence in the cases.
class Columns {
 public:
  void add(const std::string& name) {
    if (index_.try_emplace(name, names_.size()).second) names_.push_back(name);
  }
  const std::vector<std::string>& names() const { return names_; }
  std::size_t at(const std::string& name) const { return index_.at(name); }

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::size_t> index_;
};

void append_cells(std::string& text, const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) text += ',' + cell;
}

}  // namespace

void write_batch_csv(const CaseTable& results, const io::TextSink& sink,
                     const std::function<std::string(std::size_t)>& machine_of) {
  Columns inputs, measures;
  for (std::size_t i = 0; i < results.size(); ++i)
    for (const auto& [name, value] : results.cases().at(i).inputs) inputs.add(name);
  for (const CaseTable::Measure& m : results.measures()) measures.add(m.name);
  std::string text =
      "case,status,cause,steps_accepted,steps_rejected,newton_iterations,expected_holds,expected_fails,doubts,"
      "energy_error,constraint_error";
  for (const Columns* columns : {&inputs, &measures})
    for (const std::string& name : columns->names()) text += ',' + io::csv_field(name);
  text += machine_of ? ",machine\n" : "\n";
  for (std::size_t i = 0; i < results.size(); ++i) {
    const CaseResult r = results.at(i);
    text += io::csv_field(r.which.name) + ',' + std::string(text_of(r.status)) + ',' + io::csv_field(r.cause);
    for (const long n : {r.report.accepted, r.report.rejected, r.report.newton_iterations,
                         static_cast<long>(r.report.expected_holds), static_cast<long>(r.report.expected_fails)})
      text += ',' + std::to_string(n);
    text += ',' + io::csv_field(joined(r.report.doubts));
    for (const std::optional<double>& x : {r.report.energy_error, r.report.constraint_error}) {
      text += ',';
      if (x) io::append_rounded(text, *x, 6);
    }
    std::vector<std::string> in(inputs.names().size()), out(measures.names().size());
    for (const auto& [name, value] : r.which.inputs) in[inputs.at(name)] = input_field(value);
    for (const records::MeasureResult& m : r.report.measures)
      if (m.value) io::append_number(out[measures.at(m.name)], *m.value);
    append_cells(text, in);
    append_cells(text, out);
    if (machine_of) text += ',' + machine_of(i);
    text += '\n';
    sink(text);
    text.clear();
  }
  sink(text);  // the head, where there is no case
}

namespace {

void write_index(io::JsonText& json, const Index& index) {
  json.begin_object();
  json.member("value", index.value);
  if (index.low) json.member("low", *index.low);
  if (index.high) json.member("high", *index.high);
  json.end_object();
}

void write_sensitivities(io::JsonText& json, const std::vector<MeasureSensitivity>& sensitivities) {
  json.key("sensitivities");
  json.begin_array();
  for (const MeasureSensitivity& s : sensitivities) {
    json.begin_object();
    json.member("measure", std::string_view(s.measure));
    json.member("method", std::string_view(s.of.method));
    json.member("cases", static_cast<long long>(s.of.rows));
    if (s.of.explained) json.member("explained", *s.of.explained);
    if (s.of.explained_ranks) json.member("explained_ranks", *s.of.explained_ranks);
    for (std::size_t i = 0; i < s.of.indices.size(); ++i) {
      json.key(s.of.indices[i]);
      json.begin_object();
      for (std::size_t k = 0; k < s.variables.size(); ++k) {
        json.key(s.variables[k]);
        write_index(json, s.of.values[i][k]);
      }
      json.end_object();
    }
    json.end_object();
  }
  json.end_array();
}

/// Of measures that have one, by name, for a table says nothing of them.
void write_units(io::JsonText& json, const CaseTable& results) {
  bool any = false;
  for (const CaseTable::Measure& m : results.measures()) {
    if (m.unit.empty()) continue;
    if (!std::exchange(any, true)) {
      json.key("units");
      json.begin_object();
    }
    json.member(m.name, std::string_view(m.unit));
  }
  if (any) json.end_object();
}

}  // namespace

std::string sensitivities_csv(const std::vector<MeasureSensitivity>& sensitivities) {
  std::string text = "measure,method,index,variable,value,low,high,cases\n";
  for (const MeasureSensitivity& s : sensitivities)
    for (std::size_t i = 0; i < s.of.indices.size(); ++i)
      for (std::size_t k = 0; k < s.variables.size(); ++k) {
        const Index& index = s.of.values[i][k];
        text += io::csv_field(s.measure) + ',' + s.of.method + ',' + s.of.indices[i] + ',' +
                io::csv_field(s.variables[k]) + ',';
        io::append_number(text, index.value);
        for (const std::optional<double>& end : {index.low, index.high}) {
          text += ',';
          if (end) io::append_number(text, *end);
        }
        text += ',' + std::to_string(s.of.rows) + '\n';
      }
  return text;
}

void write_batch_json(const CaseTable& results, const std::string& title,
                      const std::vector<MeasureSensitivity>& sensitivities, const io::TextSink& sink) {
  io::JsonText json;
  json.begin_object();
  json.member("title", std::string_view(title));
  write_units(json, results);
  json.key("cases");
  json.begin_array();
  for (const CaseResult& r : results) {
    json.begin_object();
    json.member("case", std::string_view(r.which.name));
    if (!r.which.inputs.empty()) {
      json.key("inputs");
      json.begin_object();
      for (const auto& [name, value] : r.which.inputs) {
        json.key(name);
        json.raw(value);
      }
      json.end_object();
    }
    json.member("status", text_of(r.status));
    if (!r.cause.empty()) json.member("cause", std::string_view(r.cause));
    json.member("steps_accepted", static_cast<long long>(r.report.accepted));
    json.member("steps_rejected", static_cast<long long>(r.report.rejected));
    json.member("newton_iterations", static_cast<long long>(r.report.newton_iterations));
    json.member("expected_holds", static_cast<long long>(r.report.expected_holds));
    json.member("expected_fails", static_cast<long long>(r.report.expected_fails));
    json.key("doubts");
    json.begin_array();
    for (const std::string& d : r.report.doubts) json.value(std::string_view(d));
    json.end_array();
    if (r.report.energy_error) json.member("energy_error", *r.report.energy_error);
    if (r.report.constraint_error) json.member("constraint_error", *r.report.constraint_error);
    json.key("measures");
    json.begin_object();
    for (const records::MeasureResult& m : r.report.measures)
      if (m.value) json.member(m.name, *m.value);
    json.end_object();
    json.end_object();
    sink(json.take());
  }
  json.end_array();
  if (!sensitivities.empty()) write_sensitivities(json, sensitivities);
  json.end_object();
  sink(json.text());
}

void write_cost_csv(const CaseTable& results, const io::TextSink& sink) {
  sink("case,wall_seconds,cpu_seconds,peak_megabytes\n");
  for (const CaseResult& r : results)
    sink(io::csv_field(r.which.name) + ',' + io::rounded_text(r.cost.wall_seconds, 4) + ',' +
         io::rounded_text(r.cost.cpu_seconds, 4) + ',' + io::rounded_text(1e-6 * r.cost.peak_bytes, 4) + '\n');
}

}  // namespace bough::study
