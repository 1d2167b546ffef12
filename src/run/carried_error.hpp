#pragma once
/// The error of a run in time, carried along by the linearised motion, and when to do so.
#include <cmath>
#include <optional>
#include <vector>

#include "bough/step/error_transport.hpp"
#include "bough/step/step_cost.hpp"

namespace bough::run {

/// Decides how many steps of the run one step of an error spans. It has to resolve the motion (`turn_a_step`), and all
/// of them together may cost 2 % of the run, or 0.005 s where that is more. Costs are those of the model of steps, so
/// that the decision is the same on every machine.
class CarriedError {
 public:
  /// Keeps the references. steps: expected of the run.
  CarriedError(step::System& system, const scene::Solver& solver, const step::StepOptions& options, double duration,
               const step::State& start);

  /// Whether so few steps of the error can be paid that they tell nothing.
  static bool pays(const step::System& system, double steps);

  /// To be called for every accepted step of equal size, whose factor is still there. Returns whether the error was
  /// carried to this state.
  [[nodiscard]] std::optional<step::Trouble> pass(const step::State& state, bool& is_carried);
  /// The same where the error of every step is measured.
  [[nodiscard]] std::optional<step::Trouble> pass(const step::State& state, const step::LocalError& local,
                                                  bool& is_carried);
  /// Whether the step to come is one of the last before the error is carried, in which its motion is to be looked at.
  bool is_near() const { return since_ + looked_at >= stride_; }
  static constexpr long looked_at = 3;
  /// To be called once the error was carried. turn: of the motion in a step [rad].
  void choose_stride(const step::State& state, double turn, double steps_left);
  /// To be called where the run does not start at time 0, with the times of its start and its end.
  void span(double begin, double end) {
    duration_ = end - begin;
    middle_ = 0.5 * (begin + end);
  }
  /// The far side of a jump.
  void restart(double time);
  void checkpoint(records::Archive& archive) {
    archive(local_, transport_, budget_, stride_, since_, has_first_, duration_, middle_, largest_early_, largest_,
            reaction_, too_much_, all_, unresolved_, added_, detuned_, last_velocity_, last_acceleration_, last_time_,
            most_change_, has_leapt_late_);
  }

  const step::ErrorTransport& transport() const { return transport_; }
  /// The time in which errors grew by e in the later half of the run [s]; 0: no faster than by a power of time.
  double grows_in() const;
  /// The part of a carried error that is certain, where the rule makes errors of nodes that turn grow too fast.
  double certain_part() const { return std::exp(-too_much_); }
  /// Whether its steps have resolved the motion, and kept up with it: in steps longer than those of the run a vibration
  /// of the error is slower than that of the run, and errors of many periods do not add up as they should. An error that
  /// has kept n of those added on its way, n times the mean of them large, is out of step with them by n times the
  /// difference of a step. One that is larger than all that was added grows by itself.
  bool is_resolved() const {
    constexpr double out_of_step = 2.0;  // [rad]; an undamped vibration loses a sixth of its error by then
    const bool keeps_up = largest_ * detuned_ <= out_of_step * added_ || largest_ > added_;
    return unresolved_ <= unresolved_share * all_ && keeps_up;
  }

 private:
  static constexpr double unresolved_share = 0.1;  ///< of the duration: more of it tells nothing

  bool is_at_peak(const step::State& state);
  bool has_leapt(const step::State& state);
  std::optional<step::Trouble> carry(const step::State& state);
  void add(const step::State& state, const step::LocalError& local, double steps);

  step::System& system_;
  step::LocalError local_;
  step::ErrorTransport transport_;
  double budget_;     ///< steps of the error that may still be taken beyond the share of the run
  double left_open_;  ///< of accelerations, by the tolerance of equations [-]
  double cost_;       ///< of one, in steps of the run
  long stride_ = 1, since_ = 0;
  bool has_first_ = false;                      ///< the error of the step before was measured
  double duration_, middle_;                    ///< of the run, and the time at which half of it has passed [s]
  double largest_early_ = 0.0, largest_ = 0.0;  ///< errors in the first half of the run, and in all of it
  double reaction_ = 0.0;                       ///< fading mean of the largest multiplier
  double too_much_ = 0.0;
  std::vector<motion::Vec6<double>> last_velocity_, last_acceleration_;  ///< of nodes, when the error was carried last
  double last_time_ = 0.0, most_change_ = 0.0;  ///< the latter: of velocities in a step of the error, squared
  bool has_leapt_late_ = false;          ///< a step of the error has passed over an impact in the later half of the run
  double all_ = 0.0, unresolved_ = 0.0;  ///< durations [s]
  double added_ = 0.0;                   ///< sum of the sizes of errors added
  double detuned_ = 0.0;  ///< by how much less than the run the error has turned in its steps, all together [rad]
};

}  // namespace bough::run
