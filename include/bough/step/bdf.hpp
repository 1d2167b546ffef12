#pragma once
/// Backward differences of third order on the group, index 3.
///   D = log(H_n^-1 H_{n+1}),  d/dt of local coordinates y(t) = log(H_n^-1 H(t)):  y' = (11/6 D + 3/2 y_{n-1} - 1/3 y_{n-2}) / h
///   v_{n+1} = T(D) y',   v'_{n+1} = (11/6 v_{n+1} - 3 v_n + 3/2 v_{n-1} - 1/3 v_{n-2}) / h,   R = 0, Phi = 0 at t_{n+1}
/// y_{n-1} = -D_{n-1}, y_{n-2} = log(exp(-D_{n-1}) exp(-D_{n-2})): earlier poses are carried into the coordinates of each step exactly, so that
/// the order is that of the linear space. Third order in positions, velocities, accelerations and multipliers; damps vibrations much
/// faster than the step within a few of them. Stable within 86 degrees of the negative axis: undamped vibrations of some 3 to 12 steps a period grow.
///
/// The iteration's matrix is that of generalized-alpha with slopes 11/(6 h) and their square:  dv = (11/(6 h)) T(6 D / 11)^-1 eta to first order.
///
/// Start: two steps by generalized-alpha in quarters, whose error over so short a time is of third order. Index 3 carries a steady velocity
/// error in the constraints' normals, -(h^3 / 4) G (v''' + ad(v) v''); the velocities of the start get it, too, or multipliers
/// would be of lower order in the steps to come. Any change of h is a new start.
/// Sources: Faltinsen, Marthinsen, Munthe-Kaas 2001 (multistep methods in coordinates of each step); Wieloch, Arnold 2021 (starting values at
/// index 3).
#include <vector>

#include "bough/step/advance.hpp"

namespace bough::step {

class Bdf {
 public:
  explicit Bdf(System& system);

  /// The next step, of size h, starts anew from positions, velocities and dv/dt of a state.
  void restart(double h);
  double step_size() const { return h_; }

  /// One step of size step_size() to `end_time`. Not converged: `state` is as it was; another size may follow.
  StepReport advance(State& state, const StepOptions& options, double end_time);

 private:
  using Vectors = std::vector<motion::Vec6<double>>;
  static constexpr int start_steps = 2, parts = 4;
  StepReport take_start_step(State& state, const StepOptions& options, double end_time);
  [[nodiscard]] std::optional<Trouble> finish_start(const State& state);
  StepReport take_step(State& state, const StepOptions& options, double end_time);
  [[nodiscard]] std::optional<Trouble> follow(State& state) const;
  void predict(State& state);

  System& system_;
  double h_ = 0.0;
  int done_ = 0;                         ///< starting steps
  State begin_;                          ///< of the present step
  State alpha_;                          ///< of the start, between its steps
  State first_, second_;                 ///< states at the start and after its first step
  Vectors samples_[3];                   ///< v' at parts 2, 5 and 8 of the start
  Vectors increments_, last_, earlier_;  ///< D of the present step, D_{n-1}, D_{n-2}
  Vectors v_now_, v_last_, v_earlier_;   ///< v_n, v_{n-1}, v_{n-2}
  Vectors y_, rates_;                    ///< 3/2 y_{n-1} - 1/3 y_{n-2}; -3 v_n + 3/2 v_{n-1} - 1/3 v_{n-2}
};

}  // namespace bough::step
