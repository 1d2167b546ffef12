#pragma once
/// Output of a run while it proceeds: rows of the history, pictures, figures, and the checks of each row.
#include <memory>
#include <optional>
#include <vector>

#include "account.hpp"
#include "bough/results/named_parts.hpp"
#include "bough/results/spring_watch.hpp"
#include "bough/run/measures.hpp"
#include "bough/run/simulate.hpp"
#include "conservation.hpp"
#include "error_watch.hpp"
#include "expected_figures.hpp"
#include "far_watch.hpp"
#include "finite_gate.hpp"
#include "pictures.hpp"
#include "turn_watch.hpp"

namespace bough::run {

/// Records the accepted states of a run. A copy continues recording from the point that the original had reached; rows
/// already passed to the recorder are not withdrawn.
class Recording {
 public:
  /// Keeps all references except that to `options`. Sets the header and the notes of the plan in the summary.
  Recording(const scene::Scene& scene, const SimulateOptions& options, const step::StepOptions& step_options,
            step::System& system, records::Recorder& recorder);

  Account& account() { return account_; }
  records::Summary& summary() { return account_.summary(); }
  const records::Summary& summary() const { return account_.summary(); }
  Conservation& conservation() { return conservation_; }
  FiniteGate& gate() { return gate_; }
  ExpectedFigures& figures() { return figures_; }
  /// Estimator of the errors of sensors; null if local errors are unknown or checks are not requested.
  ErrorWatch* error_watch() { return error_watch_ ? &*error_watch_ : nullptr; }

  /// Records the end of an accepted step of this size, or a start (size 0), as the left limit at its time.
  void record(const step::State& state, double step_size, int iterations, bool is_last);
  /// Draws a state that is no part of the history, where pictures are wanted; its time tells its place among pictures.
  void draw_shape(const step::State& state);
  /// Evaluates figures at a state that has no row of its own.
  void add_figures(const step::State& state) { figures_.add(system_, state, conservation_.energies()); }
  /// To be called at a breakpoint or the end of the run: figures are not interpolated across it.
  void end_stretch(const step::State& state) { figures_.end_stretch(system_, state, conservation_.energies()); }

  /// The state by the names of its parts.
  records::StoredState named(const step::State& state);
  /// Hands it to the recorder, unless that has no use for it or has it already, or the run has not started.
  void hand_out(const step::State& state);

  void checkpoint(records::Archive& archive);
  /// To be called once it was read, before further pictures are passed to the recorder.
  void come_back();

  /// Values of all sensors in the order of the header.
  const std::vector<double>& eval_sensors(const step::State& state);

  /// Writes expected figures and measures to the summary. To be called again if the status has changed since.
  void take_figures();
  const std::vector<double>& last_values() const { return row_.values; }
  const results::SpringWatch& springs() const { return springs_; }
  const FarWatch& far_forces() const { return far_; }

 private:
  bool is_due(long row, bool is_last) const;
  void draw(const step::State& state, bool is_last);
  void begin_picture(const records::MotionFrame& frame);
  /// Whether the run passes the time of a figure, if it has one: it may start later, and its end may have been reduced.
  bool is_time_passed(const std::optional<double>& time) const;

  const scene::Scene& scene_;
  step::System& system_;
  records::Recorder& recorder_;
  double start_;  ///< time at which the run starts [s]
  Account account_;
  Conservation conservation_;
  FiniteGate gate_;
  Pictures pictures_;
  TurnWatch turns_;  ///< since the last picture
  bool is_turn_told_ = false;
  std::shared_ptr<const std::vector<scene::Expected>> asked_;  ///< expected figures, then measures that are figures
  ExpectedFigures figures_;
  Measures measures_;
  results::SpringWatch springs_;
  FarWatch far_;
  std::optional<results::MotionSensors> motion_sensors_;  ///< where all sensors show motion, of a reduced model
  std::optional<ErrorWatch> error_watch_;
  std::optional<results::NamedParts> parts_;  ///< once they were asked for
  std::optional<double> handed_out_;          ///< time of the last state that the recorder has got
  std::vector<double> values_;
  records::HistoryRow row_;  ///< last recorded row
  long rows_ = 0;
};

}  // namespace bough::run
