#pragma once
/// Dynamics: stretches between the times at which laws jump, each begun from a consistent state.
#include <optional>
#include <vector>

#include "analysis.hpp"
#include "bough/step/integrator.hpp"
#include "bough/step/step_control.hpp"
#include "break_walk.hpp"
#include "energy_error.hpp"
#include "limit_watch.hpp"
#include "reaction_watch.hpp"
#include "vibration_watch.hpp"

namespace bough::run {

/// What steps of equal and of chosen sizes have in common.
class TimeSteps : public Analysis {
 public:
  bool begin() override { return begin_next_stretch(); }
  bool take_step() override;
  bool is_done() const override { return is_begun_ && is_stretch_done() && !(end_ < scene_.analysis.end_time); }
  void sum_up() override;
  void add_doubts() override;

 protected:
  explicit TimeSteps(const Parts& parts);
  TimeSteps(const TimeSteps&) = default;

  /// Begins steps on the stretch from `begin_` to `end_`, at the state that is there.
  [[nodiscard]] virtual bool begin_stretch() = 0;
  [[nodiscard]] virtual bool step_within_stretch() = 0;
  virtual bool is_stretch_done() const = 0;

  /// Makes the state consistent, at the start of the run (which is recorded) or on the far side of a jump, and starts
  /// the integrator with steps of this size.
  [[nodiscard]] bool start_integrator(double step_size);
  bool set_step_size(double size);
  /// Before further attempts of a step that failed: it sets out from where its first attempt did. Each change of size
  /// corrects velocities, and where steps resolve nothing, corrections of corrections would grow without bound.
  void keep_or_restore(bool is_first_failure);
  /// Looks at reactions where these ask for it.
  bool watch_reactions();
  bool is_variational() const { return options_.integrator == scene::Integrator::variational; }

  /// Local errors that were measured of a step of this size hold for all steps of a duration.
  void add_error(double duration, double size);
  /// Sensors at the start of the step that is looked at; then what its local error, measured at its end, is in the
  /// sensors. norm: what the watch was told of this step.
  void see_before_look();
  void watch_errors(double norm);

  double begin_ = 0.0, end_ = 0.0;               ///< of the present stretch [s]
  std::optional<step::LocalError> local_error_;  ///< of generalized-alpha where checks or step control ask for it
  step::State displaced_;                        ///< by local errors
  VibrationWatch vibrations_;
  Cloned<step::Integrator> integrator_;

 private:
  bool begin_next_stretch();
  bool is_first() const { return begin_ == 0.0; }
  void choose_bdf_order(double step_size);
  void note_moved_start(const step::StartReport& consistent);

  BreakWalk breaks_;
  bool is_begun_ = false;
  step::State tried_;                       ///< from which the first attempt of a step that failed set out
  std::optional<ReactionWatch> reactions_;  ///< where checks are made and sensors show reactions
  std::vector<double> values_before_, values_now_, values_displaced_;  ///< of sensors of motions at a look
};

/// Steps of equal size from one breakpoint to the next; a step that fails is halved, and the size grows back after
/// four easy steps.
class EqualSteps final : public TimeSteps {
 public:
  explicit EqualSteps(const Parts& parts);
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<EqualSteps>(*this); }

 private:
  bool begin_stretch() override;
  bool step_within_stretch() override;
  bool is_stretch_done() const override { return done_ == steps_ << level_; }
  bool cut(const step::StepReport& report, double size);
  bool accept(const step::StepReport& report, double size, bool is_last);
  /// Whether steps tell their local errors.
  bool watches_error() const { return local_error_ && scene_.output.checks && !options_.single_solution; }
  bool look_at_error();
  /// The variational integrator, for which this is, damps nothing: ends a run whose unresolved vibrations make energy
  /// out of nothing.
  bool watch_vibrations();

  double size_ = 0.0;                                 ///< of the stretch's uncut steps [s]
  long steps_ = 0;                                    ///< so many of these make up the stretch
  int level_ = 0;                                     ///< steps are cut into 2^level
  long done_ = 0;                                     ///< in units of size_ / 2^level
  int easy_ = 0;                                      ///< easy steps in a row
  long looks_every_ = 1;                              ///< steps between two looks at local errors
  long since_look_ = 0;                               ///< steps
  bool looking_ = false;                              ///< at the second of two steps
  double looked_at_ = 0.0, unfiltered_looked_ = 0.0;  ///< time of the last look; largest unfiltered error at a look
};

/// Steps of sizes that keep local errors within a tolerance.
class ControlledSteps final : public TimeSteps {
 public:
  explicit ControlledSteps(const Parts& parts);
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<ControlledSteps>(*this); }
  void add_notes() override;

 private:
  bool begin_stretch() override;
  bool step_within_stretch() override;
  bool is_stretch_done() const override { return next_stop_ == stops_.size(); }
  void begin_way();
  void change_size(double wanted);
  bool measure();
  bool reject(const step::StepReport& report, double ratio);
  void watch_accepted();
  void choose_next_size(double ratio);

  double largest_;  ///< step size allowed [s]
  step::StepController controller_;
  LimitWatch limit_watch_;
  std::optional<EnergyError> energy_error_;  ///< where sensors show forces or energies
  std::vector<double> stops_;                ///< times at which steps end
  std::size_t next_stop_ = 0;
  double wanted_size_ = 0.0;        ///< of the next step [s]
  double from_ = 0.0, size_ = 0.0;  ///< since the last change of size: its time, and the size [s]
  long steps_ = 0, done_ = 0;       ///< steps from there to the next stop, and those done
  int rejections_ = 0;              ///< in a row
  long since_look_ = 0;             ///< accepted steps since the last look at sensors
};

}  // namespace bough::run
