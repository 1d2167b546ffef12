#pragma once
/// Backward differences of second or third order on the group, index 3.
///   D = log(H_n^-1 H_{n+1}),   y(t) = log(H_n^-1 H(t)),   y' = (c0 D + c2 y_{n-1} + c3 y_{n-2}) / h
///   v_{n+1} = T(D) y',   v'_{n+1} = (c0 v_{n+1} + c1 v_n + c2 v_{n-1} + c3 v_{n-2}) / h,   R = 0, Phi = 0 at t_{n+1}
///   c = (3/2, -2, 1/2, 0) or (11/6, -3, 3/2, -1/3)
/// y are the local coordinates of the step: y_{n-1} = -D_{n-1}, y_{n-2} = log(exp(-D_{n-1}) exp(-D_{n-2})). Earlier
/// poses are carried into the coordinates of each step exactly. The order is therefore that of the linear scheme, in
/// positions, velocities, accelerations and multipliers. Vibrations much faster than the step are damped within a few
/// steps. Order 2 damps all vibrations; order 3 is stable within 86 degrees of the negative axis: undamped vibrations
/// of some 3 to 12 steps a period grow.
///
/// The iteration's matrix is that of generalized-alpha with slopes c0 / h and their square:  dv = (c0 / h) T(D /
/// c0)^-1 eta to first order.
///
/// Start: the first two steps are taken by generalized-alpha, each in four sub-steps, whose error over so short a time
/// is of third order. At index 3 the scheme has a steady velocity error in the constraints' normals, -(h^2 / 3) G (v''
/// + ad(v) v' / 2) at order 2 and -(h^3 / 4) G (v''' + ad(v) v'') at order 3. It is added to the velocities of the
/// start as well; otherwise multipliers would be of lower order in the following steps. Any change of h is a new start.
/// Sources: Faltinsen, Marthinsen, Munthe-Kaas 2001 (multistep methods in coordinates of each step); Wieloch, Arnold
/// 2021 (starting values at index 3).
#include <variant>
#include <vector>

#include "bough/step/integrator.hpp"

namespace bough::step {

class Bdf final : public Integrator {
 public:
  /// `order`: 2; everything else is 3.
  Bdf(System& system, int order);
  std::unique_ptr<Integrator> clone() const override { return std::make_unique<Bdf>(*this); }

  /// Discards the history. The next step begins with the starting procedure, from positions, velocities and dv/dt of
  /// its state.
  StartReport start(State& state, const StepOptions& options, double step_size) override;
  StartReport change_step_size(State& state, const StepOptions& options, double step_size) override;
  StepReport advance(State& state, const StepOptions& options, double end_time) override;

  void checkpoint(records::Archive& archive) override {
    archive(h_, done_, begin_, alpha_, first_, second_, history_, signals_last_, signals_earlier_, steady_error_);
  }

  /// A Newton correction of the step, as `iterate` asks for it.
  void apply_in_visit(int visit, State& state, const double* x) const;
  std::optional<Trouble> complete(State& state, const double* x) const;

 private:
  /// History of earlier steps, on the scene's group.
  template <class G>
  struct HistoryOn {
    using Vectors = std::vector<typename G::template Vector<double>>;
    Vectors samples[3];                ///< v' after sub-steps 2, 5 and 8 of the start
    Vectors last, earlier;             ///< D_{n-1}, D_{n-2}
    Vectors v_now, v_last, v_earlier;  ///< v_n, v_{n-1}, v_{n-2}
    Vectors y, rates;                  ///< c2 y_{n-1} + c3 y_{n-2}; c1 v_n + c2 v_{n-1} + c3 v_{n-2}
    void resize(std::size_t num_nodes);
    void checkpoint(records::Archive& archive) {
      archive(samples[0], samples[1], samples[2], last, earlier, v_now, v_last, v_earlier, y, rates);
    }
  };
  template <class G>
  HistoryOn<G>& history() {
    return std::get<HistoryOn<G>>(history_);
  }
  template <class G>
  const HistoryOn<G>& history() const {
    return std::get<HistoryOn<G>>(history_);
  }
  static constexpr int start_steps = 2, parts = 4;
  struct Rule {
    double c0, c1, c2, c3;
  };
  static constexpr Rule second{3.0 / 2.0, -2.0, 1.0 / 2.0, 0.0}, third{11.0 / 6.0, -3.0, 3.0 / 2.0, -1.0 / 3.0};
  StepReport take_start_step(State& state, const StepOptions& options, double end_time);
  [[nodiscard]] std::optional<Trouble> finish_start(const State& state);
  StepReport take_step(State& state, const StepOptions& options, double end_time);
  [[nodiscard]] std::optional<Trouble> follow(State& state) const;
  template <class G>
  void follow_node(NodesOn<G>& nodes, std::size_t node) const;
  std::optional<Trouble> judge_turn(const State& state) const;
  void predict(State& state);
  void predict_signals(State& state);
  void follow_states(SignalValues& signals) const;
  /// Sets steady_error_, the steady error of the scheme's velocities at a point of the start.
  void eval_steady_error(const State& point);

  System& system_;
  int order_;
  Rule c_;
  double h_ = 0.0;
  int done_ = 0;          ///< number of starting steps taken
  State begin_;           ///< state at the start of the present step
  State alpha_;           ///< state of generalized-alpha between the starting steps
  State first_, second_;  ///< states at the start and after its first step
  motion::Groups::OneOf<HistoryOn> history_;
  /// Signals at the ends of the last step and of the one before, of which the states' rates are made.
  std::vector<double> signals_last_, signals_earlier_;
  std::vector<double> steady_error_;  ///< as a vector of unknowns
};

}  // namespace bough::step
