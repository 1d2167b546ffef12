#pragma once
/// Local error of a step of generalized-alpha, and the control of the step size to a tolerance.
///
/// What a step leaves of the exact motion through its start, in a node's own axes (rule's terms against the Magnus
/// series of the motion):
///   e_q = h^3 (C_q v'' - ad(v) v' / 12),  e_v = h^3 C_v v''',   d = alpha_m - alpha_f
///   C_q = beta + d/2 - 1/6,   C_v = kappa - d^2/2 + 1/12,   kappa = (1 - alpha_f - (1 - alpha_m)(1 + 2 d) - d^2) / 2
/// v'' is the change of v' over the step. Where constraints or stiff parts hold the motion, this is not what comes of
/// it: the step's own matrix S = K + c1 C + c2 M with its constraints carries it to where the step does,
///   [S G^T; G 0] (e, mu) = (c2 M e_q, 0),
/// so that vibrations which the step filters and directions which constraints fix count no more than they move. v'''
/// is the change of e / (C_q h^3) from step to step. A state x' = f of a signal leaves, with the alpha_m of its rule,
///   e_x = h^3 C_x x''',   C_x = 1/12 + (alpha_m - alpha_f)(alpha_f - 1/2)
/// which the row of its equation carries to where the step does: s e_x on the right-hand side, s = d(x')/dx of the
/// step. x''' is the second difference of x' over the last steps. Sources: Zienkiewicz, Xie 1991 (error from the change
/// of accelerations); Hairer, Wanner 1996, IV.8 (error filtered by the step's matrix).
#include <optional>
#include <string>
#include <vector>

#include "bough/step/options.hpp"
#include "bough/step/system.hpp"

namespace bough::step {

/// Largest parts over all nodes.
struct ErrorParts {
  double position = 0.0;          ///< [m]
  double rotation = 0.0;          ///< [rad]
  double velocity = 0.0;          ///< [m/s]
  double angular_velocity = 0.0;  ///< [rad/s]
};

/// What the last measured error asked for small steps.
struct ErrorLimit {
  int node = -1;             ///< in Plan::nodes, where it was largest
  int signal = -1;           ///< in Plan::signals: of a state rather than of a motion; then there is no node
  bool is_velocity = false;  ///< of a velocity rather than of a place
  bool is_energy = false;    ///< of an energy of the whole structure; then there is no node
  double frequency =
      0.0;  ///< at which the error changes there from step to step [rad/s]; of a vibration, its own up to 2 / h
};

/// Local errors along a run. Allocates when made, not afterwards.
class LocalError {
 public:
  /// `absolute`: allowances beside the tolerance, 0: none. Sizes that errors are compared with: the size of the
  /// structure, 1 rad, the largest speeds so far, and these at the least: the size of the structure and 1 rad in
  /// `duration` [s]. Where step control is on, errors count where sensors look: a vibration faster than the step that
  /// no sensor sees would otherwise ask for steps that resolve it, although the scheme filters it. Without sensors
  /// they count everywhere. What each kind of sensor watches stands in data/manual/theory/integrators.md.
  LocalError(const System& system, const StepOptions& options, double duration);

  /// A start, or the far side of a jump: v''' is not known in the first step.
  void restart() { has_previous_ = false; }
  void checkpoint(records::Archive& archive) {
    archive(speed_, spin_, parts_, energy_, now_, previous_, step_, previous_step_, has_previous_, states_);
  }

  /// Of the step that `advance` just took to `after` (its factor is still there), which must be whole.
  /// Overwrites the residual and the right-hand side of `system`. Fails where the solution does.
  [[nodiscard]] std::optional<Trouble> measure(System& system, const State& after);
  /// The step is accepted: speeds and v'' of it are kept.
  void accept(const State& after);

  const ErrorParts& parts() const { return parts_; }

  /// The last measured error of a node, in its own axes: the displacement that a step leaves, the mean of the last two
  /// steps if both were measured; its change from the one to the other; and what is left of the velocity. Change and
  /// velocity are zero where the step before was not measured. To be asked before `accept`.
  struct OfNode {
    motion::Vec6<double> place, change, velocity;
  };
  OfNode of_node(std::size_t node) const;
  /// Errors of the states of signals in the last measured step, in the order of the states of Plan::signals.
  double of_state(std::size_t k) const { return step_ * step_ * step_ * states_[k].error; }
  /// To be asked before `accept`. tolerance: of the control, which weighs places against velocities.
  ErrorLimit limit(double tolerance) const;
  /// Displaces a node, given in space, by the last measured e_q, and changes its velocity by e_q / h.
  void displace(std::size_t node, elements::NodeMotion& motion) const;
  /// Largest parts of the last measured error over what they are compared with: size + allowance / tolerance [-].
  double relative_motion() const;    ///< of positions and rotations
  double relative_velocity() const;  ///< of velocities
  double relative_state() const;     ///< of states of signals, over 1 or the largest value so far
  double relative_energy() const { return energy_; }

  /// `after` with its nodes displaced by the last measured e_q, and velocities changed by e_v as far as it is known:
  /// what an energy changes by from one to the other is its local error.
  void disturb(const State& after, State& to) const;
  /// The error of energies that sensors show in the last measured step, over the largest energy so far [-].
  void set_energy_error(double relative) { energy_ = relative; }

  /// Names the error that asks for the smallest step at this tolerance, the node of limit(), and how many times it is
  /// what the tolerance allows. To be asked before `accept`.
  std::string describe(const plan::Plan& plan, double tolerance) const;

 private:
  void watch(const plan::Plan& plan);
  void watch(const plan::Plan& plan, const plan::SensorPlan& sensor);
  void watch_ends(const plan::Plan& plan, int node);
  void watch_mechanism(const plan::Plan& plan);
  void watch(const elements::Port& port, bool turns, bool velocity);
  void watch(int node, double arm, bool turns, bool velocity);
  double velocity_factor() const;
  /// What errors are compared with: size + allowance / tolerance.
  ErrorParts sizes() const;
  void shift_accelerations(const System& system, const State& after, State& to) const;
  void enter_states(System& system, const State& after, std::vector<double>& rhs);

  const plan::Plan& plan_;
  double spectral_radius_;
  AlphaCoefficients alpha_;
  ErrorParts least_, allowance_;  ///< least sizes; absolute tolerances over the relative one
  double speed_ = 0.0, spin_ = 0.0;
  ErrorParts parts_;
  double energy_ = 0.0;
  std::vector<motion::Vec6<double>> now_, previous_;  ///< e / h^3 by node
  double step_ = 0.0, previous_step_ = 0.0;
  bool has_previous_ = false;
  /// What counts of a node's errors.
  struct Watched {
    bool place = false, turns = false, velocity = false;
    double arm = 0.0;  ///< of its rotation at what is looked at [m], counted with its place
  };
  std::vector<Watched> watched_;  ///< by node
  /// A state of a signal. All of them count, seen by sensors or not.
  struct WatchedState {
    std::size_t signal = 0;
    double size = 1.0;                       ///< 1, or the largest so far
    double error = 0.0;                      ///< e_x / h^3
    double trend = 0.0, trend_before = 0.0;  ///< change of x' over the last measured step and the one before, by h
  };
  std::vector<WatchedState> states_;
  State shifted_;
};

/// Step sizes from errors. A step is accepted where its local error keeps
///   E = max(e_q / tolerance^(3/2), e_v / tolerance, e_x / tolerance^(3/2), e_E / tolerance^(3/2)) <= 1,
/// e relative to sizes, e_x of states of signals, e_E of energies where sensors show these. The integrator is of second
/// order, so steps are of the order of tolerance^(1/2) of the motion's characteristic time, and the local errors of one
/// such time add up to about the tolerance: the global error follows the tolerance (tolerances are transformed so by
/// RADAU5, too, Hairer, Wanner 1996, IV.8). Error per unit of time would do the same, but not where parts vibrate
/// faster than the step: errors there are their amplitude, whatever the step, and smaller steps would only make matters
/// worse. Velocities of smooth motions follow positions; those of such vibrations are held to the tolerance of the
/// whole, not of a step, for the same reason. The next size is a PI controller's (Gustafsson 1991; Soderlind 2003,
/// integral and proportional gains 0.6/3 and 0.4/3),
///   h (safety / E_n)^0.2 max(1/2, E_{n-1} / E_n)^0.133,   0.2 h to 4 h,
/// after an accepted step, h (safety / E_n)^(1/3) after a rejected one. A change costs three factors, so a size stays
/// while the next would be between 0.9 and 1.25 of it; it grows by the largest E (fading by 0.85 a step) of at least
/// four steps of one size (or where E is below 0.01), since E goes up and down with vibrations.
class StepController {
 public:
  static constexpr double safety = 0.8, integral = 0.6 / 3.0, proportional = 0.4 / 3.0;
  static constexpr int steps_to_grow = 4, steps_held = 8;
  static constexpr double far_below = 0.01;
  static constexpr double least_factor = 0.2, largest_factor = 4.0, dead_below = 0.9, dead_above = 1.25;

  explicit StepController(double tolerance) : tolerance_(tolerance) {}
  /// E of a step.
  double ratio(const LocalError& error) const;
  /// Next size after a step of size h that was accepted; h itself within the dead band.
  double after_accepted(double ratio, double h);
  /// Size of the next attempt.
  double after_rejected(double ratio, double h);
  /// Newton failed at h: half of it, and no growth in the next eight steps.
  double after_failure(double h);
  /// The far side of a jump: the error before it says nothing.
  void restart() {
    previous_ = most_ = 0.0;
    since_change_ = 0;
  }
  void checkpoint(records::Archive& archive) { archive(previous_, most_, since_change_); }

 private:
  double tolerance_;
  double previous_ = 0.0;  ///< E of the step before; 0: none
  double most_ = 0.0;      ///< largest E since the last change, fading
  int since_change_ = 0;   ///< steps since; below 0: growth is held up longer
};

}  // namespace bough::step
