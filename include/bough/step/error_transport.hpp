#pragma once
/// How an error of the motion goes on: forgotten where the motion is damped, kept where it is free, and grown where the
/// motion is sensitive. It obeys the equations of motion linearised along the run,
///   R_H eta + R_v du + R_a da + G^T dlambda = 0,   G eta = 0
/// with the displacements z = (dx, dtheta) of the nodes in the axes of the ground, and for each node with R, v = (u, w)
/// and dv/dt = (a, b) in its own axes
///   eta = R^T z,   du = R^T dx' + u x eta_w,   dw = R^T dtheta',
///   d(du)/dt = R^T dx'' - w x R^T dx' + a x eta_w + u x (dw - w x eta_w),   d(dw)/dt = R^T dtheta'' - w x R^T dtheta'
/// The rule is generalized-alpha on z. Its steps may span many steps of the run: they have to resolve the motion of
/// the error, not the error of the motion. To the error carried so far, the local errors of the steps are added.
#include <optional>
#include <vector>

#include "bough/step/step_control.hpp"
#include "bough/step/system.hpp"

namespace bough::step {

struct AlphaRule;

/// Has a system and factors of its own, so that a run is the same with and without it. Allocates when it is made and in
/// its first step.
class ErrorTransport {
 public:
  /// Keeps the plan, and a copy of `start` for its time.
  ErrorTransport(const plan::Plan& plan, const scene::Solver& solver, const tree::Walker& walker, const State& start);
  /// The same error at the same time, with factors of its own.
  ErrorTransport(const ErrorTransport& other);

  /// Carries the error to this state, which has the mean tangent of the time since the last one.
  [[nodiscard]] std::optional<Trouble> carry(const State& state);
  /// To be called at the far side of a jump, at this time: accelerations of the error are not known there.
  void restart(double time);
  /// Adds the error that `local` measured last, `steps` times: that of steps which followed each other. Of an error
  /// that changes from step to step, as that of a vibration does, only so many of its steps are counted as keep its
  /// sign. Returns the largest displacement added, as `size`.
  double add(const State& state, const LocalError& local, double steps);

  /// Adds a change of velocities that is `duration` [s] times the accelerations of the nodes, of what the path and the
  /// rotation need as well as of the speed, and round-off, in directions that look random.
  void disturb(const State& state, double duration);

  void checkpoint(records::Archive& archive) {
    archive(time_, z_, rate_, second_, algorithmic_, signals_, step_, random_, is_solved_, num_solutions_);
  }

  /// Whether the last step was solved, and how many solutions it took.
  bool is_solved() const { return is_solved_; }
  int num_solutions() const { return num_solutions_; }

  /// Largest displacement of the error so far, lengths over the size of the structure, or rad; infinite once it is not
  /// a finite number.
  double size() const;
  /// Displaces a node, given in space, by `share` of the error, and changes its velocity.
  void displace(double share, std::size_t node, elements::NodeMotion& motion) const;
  /// Displacements and rates of all nodes, in the axes of the ground.
  const std::vector<motion::Vec6<double>>& displacements() const { return z_; }

 private:
  struct BodyRates {
    motion::Vec6<double> v, a;
  };
  BodyRates rates_of(const elements::NodeMotion& node, const motion::Vec6<double>& z, const motion::Vec6<double>& rate,
                     const motion::Vec6<double>& second) const;
  std::optional<Trouble> solve_rates(const State& state, double h);
  std::optional<Trouble> begin_step(const State& state, const AlphaRule& rule);
  std::optional<Trouble> solve_once(const State& state, const AlphaRule& rule, double& left);
  double find_extra_rates(const std::vector<elements::NodeMotion>& nodes, const AlphaRule& rule);
  void end_step(const AlphaRule& rule);

  const plan::Plan& plan_;
  scene::Solver solver_;
  tree::Walker walker_;
  System system_;
  State moved_;
  double time_;
  std::vector<motion::Vec6<double>> z_, rate_, second_, algorithmic_;  ///< by node, in the axes of the ground
  std::vector<motion::Vec6<double>> next_, extra_v_, extra_a_;         ///< scratch
  std::vector<double> base_, rhs_, x_;                                 ///< scratch, by unknown
  SignalValues signals_;                                               ///< errors of signals
  double step_ = 0.0;  ///< of the error, the last [s]; 0: none since a start
  unsigned long long random_ = 20;
  bool is_solved_ = true;
  int num_solutions_ = 0;
};

}  // namespace bough::step
