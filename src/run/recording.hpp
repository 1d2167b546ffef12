#pragma once
/// What a run hands out as it goes: rows of the history, pictures, figures, and the checks of each row.
#include <memory>
#include <optional>
#include <vector>

#include "account.hpp"
#include "bough/results/spring_watch.hpp"
#include "bough/run/measures.hpp"
#include "bough/run/simulate.hpp"
#include "conservation.hpp"
#include "error_watch.hpp"
#include "expected_figures.hpp"
#include "finite_gate.hpp"
#include "pictures.hpp"

namespace bough::run {

/// Records the accepted states of a run. A copy goes on recording from where the original was: rows that were handed
/// out stay handed out.
class Recording {
 public:
  /// Keeps the references, all but that to `options`, and the summary's header and notes of the plan are set.
  Recording(const scene::Scene& scene, const SimulateOptions& options, const step::StepOptions& step_options,
            step::System& system, records::Recorder& recorder);

  Account& account() { return account_; }
  records::Summary& summary() { return account_.summary(); }
  const records::Summary& summary() const { return account_.summary(); }
  Conservation& conservation() { return conservation_; }
  FiniteGate& gate() { return gate_; }
  ExpectedFigures& figures() { return figures_; }
  /// Estimated errors of sensors; null where local errors are not known or checks not asked for.
  ErrorWatch* error_watch() { return error_watch_ ? &*error_watch_ : nullptr; }

  /// Takes the end of an accepted step of this size, or a start (size 0), as its time's left limit.
  void record(const step::State& state, double step_size, int iterations, bool is_last);
  /// Figures at a state that has no row of its own.
  void add_figures(const step::State& state) { figures_.add(system_, state, conservation_.energies()); }
  /// A breakpoint or the end of the run: nothing is interpolated across.
  void end_stretch(const step::State& state) { figures_.end_stretch(system_, state, conservation_.energies()); }

  /// Values of all sensors, by the header.
  const std::vector<double>& eval_sensors(const step::State& state);

  /// Takes expected figures and measures into the summary. To be called again where the status has changed since.
  void take_figures();
  const std::vector<double>& last_values() const { return row_.values; }
  const results::SpringWatch& springs() const { return springs_; }

 private:
  bool is_due(long row, bool is_last) const;
  void draw(const step::State& state, bool is_last);
  bool is_time_reached(const scene::Measure& m) const;

  const scene::Scene& scene_;
  step::System& system_;
  records::Recorder& recorder_;
  Account account_;
  Conservation conservation_;
  FiniteGate gate_;
  Pictures pictures_;
  std::shared_ptr<const std::vector<scene::Expected>> asked_;  ///< what the scene expects, then what it measures alike
  ExpectedFigures figures_;
  Measures measures_;
  results::SpringWatch springs_;
  std::optional<ErrorWatch> error_watch_;
  std::vector<double> values_;
  records::HistoryRow row_;  ///< the last one recorded
  long rows_ = 0;
};

}  // namespace bough::run
