#pragma once
/// Expected figures of a run, and what sensors show at times asked for, taken from all accepted steps and from
/// between them.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/scene.hpp"
#include "step_window.hpp"

namespace bough::run {

/// One rule for every time that is asked for: where a step ends there (within round-off), what sensors show at this
/// end; else, in time, what StepWindow interpolates between the two ends around it. Statics interpolate nothing: load
/// steps end there, and so do steps of sizes that are chosen. Extremes, ranges and periods look at the ends of all
/// accepted steps, whatever the stride of the output, and at what lies between.
class ExpectedFigures {
 public:
  /// expected: outlives this object. sample_times: ascending; looked at where `sample` is given.
  ExpectedFigures(const scene::Scene& scene, const std::vector<scene::Expected>& expected, const plan::Plan& plan,
                  const records::HistoryHeader& header, std::vector<double> sample_times,
                  decltype(SimulateOptions::sample) sample);

  /// Whether the end of a step at this time has to be handed to `add`: never where nothing is asked for. Some ends
  /// around a time are.
  bool wants(double time) const;
  /// Takes the end of an accepted step, or the start of a stretch; laws stand at its time, and stand there again
  /// afterwards.
  void add(step::System& system, const step::State& state, results::EnergyMeter& meter);
  /// To be called at a breakpoint and at the end of the run: nothing is interpolated across.
  void end_stretch(step::System& system, const step::State& state, results::EnergyMeter& meter);

  /// Load factors, or times, of figures.
  const std::vector<double>& times() const { return times_; }
  /// Whether a step of a path that ends at this load factor serves a figure asked for at `time`.
  bool is_same(double time, double end) const;
  /// Why there is no value at this load factor.
  void note_missing(double time, const std::string& cause);

  /// All figures against what the scene expects.
  std::vector<records::ExpectedResult> results(const records::Summary& summary) const;

 private:
  struct Extreme {
    bool is_known = false;
    double value = 0.0;
    double time = 0.0, value_at_time = 0.0;  ///< of the first of equal ones, which differ by round-off

    /// sign: 1 of a maximum, -1 of a minimum; spread: of all values so far.
    bool is_beaten_by(double sign, double other) const { return !is_known || sign * other > sign * value; }
    void take(double sign, double other, double when, double spread);
  };
  struct Figure {
    const scene::Expected* given = nullptr;
    int sensor = -1;            ///< in StepWindow::sensors; -1: the quantity is of no column of this scene
    std::size_t column = 0;     ///< of the header
    std::size_t component = 0;  ///< of the sensor
    std::optional<double> value;
    double distance = 0.0;  ///< from the time asked for to where the value was taken
    std::string how;
    Extreme most, least;
    double low = 0.0, high = 0.0;  ///< of the ends of steps so far
    bool has_ends = false;
    long crossings = 0;
    double first_crossing = 0.0, last_crossing = 0.0;
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
  bool sees_all_ = false;      ///< some figure is of the whole run
  double reach_ = 0.0;         ///< so far from a time asked for ends of steps are wanted
  std::vector<double> sample_times_;
  decltype(SimulateOptions::sample) sample_;
  std::size_t next_sample_ = 0;
  std::vector<double> sampled_;
  StepWindow window_;
  int num_seen_ = 0;  ///< ends of the window
};

}  // namespace bough::run
