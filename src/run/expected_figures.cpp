#include "expected_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>
#include <utility>

#include "bough/io/number_text.hpp"
#include "bough/scene/components.hpp"
#include "column_places.hpp"
#include "seek.hpp"

namespace bough::run {

using scene::FigureKind;

namespace {

constexpr double around = 3.001;  ///< reach in steps: two ends before a time and two after it are needed
constexpr double probe = 1e-4;    ///< part of a step over which slopes at its ends are differenced
constexpr double sharp = 1e-7;    ///< tolerance of times of extremes and crossings, relative to the step

bool is_at_time(const scene::Expected& e) { return e.figure == FigureKind::value && e.time.has_value(); }
bool is_of_whole_run(const scene::Expected& e) { return e.figure != FigureKind::value; }
bool needs_most(FigureKind k) { return k == FigureKind::max || k == FigureKind::time_of_max || k == FigureKind::range; }
bool needs_least(FigureKind k) {
  return k == FigureKind::min || k == FigureKind::time_of_min || k == FigureKind::range;
}

/// Sensors used by a figure (or all), by their indices in the plan.
std::vector<int> sensors_asked_for(const std::vector<scene::Expected>& expected, const plan::Plan& plan, bool all) {
  std::unordered_set<std::string> asked;
  for (const scene::Expected& e : expected)
    if (is_at_time(e) || is_of_whole_run(e)) asked.insert(e.quantity.substr(0, e.quantity.find('.')));
  std::vector<int> sensors;
  for (std::size_t k = 0; k < plan.sensors.size(); ++k)
    if (all || asked.count(plan.sensors[k].sensor.name) > 0) sensors.push_back(static_cast<int>(k));
  return sensors;
}

std::string name_of(const scene::Expected& e) {
  const std::string figure = scene::to_string(e.figure);
  if (e.figure != FigureKind::value) return e.quantity + " " + figure;
  return e.time ? e.quantity + " at " + io::rounded_text(*e.time, 15) : e.quantity;
}

}  // namespace

ExpectedFigures::ExpectedFigures(const scene::Scene& scene, const std::vector<scene::Expected>& expected,
                                 const plan::Plan& plan, const records::HistoryHeader& header,
                                 std::vector<double> sample_times, decltype(SimulateOptions::sample) sample)
    : scene_(scene),
      plan_(plan),
      sample_times_(sample ? std::move(sample_times) : std::vector<double>{}),
      sample_(std::move(sample)),
      window_(plan, sensors_asked_for(expected, plan, sample_ != nullptr)) {
  const scene::Analysis& analysis = scene.analysis;
  reach_ = plan.is_dynamic ? analysis.step_control ? analysis.end_time : around * analysis.step_size : 0.0;
  struct Place {
    int sensor = -1;  // of the window
    std::size_t component = 0;
  };
  std::vector<Place> place_of_column;
  for (std::size_t s = 0, k = 0; s < plan.sensors.size(); ++s) {
    const bool is_seen = k < window_.sensors().size() && window_.sensors()[k] == static_cast<int>(s);
    for (std::size_t c = 0; c < plan.sensors[s].components.size(); ++c)
      place_of_column.push_back({is_seen ? static_cast<int>(k) : -1, c});
    k += is_seen ? 1 : 0;
  }
  const ColumnPlaces columns(header);
  for (const scene::Expected& e : expected) {
    Figure figure;
    figure.given = &e;
    figure.column = columns.of(e.quantity);
    if (figure.column < place_of_column.size() && place_of_column[figure.column].sensor >= 0) {
      figure.sensor = place_of_column[figure.column].sensor;
      figure.component = place_of_column[figure.column].component;
    }
    if (is_at_time(e)) times_.push_back(*e.time);
    sees_all_ = sees_all_ || is_of_whole_run(e);
    figures_.push_back(std::move(figure));
  }
  std::sort(times_.begin(), times_.end());
  times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
}

bool ExpectedFigures::is_same(double time, double end) const {
  constexpr double round_off = 8.0 * std::numeric_limits<double>::epsilon();
  const double step = plan_.is_dynamic             ? 1e-9 * scene_.analysis.step_size
                      : scene_.analysis.arc_length ? 1e-6 * std::max(1.0, std::abs(time))
                                                   : 1e-9;
  return std::abs(time - end) <= step + round_off * std::abs(time);
}

bool ExpectedFigures::wants(double time) const {
  if (sees_all_) return true;
  const auto is_near = [&](const std::vector<double>& times) {
    const auto next = std::lower_bound(times.begin(), times.end(), time - reach_,
                                       [&](double a, double b) { return a < b && !is_same(a, time); });
    return next != times.end() && (*next <= time + reach_ || is_same(*next, time));
  };
  return is_near(times_) || is_near(sample_times_);
}

void ExpectedFigures::add(step::System& system, const step::State& state, results::EnergyMeter& meter) {
  if (!wants(state.time)) {
    if (window_.num_ends() > 0) end_stretch(system, state, meter);
    return;
  }
  if (window_.num_ends() == StepWindow::most_ends) --num_seen_;
  window_.push(system, state, meter);
  // Interpolation waits for four ends, or for the end of the stretch.
  if (!plan_.is_dynamic || window_.num_ends() == StepWindow::most_ends) look_on(system, state, meter);
}

void ExpectedFigures::end_stretch(step::System& system, const step::State& state, results::EnergyMeter& meter) {
  look_on(system, state, meter);
  window_.clear();
  num_seen_ = 0;
}

void ExpectedFigures::look_on(step::System& system, const step::State& state, results::EnergyMeter& meter) {
  if (num_seen_ == window_.num_ends()) return;
  for (; num_seen_ < window_.num_ends(); ++num_seen_) {
    for (Figure& figure : figures_) {
      if (figure.sensor < 0) continue;  // the scene has no such column, so the figure has no value
      if (!is_at_time(*figure.given) && !is_of_whole_run(*figure.given)) continue;
      if (num_seen_ > 0 && plan_.is_dynamic) see_between(figure, system, meter, num_seen_ - 1);
      see_end(figure, num_seen_);
    }
    if (sample_) hand_out_samples(system, meter, num_seen_);
  }
  if (!plan_.frames.empty()) (void)system.set_time(state.time);
}

void ExpectedFigures::see_end(Figure& figure, int end) {
  const scene::Expected& e = *figure.given;
  const double time = window_.time(end), value = window_.values(end, figure.sensor)[figure.component];
  if (is_at_time(e)) {
    // At a breakpoint the end of the earlier step counts. Along a path the nearest value counts, and the last of
    // equally near ones.
    const double distance = std::abs(*e.time - time);
    if (!is_same(*e.time, time) || (figure.value && (plan_.is_dynamic || distance > figure.distance))) return;
    figure.value = value;
    figure.distance = distance;
    figure.how = plan_.is_dynamic ? "at the end of a step" : "at the end of a load step";
    return;
  }
  figure.low = figure.has_ends ? std::min(figure.low, value) : value;
  figure.high = figure.has_ends ? std::max(figure.high, value) : value;
  figure.has_ends = true;
  const double spread = figure.high - figure.low;
  if (needs_most(e.figure)) figure.most.take(1.0, value, time, spread);
  if (needs_least(e.figure)) figure.least.take(-1.0, value, time, spread);
}

void ExpectedFigures::Extreme::take(double sign, double other, double when, double spread) {
  constexpr double as_high = 1e-9;  // of the spread: peaks that differ by less are taken as equal
  if (!is_beaten_by(sign, other)) return;
  if (!is_known || sign * (other - value_at_time) > as_high * spread) {
    time = when;
    value_at_time = other;
  }
  value = other;
  is_known = true;
}

/// Assumes at most one extreme within a step. There is one if the function rises (times `sign`) from the first end and
/// falls towards the second.
template <class F>
void ExpectedFigures::seek_extreme(Extreme& best, double sign, double begin, double end, double spread, F&& f) const {
  const auto g = [&](double t) { return sign * f(t); };
  const double h = end - begin, d = probe * h;
  const double at_begin = g(begin), rise = g(begin + d) - at_begin;
  if (!(rise > 0.0) || !(g(end) - g(end - d) < 0.0)) return;
  // A concave function lies below its tangents, so the maximum is below this bound.
  if (!best.is_beaten_by(sign, sign * (at_begin + rise / probe))) return;
  const auto [time, value] = find_maximum(g, begin, end, sharp * h);
  best.take(sign, sign * value, time, spread);
}

void ExpectedFigures::see_between(Figure& figure, step::System& system, results::EnergyMeter& meter, int interval) {
  const scene::Expected& e = *figure.given;
  const double begin = window_.time(interval), end = window_.time(interval + 1);
  const auto f = [&](double t) {
    if (t == begin) return window_.values(interval, figure.sensor)[figure.component];
    if (t == end) return window_.values(interval + 1, figure.sensor)[figure.component];
    const std::span<const double> values = window_.values_between(system, meter, interval, t, figure.sensor);
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : values[figure.component];
  };
  if (is_at_time(e)) {
    const double t = *e.time;
    if (figure.value || t <= begin || t >= end || is_same(t, begin) || is_same(t, end)) return;
    figure.value = f(t);
    figure.how = "interpolated within a step";
    return;
  }
  const double spread = figure.high - figure.low;
  if (needs_most(e.figure)) seek_extreme(figure.most, 1.0, begin, end, spread, f);
  if (needs_least(e.figure)) seek_extreme(figure.least, -1.0, begin, end, spread, f);
  if (e.figure != FigureKind::period) return;
  const double level = e.level.value_or(0.0), below = f(begin) - level, above = f(end) - level;
  if (!(below < 0.0 && above >= 0.0)) return;
  figure.last_crossing =
      find_zero([&](double t) { return f(t) - level; }, begin, end, below, above, sharp * (end - begin));
  if (figure.crossings++ == 0) figure.first_crossing = figure.last_crossing;
}

/// Passes on the samples between the previous end of the window and end `end`.
void ExpectedFigures::hand_out_samples(step::System& system, results::EnergyMeter& meter, int end) {
  const double time = window_.time(end);
  for (; next_sample_ < sample_times_.size(); ++next_sample_) {
    const double wanted = sample_times_[next_sample_];
    const bool is_end = is_same(wanted, time);
    if (wanted > time && !is_end) return;
    if (!is_end && (end == 0 || !plan_.is_dynamic)) continue;  // no step covers this time
    sampled_.clear();
    for (int k = 0; k < static_cast<int>(window_.sensors().size()); ++k) {
      const std::span<const double> values =
          is_end ? window_.values(end, k) : window_.values_between(system, meter, end - 1, wanted, k);
      sampled_.insert(sampled_.end(), values.begin(), values.end());
    }
    sample_(wanted, sampled_);
  }
}

void ExpectedFigures::note_missing(double time, const std::string& cause) {
  for (Figure& figure : figures_)
    if (is_at_time(*figure.given) && *figure.given->time == time && !figure.value) figure.how = cause;
}

std::optional<double> ExpectedFigures::value_of(const Figure& figure, const records::Summary& summary) const {
  const auto of = [](const Extreme& e, double number) {
    return e.is_known ? std::optional<double>(number) : std::nullopt;
  };
  switch (figure.given->figure) {
    case FigureKind::max:
      return of(figure.most, figure.most.value);
    case FigureKind::min:
      return of(figure.least, figure.least.value);
    case FigureKind::time_of_max:
      return of(figure.most, figure.most.time);
    case FigureKind::time_of_min:
      return of(figure.least, figure.least.time);
    case FigureKind::range:
      return of(figure.most, figure.most.value - figure.least.value);
    case FigureKind::period:
      if (figure.crossings < 2) return std::nullopt;
      return (figure.last_crossing - figure.first_crossing) / static_cast<double>(figure.crossings - 1);
    case FigureKind::value:
      break;
  }
  if (figure.given->time) return figure.value;
  if (figure.column >= summary.final_values.size()) return std::nullopt;
  return summary.final_values[figure.column];
}

std::string ExpectedFigures::how_of(const Figure& figure) const {
  const scene::Expected& e = *figure.given;
  if (e.figure == FigureKind::value) return e.time ? figure.how : "at the end of the run";
  if (e.figure != FigureKind::period)
    return plan_.is_dynamic ? "over all steps, interpolated within" : "over the ends of all load steps";
  const std::string level = io::rounded_text(e.level.value_or(0.0), 6);
  if (figure.crossings < 2)
    return "none: " + std::to_string(figure.crossings) + " upward crossings of " + level + ", it takes two";
  return "mean of " + std::to_string(figure.crossings - 1) + " between upward crossings of " + level;
}

std::vector<records::ExpectedResult> ExpectedFigures::results(const records::Summary& summary) const {
  std::vector<records::ExpectedResult> all;
  for (const Figure& figure : figures_) {
    const scene::Expected& given = *figure.given;
    records::ExpectedResult e;
    e.name = name_of(given);
    const std::optional<double> value = value_of(figure, summary);
    e.has_value = value.has_value();
    e.value = value.value_or(0.0);
    e.reference = given.value;
    e.tolerance = given.allowed();
    e.reached = !given.time || !plan_.is_dynamic || *given.time <= scene_.analysis.end_time * (1.0 + 1e-12);
    e.holds =
        summary.status == records::RunStatus::ok && e.reached && value && std::abs(*value - e.reference) <= e.tolerance;
    e.source = given.source;
    e.taken = how_of(figure);
    all.push_back(std::move(e));
  }
  return all;
}

}  // namespace bough::run
