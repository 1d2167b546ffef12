#pragma once
/// Measures of a run: figures of one quantity over time, the columns of batches and sweeps. All use the quantity at the
/// start and at the end of every accepted step, with straight lines between (times ascend; equal ones are allowed).
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "bough/laws/formula.hpp"
#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

/// A quantity over time: as many values as times.
struct Series {
  std::span<const double> times, values;
};

/// Mean (1/T) int x dt; the value itself if T is 0.
double mean_of(const Series& s);
/// Root mean square sqrt((1/T) int x^2 dt), exact for the straight lines.
double rms_of(const Series& s);
/// The value that the quantity does not exceed for `percent` of the time, 0 to 100.
double percentile_of(const Series& s, double percent);
/// Time after which |x - target| <= band until the end; no value if the quantity is outside at the end.
std::optional<double> settling_time_of(const Series& s, double target, double band);
/// Frequency [1/s] of the largest peak of the amplitude spectrum: mean subtracted, Hann window, 2^k equal intervals, at
/// least two per step, a parabola through the logarithms of the peak and its neighbours. No value if there are fewer
/// than 8 steps or the quantity is constant.
std::optional<double> dominant_frequency_of(const Series& s);

/// A cycle or half a cycle of a load history.
struct LoadCycle {
  double range = 0.0, mean = 0.0, count = 1.0;
  friend bool operator==(const LoadCycle&, const LoadCycle&) = default;
};
/// Rainflow counting (ASTM E 1049-85, 5.4.4), in the order in which cycles close; the residue counts as half cycles.
std::vector<LoadCycle> rainflow_of(std::span<const double> values);
/// Range of `number` equal cycles that cause the same damage: (sum n_i r_i^m / number)^(1/m), m = exponent.
double equivalent_range(std::span<const LoadCycle> cycles, double exponent, double number);

/// Units of all measures of a scene; empty for pure numbers, and where the unit does not follow from an expression
/// (laws::Formula::unit).
std::vector<std::string> units_of_measures(const scene::Scene& scene, const records::HistoryHeader& header);

/// Value of a measure of earlier ones; none where one of them has none.
std::optional<double> value_of_measures(const scene::Measure& measure, std::span<const records::MeasureResult> earlier);

/// Whether a measure is 1 where something happens in a run and 0 elsewhere, by its expression: the largest, the least
/// or the last value of one that is always 0 or 1.
bool is_indicator(const scene::Measure& measure);

/// Records the quantities of a scene's measures during a run and computes their figures at its end.
class Measures {
 public:
  Measures(const scene::Scene& scene, const records::HistoryHeader& header);

  bool empty() const { return measures_.empty(); }
  /// True for figures that `expected` has as well. They are interpolated within steps (ExpectedFigures), not computed
  /// here.
  static bool is_figure(const scene::Measure& measure);
  /// Adds the values at the start or at the end of an accepted step, in the order of the header.
  void add(double time, std::span<const double> values);
  /// Results in the order of the scene, without the measures for which `is_figure` is true.
  std::vector<records::MeasureResult> results() const;
  void checkpoint(records::Archive& archive) { archive(quantities_, times_); }

 private:
  struct Quantity {
    std::vector<std::size_t> columns;      ///< of the header
    std::optional<laws::Formula> formula;  ///< of these columns; empty: the value of the only one
    std::vector<double> values;
    void checkpoint(records::Archive& archive) { archive(values); }
  };
  struct Measure {
    const scene::Measure* given;
    std::size_t quantity;  ///< in quantities_
  };
  std::size_t quantity_of(const scene::Measure& measure, const class ColumnPlaces& columns);

  std::vector<Measure> measures_;
  std::vector<Quantity> quantities_;
  std::unordered_map<std::string, std::size_t> quantity_of_key_;  ///< by names and expression: equal ones are one
  std::vector<double> times_, arguments_;
};

}  // namespace bough::run
