#pragma once
/// Dynamics. The run is divided into stretches between breakpoints, the times at which laws jump; each begins with a
/// consistent state.
#include <optional>
#include <vector>

#include "analysis.hpp"
#include "bough/results/observe.hpp"
#include "bough/step/integrator.hpp"
#include "bough/step/step_control.hpp"
#include "break_walk.hpp"
#include "carried_error.hpp"
#include "energy_error.hpp"
#include "law_watch.hpp"
#include "limit_watch.hpp"
#include "other_motions.hpp"
#include "reaction_watch.hpp"
#include "vibration_watch.hpp"

namespace bough::run {

/// Common base of runs with equal and with controlled step sizes.
class TimeSteps : public Analysis {
 public:
  bool begin() override;
  bool take_step() override;
  void jump() override { has_jump_ = is_begun_; }
  void stop() override;
  void checkpoint(records::Archive& archive) override;
  bool write_matrices(long matrices) override { return integrator_->write_matrices(matrices); }
  void end_errors() override;
  double errors_grow_in() const override { return carried_ ? carried_->grows_in() : 0.0; }
  bool is_done() const override { return is_begun_ && is_stretch_done() && !(end_ < scene_.analysis.end_time); }
  void sum_up() override;
  void add_doubts() override;
  std::string not_judged() const override;
  bool ends_in_correction() const override { return options_.integrator == scene::Integrator::generalized_alpha; }

 protected:
  explicit TimeSteps(const Parts& parts);
  TimeSteps(const TimeSteps&) = default;

  /// Prepares the steps of the stretch from `begin_` to `end_`, starting at the present state.
  [[nodiscard]] virtual bool begin_stretch() = 0;
  [[nodiscard]] virtual bool step_within_stretch() = 0;
  virtual bool is_stretch_done() const = 0;

  /// Makes the state consistent, at the start of the run (which is recorded) or after a jump, and starts the integrator
  /// with steps of this size.
  [[nodiscard]] bool start_integrator(double step_size);
  bool set_step_size(double size);
  /// Keeps the state at the first failure of a step and restores it at further ones, so that all attempts of a step
  /// start from the same state. Each change of step size corrects velocities. Where steps do not resolve the motion,
  /// repeated corrections of corrections would grow without bound.
  void keep_or_restore(bool is_first_failure);
  /// Checks reactions if ReactionWatch requires it.
  bool watch_reactions();
  bool is_variational() const { return options_.integrator == scene::Integrator::variational; }

  /// Adds the local errors measured in a step of this size to the sums, as valid for all steps of a duration.
  void add_error(double duration, double size);
  /// see_before_look evaluates sensors at the start of the step whose error is measured. watch_errors evaluates them at
  /// its end, with and without the local error. norm: the one passed to ErrorWatch::pass for this step.
  void see_before_look();
  void watch_errors(double norm);
  /// Carries the error of the motion on by the step just taken. local: its local error, if it was measured.
  bool carry_error(const step::LocalError* local);

  double start_ = 0.0;                           ///< time at which the run starts [s]
  double begin_ = 0.0, end_ = 0.0;               ///< times of the present stretch [s]
  std::optional<step::LocalError> local_error_;  ///< of generalized-alpha, if checks or step control need it
  std::optional<CarriedError> carried_;          ///< if checks are made and it can be paid
  std::optional<results::MotionSensors> seen_;   ///< if errors of sensors of motion are estimated
  LawWatch laws_;
  VibrationWatch vibrations_;
  Cloned<step::Integrator> integrator_;

 private:
  bool begin_in_equilibrium();
  bool begin_from(const records::StoredState& from);
  void note_unstable_start();
  bool has_hidden() const;
  void look_at_hidden();
  bool begin_next_stretch();
  /// Begins the rest of the present stretch anew.
  bool begin_rest_of_stretch();
  bool is_first() const { return begin_ == start_ && !has_jump_; }
  void choose_bdf_order(double step_size);
  void note_moved_start(const step::StartReport& consistent);

  BreakWalk breaks_;
  HiddenMotions hidden_;  ///< stability in motions that the plan leaves out, looked at from time to time
  int hidden_looks_ = 0, hidden_known_ = 0, hidden_unstable_ = 0;  ///< looks; those that told; of these unstable ones
  bool starts_unstable_ = false, was_unstable_ = false, ends_unstable_ = false;  ///< start; last look but one; last
  std::string hidden_mode_;
  bool is_begun_ = false;
  bool is_followed_ = false;                ///< sensors were looked at in the step before, for the error carried along
  bool has_jump_ = false;                   ///< an input was changed at the present time
  step::State tried_;                       ///< start of the first attempt of a failed step
  std::optional<ReactionWatch> reactions_;  ///< if checks are made and sensors show reactions
  std::vector<elements::NodeMotion>
      asked_nodes_;  ///< nodes with their velocities, of a start that is not the one of the scene
  std::vector<double> values_before_, values_now_, values_displaced_;  ///< of motion sensors when an error is measured
};

/// Steps of equal size between breakpoints. A failed step is halved, and the size is doubled again after four easy
/// steps.
class EqualSteps final : public TimeSteps {
 public:
  explicit EqualSteps(const Parts& parts);
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<EqualSteps>(*this); }
  void checkpoint(records::Archive& archive) override {
    TimeSteps::checkpoint(archive);
    archive(size_, steps_, level_, done_, easy_, looks_every_, since_look_, looking_, looked_at_, unfiltered_looked_);
  }

 private:
  bool begin_stretch() override;
  bool step_within_stretch() override;
  bool is_stretch_done() const override { return done_ == steps_ << level_; }
  bool cut(const step::StepReport& report, double size);
  bool accept(const step::StepReport& report, double size, bool is_last);
  /// Whether local errors are measured.
  bool watches_error() const { return local_error_ && scene_.output.checks && !options_.single_solution; }
  bool look_at_error();
  /// For the variational integrator, which has no damping: ends a run in which unresolved vibrations increase the
  /// energy. Returns whether the run continues.
  bool watch_vibrations();

  double size_ = 0.0;                                 ///< size of the uncut steps of the stretch [s]
  long steps_ = 0;                                    ///< number of uncut steps of the stretch
  int level_ = 0;                                     ///< steps are cut into 2^level
  long done_ = 0;                                     ///< completed steps, of size_ / 2^level
  int easy_ = 0;                                      ///< consecutive easy steps
  long looks_every_ = 1;                              ///< steps between two measurements of local errors
  long since_look_ = 0;                               ///< steps
  bool looking_ = false;                              ///< the next step is the second of a measurement
  double looked_at_ = 0.0, unfiltered_looked_ = 0.0;  ///< time of the last measurement; largest unfiltered error then
};

/// Steps whose size is controlled so that local errors stay within a tolerance.
class ControlledSteps final : public TimeSteps {
 public:
  explicit ControlledSteps(const Parts& parts);
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<ControlledSteps>(*this); }
  void checkpoint(records::Archive& archive) override {
    TimeSteps::checkpoint(archive);
    archive(controller_, limit_watch_, energy_error_, stops_, next_stop_, wanted_size_, from_, size_, steps_, done_,
            rejections_, since_look_);
  }
  void add_notes() override;

 private:
  bool begin_stretch() override;
  bool step_within_stretch() override;
  bool is_stretch_done() const override { return next_stop_ == stops_.size(); }
  void begin_way();
  void change_size(double wanted);
  bool measure();
  bool reject(const step::StepReport& report, double ratio);
  bool watch_accepted();
  void choose_next_size(double ratio);

  double largest_;  ///< largest step size allowed [s]
  step::StepController controller_;
  LimitWatch limit_watch_;
  std::optional<EnergyError> energy_error_;  ///< if sensors show forces, accelerations or energies
  step::State disturbed_;                    ///< by local errors, for that
  std::vector<double> stops_;                ///< times at which steps have to end
  std::size_t next_stop_ = 0;
  double wanted_size_ = 0.0;        ///< of the next step [s]
  double from_ = 0.0, size_ = 0.0;  ///< time of the last change of size, and the size since [s]
  long steps_ = 0, done_ = 0;       ///< number of steps from there to the next stop, and of those done
  int rejections_ = 0;              ///< consecutive rejections
  long since_look_ = 0;             ///< accepted steps since errors of sensors were last measured
};

}  // namespace bough::run
