#pragma once
/// What is measured of a run: figures of one quantity over time, as columns of batches and sweeps. All take the
/// quantity at the start and at the end of every accepted step, and straight lines between (times ascending, equal
/// ones allowed).
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bough/laws/formula.hpp"
#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

/// A quantity over time: as many values as times.
struct Series {
  std::span<const double> times, values;
};

/// (1/T) int x dt; the value itself where T is 0.
double mean_of(const Series& s);
/// sqrt((1/T) int x^2 dt), exact for the straight lines.
double rms_of(const Series& s);
/// The value that the quantity is at or below for `percent` of the time, 0 to 100.
double percentile_of(const Series& s, double percent);
/// Time after which |x - target| <= band to the end; nothing where it is outside at the end.
std::optional<double> settling_time_of(const Series& s, double target, double band);
/// Frequency [1/s] of the largest peak of the amplitude spectrum: mean taken out, Hann window, 2^k equal intervals of
/// at least two a step, a parabola through the logarithms of the peak and its neighbours. Nothing where there are
/// fewer than 8 steps or the quantity is constant.
std::optional<double> dominant_frequency_of(const Series& s);

/// A cycle or half a cycle of a load history.
struct LoadCycle {
  double range = 0.0, mean = 0.0, count = 1.0;
  friend bool operator==(const LoadCycle&, const LoadCycle&) = default;
};
/// Rainflow counting (ASTM E 1049-85, 5.4.4), in the order in which cycles close; what is left counts as half cycles.
std::vector<LoadCycle> rainflow_of(std::span<const double> values);
/// Range of `cycles` equal cycles of the same damage: (sum n_i r_i^m / cycles)^(1/m).
double equivalent_range(std::span<const LoadCycle> cycles, double exponent, double number);

/// Unit of a measure; empty for a pure number, and for an expression, of which nobody knows.
std::string unit_of(const scene::Measure& measure, const records::HistoryHeader& header);

/// Takes the quantities of a scene's measures as a run goes and gives their figures at its end.
class Measures {
 public:
  Measures(const scene::Scene& scene, const records::HistoryHeader& header);

  bool empty() const { return measures_.empty(); }
  /// Figures that are those of `expected` are not for this class: they are interpolated within steps (ExpectedFigures).
  static bool is_figure(const scene::Measure& measure);
  /// The start, or the end of an accepted step; values: by the header.
  void add(double time, std::span<const double> values);
  /// In the order of the scene, without those that `is_figure` takes out.
  std::vector<records::MeasureResult> results() const;

 private:
  struct Quantity {
    std::vector<std::size_t> columns;      ///< of the header
    std::optional<laws::Formula> formula;  ///< of these; nothing: the one column
    std::vector<double> values;
  };
  struct Measure {
    const scene::Measure* given;
    std::size_t quantity;  ///< in quantities_
  };
  std::size_t quantity_of(const scene::Measure& measure, const records::HistoryHeader& header);

  std::vector<Measure> measures_;
  std::vector<Quantity> quantities_;
  std::vector<std::string> keys_;  ///< of quantities: what they are, so that equal ones are kept once
  std::vector<double> times_, arguments_;
};

}  // namespace bough::run
