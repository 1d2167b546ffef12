#include "bough/run/measures.hpp"

#include <algorithm>
#include <cmath>

#include "bough/scene/sensor_kinds.hpp"
#include "column_places.hpp"

namespace bough::run {

using scene::MeasureKind;

bool Measures::is_figure(const scene::Measure& measure) {
  return measure.expression.empty() && measure.kind <= MeasureKind::period && !measure.from && !measure.to;
}

Measures::Measures(const scene::Scene& scene, const records::HistoryHeader& header) {
  const ColumnPlaces columns(header);
  for (const scene::Measure& m : scene.measures)
    if (!is_figure(m) && !m.is_of_measures) measures_.push_back({&m, quantity_of(m, columns)});
}

std::size_t Measures::quantity_of(const scene::Measure& measure, const ColumnPlaces& columns) {
  std::string key = measure.quantity + "\n" + measure.expression;
  for (const auto& [name, column] : measure.names) key += "\n" + name + "\n" + column;
  const auto [known, is_new] = quantity_of_key_.emplace(std::move(key), quantities_.size());
  if (!is_new) return known->second;
  Quantity quantity;
  if (measure.expression.empty()) {
    quantity.columns = {columns.of(measure.quantity)};
  } else {
    std::vector<std::string> names;
    for (const auto& [name, column] : measure.names) {
      names.push_back(name);
      quantity.columns.push_back(columns.of(column));
    }
    quantity.formula.emplace(measure.expression, names);
  }
  arguments_.resize(std::max(arguments_.size(), quantity.columns.size()));
  quantities_.push_back(std::move(quantity));
  return quantities_.size() - 1;
}

void Measures::add(double time, std::span<const double> values) {
  times_.push_back(time);
  for (Quantity& q : quantities_) {
    for (std::size_t k = 0; k < q.columns.size(); ++k) arguments_[k] = values[q.columns[k]];
    q.values.push_back(q.formula ? (*q.formula)({arguments_.data(), q.columns.size()}) : arguments_[0]);
  }
}

namespace {

/// Value at a time by linear interpolation; none outside of the run.
std::optional<double> value_at(const Series& s, double time) {
  const double reach = 1e-9 * (s.times.back() - s.times.front());
  if (time < s.times.front() - reach || time > s.times.back() + reach) return std::nullopt;
  // Of two equal times the first is the end of the earlier step.
  const auto next = static_cast<std::size_t>(std::lower_bound(s.times.begin(), s.times.end(), time) - s.times.begin());
  if (next == s.times.size()) return s.values.back();
  if (next == 0 || s.times[next] == time) return s.values[next];
  const double part = (time - s.times[next - 1]) / (s.times[next] - s.times[next - 1]);
  return std::lerp(s.values[next - 1], s.values[next], part);
}

/// The part of a series within the window of a measure, with straight lines to its ends; nothing where the run does not
/// reach over it.
struct PartOfSeries {
  std::vector<double> times, values;
};
std::optional<PartOfSeries> part_of(const scene::Measure& m, const Series& s) {
  const double from = m.from.value_or(s.times.front()), to = m.to.value_or(s.times.back());
  const std::optional<double> first = value_at(s, from), last = value_at(s, to);
  if (!first || !last || !(from < to)) return std::nullopt;
  PartOfSeries part{{from}, {*first}};
  for (std::size_t k = 0; k < s.times.size(); ++k) {
    if (s.times[k] <= from || s.times[k] >= to) continue;
    part.times.push_back(s.times[k]);
    part.values.push_back(s.values[k]);
  }
  part.times.push_back(to);
  part.values.push_back(*last);
  return part;
}

/// Mean time between upward crossings of a level.
std::optional<double> period_of(const Series& s, double level) {
  double first = 0.0, last = 0.0;
  int crossings = 0;
  for (std::size_t k = 1; k < s.times.size(); ++k) {
    const double below = s.values[k - 1] - level, above = s.values[k] - level;
    if (!(below < 0.0 && above >= 0.0)) continue;
    last = std::lerp(s.times[k - 1], s.times[k], below / (below - above));
    if (crossings++ == 0) first = last;
  }
  if (crossings < 2) return std::nullopt;
  return (last - first) / static_cast<double>(crossings - 1);
}

std::optional<double> figure_of(const scene::Measure& m, const Series& s) {
  const auto low = std::min_element(s.values.begin(), s.values.end()),
             high = std::max_element(s.values.begin(), s.values.end());
  const auto time_of = [&s](auto at) { return s.times[static_cast<std::size_t>(at - s.values.begin())]; };
  switch (m.kind) {
    case MeasureKind::value:
      return m.time ? value_at(s, *m.time) : s.values.back();
    case MeasureKind::max:
      return *high;
    case MeasureKind::min:
      return *low;
    case MeasureKind::time_of_max:
      return time_of(high);
    case MeasureKind::time_of_min:
      return time_of(low);
    case MeasureKind::range:
      return *high - *low;
    case MeasureKind::period:
      return period_of(s, m.level.value_or(0.0));
    case MeasureKind::mean:
      return mean_of(s);
    case MeasureKind::rms:
      return rms_of(s);
    case MeasureKind::percentile:
      return percentile_of(s, m.percent);
    case MeasureKind::settling_time:
      return settling_time_of(s, m.target.value_or(s.values.back()), m.band);
    case MeasureKind::dominant_frequency:
      return dominant_frequency_of(s);
    case MeasureKind::cycles: {
      double number = 0.0;
      for (const LoadCycle& c : rainflow_of(s.values)) number += c.range >= m.range ? c.count : 0.0;
      return number;
    }
    case MeasureKind::equivalent_range:
      // The default is one cycle per second.
      return equivalent_range(rainflow_of(s.values), m.exponent, m.cycles.value_or(s.times.back() - s.times.front()));
  }
  return std::nullopt;
}

}  // namespace

namespace {

/// unit_of_quantity: of those that the measure names; nothing where it is not known.
std::string unit_of(const scene::Measure& measure, const records::HistoryHeader& header,
                    const std::function<std::optional<std::string>(const std::string&)>& unit_of_quantity) {
  switch (measure.kind) {
    case MeasureKind::time_of_max:
    case MeasureKind::time_of_min:
    case MeasureKind::period:
    case MeasureKind::settling_time:
      return header.runs_over_load ? "" : "s";
    case MeasureKind::dominant_frequency:
      return header.runs_over_load ? "" : "Hz";
    case MeasureKind::cycles:
      return "";
    case MeasureKind::value:
    case MeasureKind::max:
    case MeasureKind::min:
    case MeasureKind::range:
    case MeasureKind::mean:
    case MeasureKind::rms:
    case MeasureKind::percentile:
    case MeasureKind::equivalent_range:
      break;
  }
  if (measure.expression.empty()) return unit_of_quantity(measure.quantity).value_or("");
  std::vector<std::string> names;
  std::vector<std::optional<std::string>> units;
  for (const auto& [name, column] : measure.names) {
    names.push_back(name);
    units.push_back(unit_of_quantity(column));
  }
  return laws::Formula(measure.expression, names).unit_if_known(units).value_or("");
}

}  // namespace

std::vector<std::string> units_of_measures(const scene::Scene& scene, const records::HistoryHeader& header) {
  std::vector<std::string> units;
  const std::string of_signals = scene::to_string(scene::SensorKind::signal);
  const ColumnPlaces columns(header);
  std::unordered_map<std::string_view, std::size_t> place_of;  // of earlier measures
  const auto unit_of_column = [&](const std::string& name) -> std::optional<std::string> {
    const std::size_t at = columns.of(name);
    if (at >= header.about.size()) return std::string();
    const records::HistoryHeader::About& about = header.about[at];
    if (about.unit.empty() && about.quantity == of_signals) return std::nullopt;  // pure, or not known
    return about.unit;
  };
  const auto unit_of_measure = [&](const std::string& name) -> std::optional<std::string> {
    const auto earlier = place_of.find(name);
    return earlier == place_of.end() ? std::string() : units[earlier->second];
  };
  for (const scene::Measure& m : scene.measures) {
    if (m.is_of_measures)
      units.push_back(unit_of(m, header, unit_of_measure));
    else
      units.push_back(unit_of(m, header, unit_of_column));
    place_of.emplace(m.name, units.size() - 1);
  }
  return units;
}

std::optional<double> value_of_measures(const scene::Measure& measure,
                                        std::span<const records::MeasureResult> earlier) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const auto& [name, other] : measure.names) {
    const auto at =
        std::find_if(earlier.begin(), earlier.end(), [&other = other](const auto& m) { return m.name == other; });
    if (at == earlier.end() || !at->value) return std::nullopt;
    names.push_back(name);
    values.push_back(*at->value);
  }
  const double value = laws::Formula(measure.expression, names)(values);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

bool is_indicator(const scene::Measure& measure) {
  if (measure.expression.empty()) return false;
  if (measure.from || measure.to) return false;
  const bool is_of_one_step = measure.kind == MeasureKind::max || measure.kind == MeasureKind::min ||
                              (measure.kind == MeasureKind::value && !measure.time);
  if (!is_of_one_step) return false;
  std::vector<std::string> names;
  for (const auto& [name, column] : measure.names) names.push_back(name);
  return laws::Formula(measure.expression, names).is_zero_or_one();
}

std::vector<records::MeasureResult> Measures::results() const {
  std::vector<records::MeasureResult> all;
  for (const Measure& m : measures_) {
    const std::vector<double>& values = quantities_[m.quantity].values;
    records::MeasureResult r{m.given->name, {}};
    const bool is_finite = std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
    if (!values.empty() && is_finite) {
      if (!m.given->from && !m.given->to)
        r.value = figure_of(*m.given, {times_, values});
      else if (const auto part = part_of(*m.given, {times_, values}))
        r.value = figure_of(*m.given, {part->times, part->values});
    }
    if (r.value && !std::isfinite(*r.value)) r.value.reset();
    all.push_back(std::move(r));
  }
  return all;
}

}  // namespace bough::run
