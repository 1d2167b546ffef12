#pragma once
/// Constraint rows of all joints at a state: their time derivatives and how far they are violated.
#include <vector>

#include "bough/lanes/taylor.hpp"
#include "bough/step/instant.hpp"
#include "bough/step/signal_series.hpp"
#include "bough/step/state.hpp"
#include "bough/tree/walker.hpp"

namespace bough::step {

/// Largest |Phi| and |Phi'| over all rows of joints, and the same without units of length: lengths are divided by the
/// lengths of the parts that meet in the joint (plan::JointPlan::length).
struct Violations {
  double position = 0.0, relative_position = 0.0;  ///< [m] or [rad], [-]
  double velocity = 0.0, relative_velocity = 0.0;  ///< [m/s] or [rad/s], [1/s]
  int open_joint = -1, fast_joint = -1;  ///< index in Plan::joints of the largest relative values; -1: all are zero
};

/// Rows that the scene's motions satisfy by themselves, and which are therefore no unknowns, are evaluated as well;
/// `violations` leaves out joints that only keep nodes without rotations from turning.
class Constraints {
 public:
  Constraints(const plan::Plan& plan, const Instant& instant, const tree::Walker& walker);

  /// The rows and their first three time derivatives as Taylor coefficients, by multiplier. jerk: second derivatives of
  /// velocities by node, or null for zero. step_size: the interval over which third derivatives of prescribed motions
  /// are differenced; 0: these are left out.
  void series(const State& state, const motion::Vec6<double>* jerk, double step_size,
              std::vector<lanes::Taylor<double, 3>>& out) const;
  Violations violations(const State& state) const;
  /// Largest |Phi| (order 0) or |Phi'| (order 1) over all rows. joint: receives the index of its joint, if not null.
  double violation(const State& state, int order, int* joint = nullptr) const;
  /// The same without units of length, [-] (order 0) or [1/s] (order 1).
  double relative_violation(const State& state, int order, int* joint = nullptr) const;

 private:
  /// Laws as series, those that are signals along the motion of the state.
  const Instant::Series& laws_of(const State& state, const elements::Field& field, double step_size) const;
  double largest_violation(const State& state, int order, bool is_relative, int* joint) const;

  const plan::Plan& plan_;
  const Instant& instant_;
  tree::Walker walker_;
  std::vector<int> nodes_;                             ///< of the joints that violations() evaluates, ascending
  mutable std::vector<elements::NodeMotion> motions_;  ///< scratch of violations: these nodes in space
  mutable Instant::Series series_;                     ///< scratch of largest_violation
  mutable Instant::Series laws_;                       ///< scratch where signals drive rows
  mutable std::vector<lanes::Taylor<double, 1>> law_rates_;
  mutable SignalSeries signals_;
  mutable std::vector<Violations> parts_;  ///< scratch of violations, by chunk of joints
};

}  // namespace bough::step
