#include "case_report.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/records/errors.hpp"
#include "bough/run/measures.hpp"

namespace bough::study {
namespace {

/// The first expected figures that were not met.
std::string failing_figures(const records::Summary& summary) {
  constexpr int shown = 3;
  std::string text;
  int count = 0;
  for (const records::ExpectedResult& figure : summary.expected) {
    if (!figure.reached || figure.holds || ++count > shown) continue;
    const std::string value = figure.has_value ? io::rounded_text(figure.value, 6) : "not there";
    text += (text.empty() ? "" : ", ") + figure.name + " is " + value + " instead of " +
            io::rounded_text(figure.reference, 6) + " +- " + io::rounded_text(figure.tolerance, 3);
  }
  if (count > shown) text += " and " + std::to_string(count - shown) + " more";
  return text;
}

/// The error of a measure in time and by the mesh, as far as twins measure them; nothing where one is not known.
std::optional<double> error_of(const records::ErrorOf& measure) {
  double error = 0.0;
  for (const records::ErrorPart* part : {&measure.time, &measure.mesh}) {
    if (part->state == records::ErrorState::not_measured) continue;
    if (!part->is_known()) return std::nullopt;
    error += part->largest;
  }
  return error;
}

}  // namespace

void CaseReport::take(const records::Summary& summary, const scene::Scene& scene) {
  was_interrupted = summary.status == records::RunStatus::interrupted;
  accepted = summary.steps.accepted;
  rejected = summary.steps.rejected;
  newton_iterations = summary.steps.newton_iterations;
  expected_holds = expected_fails = 0;
  for (const records::ExpectedResult& figure : summary.expected)
    if (figure.reached) ++(figure.holds ? expected_holds : expected_fails);
  failing = failing_figures(summary);
  doubts.clear();
  for (const records::Doubt& d : summary.doubts)
    if (std::find(doubts.begin(), doubts.end(), d.about) == doubts.end()) doubts.push_back(d.about);
  measures = summary.measures;
  units = run::units_of_measures(scene, summary.header);
  indicators.clear();
  for (std::size_t k = 0; k < scene.measures.size(); ++k)
    if (run::is_indicator(scene.measures[k])) indicators.push_back(k);
  units.resize(measures.size());
  for (std::size_t k = 0; summary.errors && k < summary.errors->measures.size(); ++k) {
    const records::ErrorOf& of = summary.errors->measures[k];
    measures.push_back({of.name + std::string(error_ending), error_of(of)});
    units.push_back(of.unit);
  }
  const records::Checks& checks = summary.checks;
  energy_error = constraint_error = std::nullopt;
  if (checks.evaluated && checks.energy_scale > 0.0) energy_error = checks.energy_balance / checks.energy_scale;
  if (checks.evaluated) constraint_error = checks.relative_violation_position;
  if (cause.empty()) cause = summary.cause;
}

std::string text_of(const CaseReport& r) {
  io::JsonText json;
  json.begin_object();
  json.member("cause", std::string_view(r.cause));
  json.member("directory", std::string_view(r.directory.string()));
  if (r.stored) {
    json.key("stored");
    json.begin_array();
    json.value(std::string_view(r.stored->store));
    json.value(static_cast<long long>(r.stored->offset));
    json.end_array();
  }
  json.member("interrupted", r.was_interrupted);
  if (r.is_unwritten) json.member("unwritten", true);
  json.key("counts");
  json.begin_array();
  for (const long n : {r.accepted, r.rejected, r.newton_iterations, static_cast<long>(r.expected_holds),
                       static_cast<long>(r.expected_fails)})
    json.value(static_cast<long long>(n));
  json.end_array();
  json.member("failing", std::string_view(r.failing));
  json.key("doubts");
  json.begin_array();
  for (const std::string& d : r.doubts) json.value(std::string_view(d));
  json.end_array();
  json.key("checks");
  json.begin_array();
  for (const std::optional<double>& x : {r.energy_error, r.constraint_error}) {
    if (x && std::isfinite(*x))
      json.value(*x);
    else
      json.value(false);
  }
  json.end_array();
  json.key("measures");
  json.begin_array();
  for (const records::MeasureResult& m : r.measures) {
    json.value(std::string_view(m.name));
    if (m.value)
      json.value(*m.value);
    else
      json.value(false);
  }
  json.end_array();
  json.key("units");
  json.begin_array();
  for (const std::string& unit : r.units) json.value(std::string_view(unit));
  json.end_array();
  json.key("indicators");
  json.begin_array();
  for (const std::size_t k : r.indicators) json.value(static_cast<long long>(k));
  json.end_array();
  json.end_object();
  return json.text();
}

bool report_of(std::string_view text, CaseReport& r) {
  std::vector<io::JsonFault> faults;
  const std::optional<io::JsonValue> root = io::parse_json(text, io::source_file, faults);
  if (!root || !faults.empty()) return false;
  if (!root->is(io::JsonKind::object)) return false;
  for (const char* name : {"cause", "directory", "interrupted", "failing"})
    if (root->find(name) == nullptr) return false;
  const auto* counts = root->find("counts");
  const auto* measures = root->find("measures");
  const auto* doubts = root->find("doubts");
  const auto* checks = root->find("checks");
  if (counts == nullptr || counts->items.size() != 5 || measures == nullptr || doubts == nullptr || checks == nullptr ||
      checks->items.size() != 2)
    return false;
  const auto count = [counts](std::size_t k) {
    return static_cast<long>(std::clamp(counts->items[k].number, 0.0, 1e18));
  };
  r.cause = root->find("cause")->text;
  r.directory = root->find("directory")->text.str();
  if (const io::JsonValue* stored = root->find("stored");
      stored != nullptr && stored->items.size() == 2 && stored->items[1].number >= 0.0 &&
      stored->items[1].number < 0x1p63 && !stored->items[0].text.str().empty())
    r.stored = io::StoredPlace{stored->items[0].text.str(), static_cast<std::uint64_t>(stored->items[1].number)};
  r.was_interrupted = root->find("interrupted")->truth;
  r.is_unwritten = root->find("unwritten") != nullptr;
  r.accepted = count(0);
  r.rejected = count(1);
  r.newton_iterations = count(2);
  r.expected_holds = io::whole_number<int>(counts->items[3].number);
  r.expected_fails = io::whole_number<int>(counts->items[4].number);
  r.failing = root->find("failing")->text;
  for (const io::JsonValue& d : doubts->items) r.doubts.push_back(d.text);
  if (checks->items[0].is(io::JsonKind::number)) r.energy_error = checks->items[0].number;
  if (checks->items[1].is(io::JsonKind::number)) r.constraint_error = checks->items[1].number;
  for (std::size_t k = 0; k + 1 < measures->items.size(); k += 2) {
    records::MeasureResult m{measures->items[k].text, {}};
    if (measures->items[k + 1].is(io::JsonKind::number)) m.value = measures->items[k + 1].number;
    r.measures.push_back(std::move(m));
  }
  if (const io::JsonValue* units = root->find("units"); units != nullptr)
    for (const io::JsonValue& unit : units->items) r.units.push_back(unit.text);
  if (const io::JsonValue* indicators = root->find("indicators"); indicators != nullptr)
    for (const io::JsonValue& k : indicators->items) {
      const double least = r.indicators.empty() ? 0.0 : static_cast<double>(r.indicators.back()) + 1.0;
      if (k.number >= least && k.number < static_cast<double>(r.measures.size()))
        r.indicators.push_back(io::whole_number<std::size_t>(k.number));
    }
  return true;
}

}  // namespace bough::study
