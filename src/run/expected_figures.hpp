#pragma once
/// Expected figures of a run, and values of sensors at requested times. Both are taken from all accepted steps and, by
/// interpolation, from between them.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/scene.hpp"
#include "step_window.hpp"

namespace bough::run {

/// The same rule applies to every requested time. If a step ends there (within round-off), the values of sensors at
/// this end are taken. Otherwise, in dynamics, StepWindow interpolates between the ends of the two adjacent steps.
/// Nothing is interpolated in statics, where load steps end at requested load factors; steps of controlled size end at
/// requested times, too. Extremes, ranges and periods use the ends of all accepted steps, whatever the stride of the
/// output, and interpolated values between them.
class ExpectedFigures {
 public:
  /// expected: must outlive this object. sample_times: ascending; used only if `sample` is given.
  ExpectedFigures(const scene::Scene& scene, const std::vector<scene::Expected>& expected, const plan::Plan& plan,
                  const records::HistoryHeader& header, std::vector<double> sample_times,
                  decltype(SimulateOptions::sample) sample);

  /// Whether the end of a step at this time has to be passed to `add`. That is never so if nothing is requested;
  /// otherwise some steps around each requested time are needed.
  bool wants(double time) const;
  /// Adds the end of an accepted step, or the start of a stretch. Laws must be set to its time, and are so again
  /// afterwards.
  void add(step::System& system, const step::State& state, results::EnergyMeter& meter);
  /// To be called at a breakpoint and at the end of the run, since nothing is interpolated across these.
  void end_stretch(step::System& system, const step::State& state, results::EnergyMeter& meter);

  /// Requested load factors, or times, of figures.
  const std::vector<double>& times() const { return times_; }
  /// Whether `end`, the time or load factor at the end of a step, is the requested `time` within round-off.
  bool is_same(double time, double end) const;
  /// Records the cause why there is no value at this load factor.
  void note_missing(double time, const std::string& cause);

  void checkpoint(records::Archive& archive) { archive(figures_, next_sample_, window_, num_seen_); }

  /// Results of all figures, compared with the expected values of the scene.
  std::vector<records::ExpectedResult> results(const records::Summary& summary) const;

 private:
  struct Extreme {
    bool is_known = false;
    double value = 0.0;
    double time = 0.0, value_at_time = 0.0;  ///< of the first among extremes that are equal within round-off

    /// sign: 1 for a maximum, -1 for a minimum. spread: range of all values so far.
    bool is_beaten_by(double sign, double other) const { return !is_known || sign * other > sign * value; }
    void take(double sign, double other, double when, double spread);
  };
  struct Figure {
    const scene::Expected* given = nullptr;
    int sensor = -1;            ///< index in StepWindow::sensors; -1: the scene has no such column
    std::size_t column = 0;     ///< index in the header
    std::size_t component = 0;  ///< component of the sensor
    std::optional<double> value;
    double distance = 0.0;  ///< between the requested time and that of the value
    std::string how;
    Extreme most, least;
    double low = 0.0, high = 0.0;  ///< range of the values at ends of steps so far
    bool has_ends = false;
    long crossings = 0;
    double first_crossing = 0.0, last_crossing = 0.0;
    void checkpoint(records::Archive& archive) {
      archive(value, distance, how, most, least, low, high, has_ends, crossings, first_crossing, last_crossing);
    }
  };

  void look_on(step::System& system, const step::State& state, results::EnergyMeter& meter);
  void see_end(Figure& figure, int end);
  void see_between(Figure& figure, step::System& system, results::EnergyMeter& meter, int interval);
  void hand_out_samples(step::System& system, results::EnergyMeter& meter, int end);
  template <class F>
  void seek_extreme(Extreme& best, double sign, double begin, double end, double spread, F&& f) const;
  std::optional<double> value_of(const Figure& figure, const records::Summary& summary) const;
  std::string how_of(const Figure& figure) const;

  const scene::Scene& scene_;
  const plan::Plan& plan_;
  std::vector<Figure> figures_;
  std::vector<double> times_;  ///< of figures at a time, ascending
  bool sees_all_ = false;      ///< some figure needs the whole run
  double reach_ = 0.0;         ///< ends of steps within this distance of a requested time are needed
  std::vector<double> sample_times_;
  decltype(SimulateOptions::sample) sample_;
  std::size_t next_sample_ = 0;
  std::vector<double> sampled_;
  StepWindow window_;
  int num_seen_ = 0;  ///< number of ends of the window already evaluated
};

}  // namespace bough::run
