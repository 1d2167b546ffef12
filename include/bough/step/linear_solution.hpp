#pragma once
/// The linear solution of a step: tree, solver, and the policy by which a factor serves again. Newton's iterations
/// ask it whether the factor at hand will do; how much of a solution is checked is its own affair.
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "bough/elements/evaluate.hpp"
#include "bough/plan/plan.hpp"
#include "bough/records/archive.hpp"
#include "bough/solve/any_solver.hpp"
#include "bough/step/cpu_clock.hpp"
#include "bough/step/trouble.hpp"
#include "bough/tree/tree.hpp"
#include "bough/tree/walker.hpp"

namespace bough::step {

/// What a plan and the options of a scene ask of the linear solver.
tree::TreeOptions make_tree_options(const plan::Plan& plan, const scene::Solver& given);
solve::SolveOptions make_solve_options(const plan::Plan& plan, const scene::Solver& given);

/// Which node, joint or signal a block of the graph belongs to.
class BlockOwners {
 public:
  explicit BlockOwners(const plan::Plan& plan);
  /// Index in Plan::joints, Plan::nodes or Plan::signals; -1: of another.
  int joint(int block) const { return joints_[static_cast<std::size_t>(block)]; }
  int node(int block) const { return nodes_[static_cast<std::size_t>(block)]; }
  int signal(int block) const { return signals_[static_cast<std::size_t>(block)]; }
  /// "joint 'b'" or "'a'", for messages.
  std::string name(int block) const;

 private:
  const plan::Plan& plan_;
  std::vector<int> joints_, nodes_, signals_;
};

class LinearSolution {
 public:
  /// Seconds and counts of its work are added to `counts`.
  LinearSolution(const plan::Plan& plan, const scene::Solver& solver, const tree::Walker& walker, CpuClock& clock,
                 WorkCounts& counts);

  const tree::Tree& tree() const { return *tree_; }
  const BlockOwners& owners() const { return owners_; }
  solve::AnySolver& solver() { return *solver_; }
  const solve::AnySolver& solver() const { return *solver_; }

  /// The visits of the solver's walks in which elements are evaluated and nodes are moved, and the elements of one.
  /// With one thread, whose walks have a fixed order, these are the first visits of runs that together have so many
  /// elements that few lanes stay empty; all others have none.
  const solve::SolverVisits& visits() const { return visits_; }
  std::span<const int> elements_of_visit(int visit) const;
  /// Calls `work` in an upward walk.
  void visit_all(solve::VisitWork work) const { solver_->visit_all(walker_, work); }

  /// To be called before element matrices are written: what is known of those present holds no longer. are_symmetric:
  /// they will be, to the last bit.
  void begin_matrices(bool are_symmetric = false);
  /// Counts the calls of begin_matrices: what was derived from the element matrices holds while it does not change.
  long num_matrices() const { return num_matrices_; }
  /// Factors the element matrices, made with these slopes: those now present, or those that `before` writes in the
  /// visits of the walk. With rhs, which `before` may write, too, the right-hand side is condensed in the same walk.
  [[nodiscard]] std::optional<Trouble> factor(bool rescale, const elements::Slopes& slopes,
                                              solve::VisitWork before = {}, const double* rhs = nullptr);
  /// Condenses a right-hand side, whose entries `before` writes, upward with the present factor.
  void condense(solve::VisitWork before, const double* rhs);
  /// x <- A^-1 rhs for the right-hand side that was condensed last, downward. `after` runs in every visit when its
  /// unknowns are known. The backward error is checked as often as by solve(.., false).
  [[nodiscard]] std::optional<Trouble> substitute(const double* rhs, double* x, solve::VisitWork after);
  /// Whether the present factor was made with these slopes (of some earlier state).
  bool has_factor(const elements::Slopes& slopes) const;
  /// Whether it is that of the element matrices now present.
  bool is_of_matrices() const { return is_of_matrices_; }
  /// x <- A^-1 rhs. check: false: its backward error may be left out, but for every 32nd solution, where one with this
  /// factor, or one before it with the same scales and slopes, was found good (the latter with a digit to spare) and no
  /// pivot had to wait since; then last_solution() stays that of the last check.
  [[nodiscard]] std::optional<Trouble> solve(const double* rhs, double* x, bool check = true);
  const solve::SolveReport& last_solution() const { return last_solution_; }
  /// y <- A x with the element matrices now present.
  void multiply(const double* x, double* y) { solver_->multiply(walker_, x, y); }

  /// Whether tangents are replaced by their symmetric parts (plan decision "symmetric"); drop_symmetry: not from now
  /// on.
  bool takes_symmetric_parts() const { return takes_symmetric_parts_; }
  void drop_symmetry() { takes_symmetric_parts_ = is_factored_ = false; }

  /// The matrices and the factor at hand are of another state than the next one: they do not serve again.
  void forget_factor() { is_factored_ = is_of_matrices_ = is_trusted_ = false; }

  /// Whether rows of constraints depend on each other, by the last factorization.
  bool has_dependent_rows() const { return solver_->last_status().deficiency > 0; }
  /// As of the solver.
  void make_least(double* x) { solver_->make_least(x); }

  /// How much an iteration with the present factor shrank the changes when last seen; 1 when not known.
  double last_contraction() const { return contraction_; }
  void set_last_contraction(double contraction) { contraction_ = contraction; }
  /// Solutions that a tangent and its factor cost, by estimate_step_cost.
  double renewal_cost() const { return renewal_cost_; }
  void set_renewal_cost(double solutions) { renewal_cost_ = solutions; }
  /// To be called when an iteration has ended that took `solutions` with the present factor. A factor is worn once
  /// the last iteration took at least as many solutions as the steps since it was made cost on average, the factor
  /// included: to go on would raise that average.
  void note_service(int solutions);
  bool is_factor_worn() const { return is_worn_; }

  /// From now on it is known of which matrices the solver holds something, so that all of it can be made again.
  void remember() { remembers_ = true; }
  /// Whether the solver holds something of these matrices, by num_matrices.
  bool uses(long matrices) const {
    return matrices == num_matrices_ || matrices == made_of_.factor || matrices == made_of_.scales ||
           matrices == made_of_.measured;
  }
  /// Of a solver that was told to remember. What the solver itself holds is not among it, but made again after reading
  /// by make_again.
  void checkpoint(records::Archive& archive) {
    std::int64_t delayed = delayed_pivots();
    archive(delayed);
    if (archive.is_reading()) delayed_before_ = delayed;
    archive(made_of_, num_matrices_, is_factored_, factored_, is_of_matrices_, is_trusted_, unchecked_, last_solution_,
            takes_symmetric_parts_, contraction_, service_cost_, iterations_served_, is_worn_);
  }
  /// Over all factorizations of the run.
  std::int64_t delayed_pivots() const { return delayed_before_ + solver_->counters().delayed_pivots; }
  /// Makes the factor that was there when the archive was written, to the last bit: write(matrices) writes the element
  /// matrices of this number. False: it cannot.
  template <class Write>
  [[nodiscard]] bool make_again(Write&& write);
  /// For tangents that were made before drop_symmetry was called.
  void take_symmetric_parts(bool takes) { takes_symmetric_parts_ = takes; }

 private:
  /// Numbers of the matrices of which the solver holds the factor, the scales, and the sizes; -1: of none.
  struct MadeOf {
    long factor = -1, scales = -1, measured = -1;
    long factors = 0;        ///< made so far
    long next_measured = 0;  ///< number of factors after which sizes are measured again
  };
  static constexpr long measurement_serves = solve::Hierarchical::measurement_serves;
  void note_scales(bool are_new);
  void note_checked();
  void factor_again();
  void check_again();
  std::string explain_singular(const solve::FactorStatus& status) const;
  bool may_skip_check();
  std::optional<Trouble> find_trouble(const solve::SolveReport& solution);

  /// Solutions from one check of the backward error to the next: on chains a check takes as long as the solution
  /// itself.
  static constexpr int check_every = 32;
  /// Backward error of a solution that needed no refinement: that of SolveOptions::refinement_above. With a digit to
  /// spare, the next factor of the same scales and slopes is trusted before it was checked.
  double good_ = 0.0;

  const plan::Plan& plan_;
  BlockOwners owners_;
  tree::Walker walker_;
  CpuClock& clock_;
  WorkCounts& counts_;
  std::unique_ptr<tree::Tree> tree_;
  std::unique_ptr<solve::AnySolver> solver_;
  solve::SolverVisits visits_;
  std::vector<int> elements_;               ///< in the order of visits
  std::vector<std::size_t> element_begin_;  ///< by visit, and their number
  solve::SolveReport last_solution_;
  elements::Slopes factored_;  ///< slopes of the present factor
  bool is_factored_ = false;
  bool is_of_matrices_ = false;
  long num_matrices_ = 0;
  bool is_trusted_ = false;  ///< it, or one like it, gave a solution that needed no refinement
  int unchecked_ = 0;        ///< solutions since the last that was checked
  bool takes_symmetric_parts_;
  double contraction_ = 1.0;
  double renewal_cost_ = 0.0;
  double service_cost_ = 0.0;  ///< of the present factor: renewal_cost and the solutions of all iterations since
  int iterations_served_ = 0;
  bool is_worn_ = false;
  bool remembers_ = false;
  std::int64_t delayed_before_ = 0;  ///< pivots that were delayed before the archive was written that was read
  MadeOf made_of_;
  std::vector<double> scales_;  ///< of columns, where it remembers: the solver may choose new ones by itself
};

template <class Write>
bool LinearSolution::make_again(Write&& write) {
  const MadeOf made_of = made_of_;
  const auto present = num_matrices_;
  const auto state = std::tuple(is_factored_, is_of_matrices_, is_trusted_, takes_symmetric_parts_);
  long written = -1;
  const auto make = [&](long matrices) {
    if (matrices == written) return true;
    written = matrices;
    return write(matrices);
  };
  bool is_made = true;
  if (is_factored_) {
    const bool is_measured = made_of.measured >= 0;
    const long since = is_measured ? measurement_serves - (made_of.next_measured - made_of.factors) : 0;
    solver_->rescale();
    is_made = make(made_of.scales);
    factor_again();
    if (is_measured && since > 0) {
      is_made = is_made && make(made_of.measured);
      check_again();
    }
    const long times = std::max(std::min(since, measurement_serves), made_of.factor != made_of.scales ? 1L : 0L);
    for (long k = 0; k < times; ++k) {
      is_made = is_made && make(made_of.factor);
      factor_again();
    }
    if (is_measured && since == 0) {
      is_made = is_made && make(made_of.measured);
      check_again();
    }
  }
  if (present > 0) is_made = make(present) && is_made;
  std::tie(is_factored_, is_of_matrices_, is_trusted_, takes_symmetric_parts_) = state;
  delayed_before_ -= solver_->counters().delayed_pivots;
  num_matrices_ = present;
  return is_made;
}

}  // namespace bough::step
