#pragma once
/// A plan with what is needed to evaluate and solve it, put together once for a run.
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "bough/step/constraints.hpp"
#include "bough/step/corrections.hpp"
#include "bough/step/element_evaluation.hpp"
#include "bough/step/instant.hpp"
#include "bough/step/linear_solution.hpp"
#include "bough/step/node_drift.hpp"
#include "bough/step/node_order.hpp"
#include "bough/step/residual_sums.hpp"
#include "bough/step/round_off.hpp"
#include "bough/step/signals.hpp"
#include "bough/step/state.hpp"
#include "bough/step/unknown_places.hpp"

namespace bough::step {

/// Buffers of the functions in advance.hpp, sized once: a step does not allocate.
struct Workspace {
  std::vector<double> rhs, x;  ///< of the linear system
  State start;                 ///< of a step
  State before;                ///< statics: where an iteration started
  /// Quantities at the end of a step, of a chunk of nodes: State::local_error, State::increment, and the largest second
  /// difference of accelerations, linear ones over the size of the structure.
  struct StepEnd {
    double error = 0.0, increment = 0.0, of_change = 0.0;
  };
  std::vector<StepEnd> step_ends;  ///< by chunk of eights
  std::vector<Misses> misses;      ///< of accelerations, by node
  std::vector<double> eight_most;  ///< by eight of nodes: the largest of something
  motion::Groups::OneOf<DriftChoice> drift_choice;
  motion::Groups::OneOf<DriftedStart> drifted;  ///< of the step that `start` begins
};

class HeldNodes;
class TrimmedElements;

/// Holds the parts below, each with a task of its own, and evaluates the residual with them. Allocates when it is made,
/// not afterwards.
class System {
 public:
  System(const plan::Plan& plan, const scene::Solver& solver, const tree::Walker& walker);
  ~System();

  const plan::Plan& plan() const { return plan_; }
  const tree::Walker& walker() const { return walker_; }
  WorkCounts& counts() { return counts_; }
  CpuClock& clock() { return clock_; }
  Workspace& work() { return work_; }
  const Workspace& work() const { return work_; }

  /// Factors and solves with the tangents that `evaluate` leaves.
  LinearSolution& linear() { return linear_; }
  const LinearSolution& linear() const { return linear_; }
  /// Laws, gravity and prescribed frames at the time that was set last.
  const Instant& instant() const { return instant_; }
  const UnknownPlaces& places() const { return places_; }
  /// Takes out of the multipliers of a state what no equation sees by the last factorization, where rows of constraints
  /// depend on each other. Increments of least norm do not sum up to multipliers of least norm: null vectors turn with
  /// the structure, and what predictors extrapolate along them grows with the motion, by e every 1/w at a rate w.
  void make_least(State& state);
  ElementEvaluation& elements() { return elements_; }
  const ElementEvaluation& elements() const { return elements_; }
  const ResidualSums& sums() const { return sums_; }
  RoundOff& round_off() { return round_off_; }
  const RoundOff& round_off() const { return round_off_; }
  Signals& signals() { return signals_; }
  Corrections& corrections() { return corrections_; }
  const Corrections& corrections() const { return corrections_; }
  const Constraints& constraints() const { return constraints_; }
  const std::shared_ptr<const NodeOrder>& node_order() const { return node_order_; }
  /// ElementLengths::moment_arm.
  double moment_arm() const { return lengths_.moment_arm; }

  /// Sets the values of all time functions at t (left or right limit). A value that is not finite is reported with its
  /// owner and the time.
  [[nodiscard]] std::optional<Trouble> set_time(double time, laws::Side side = laws::Side::left);
  /// Evaluates all elements, with their tangents if `tangent`, and adds their residuals up.
  [[nodiscard]] std::optional<Trouble> evaluate(const State& state, const elements::Slopes& slopes, bool tangent);
  /// The same in one upward walk with the condensation of the right-hand side, minus the residual, by the present
  /// factorization: LinearSolution::substitute completes the solution.
  [[nodiscard]] std::optional<Trouble> evaluate_and_condense(const State& state, const elements::Slopes& slopes);
  /// The same with tangents and a new factorization. `of_factor`: receives what it reports, if the evaluation succeeds.
  [[nodiscard]] std::optional<Trouble> evaluate_and_factor(const State& state, const elements::Slopes& slopes,
                                                           bool rescale, std::optional<Trouble>& of_factor);
  /// Adds up what elements have written. A sum that is not finite is reported with the owner of the element.
  [[nodiscard]] std::optional<Trouble> sum(const State& state);
  /// Minus the residual of the last evaluation, by unknown: -(R, Phi), for which a Newton correction is solved.
  const std::vector<double>& right_hand_side() const { return sums_.right_hand_side(); }
  ResidualSize residual_size() const { return sums_.size(); }

  /// From now on the tangents of which the solver holds something are kept, so that `checkpoint` may be called.
  void remember();
  bool remembers() const { return !remembered_.empty(); }
  /// Writes what evaluations and solutions to come depend on, or reads it and makes the factor again. write_others:
  /// writes element matrices that were not evaluated here, by LinearSolution::num_matrices; false: they are not its own.
  /// Throws std::runtime_error where the factor cannot be made. The time has to be set anew after reading.
  void checkpoint(records::Archive& archive, const std::function<bool(long)>& write_others);

  /// Computes the multipliers of joints that hold nodes without unknowns (Plan::held) from the balance of forces at
  /// these nodes; the laws of the state's time are set. To be called for every state that is accepted. more: forces by
  /// node, own axes, in addition to those of elements.
  void recover_multipliers(State& state, const std::vector<motion::Vec6<double>>* more = nullptr) const;
  /// The largest of these multipliers that inertia requires where velocities jump by a solution x of [M G^T; G 0].
  double largest_held_impulse(const State& state, const double* x) const;

 private:
  /// What tangents were evaluated at.
  struct Tangents {
    long matrices = -1;  ///< LinearSolution::num_matrices
    State state;
    elements::Slopes slopes;
    double time = 0.0;
    laws::Side side = laws::Side::left;
    bool take_symmetric_parts = false;
    void checkpoint(records::Archive& archive) { archive(matrices, state, slopes, time, side, take_symmetric_parts); }
  };
  void keep_tangents(const State& state, const elements::Slopes& slopes);
  bool evaluate_again(const std::vector<Tangents>& known, long matrices);
  void begin(const State& state, const elements::Slopes& slopes, bool tangent);
  std::optional<Trouble> end(const State& state);
  solve::VisitWork in_visits();

  const plan::Plan& plan_;
  tree::Walker walker_;
  CpuClock clock_;
  WorkCounts counts_;
  LinearSolution linear_;
  Instant instant_;
  UnknownPlaces places_;
  ElementLengths lengths_;
  std::shared_ptr<const NodeOrder> node_order_;
  Constraints constraints_;
  std::unique_ptr<TrimmedElements> trimmed_;  ///< null where all nodes have the same unknowns
  std::unique_ptr<HeldNodes> held_;           ///< null where all nodes have unknowns
  ResidualSums sums_;
  ElementEvaluation elements_;
  Signals signals_;
  RoundOff round_off_;
  std::vector<double> least_;  ///< by unknown, of make_least
  Corrections corrections_;
  Workspace work_;
  std::vector<Tangents> remembered_;  ///< room for as many as the solver may hold something of, and one more
};

}  // namespace bough::step
