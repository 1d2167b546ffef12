#pragma once
/// Variational integrator: the midpoint rule on the group as a discrete Lagrangian, constraints as in SHAKE and RATTLE.
///   L_d = h L(H_n exp(D/2), D/h),  D = log(H_n^-1 H_{n+1}) node by node
///   p_n - (h/2) G_n^T lambda = -D_1 L_d,   Phi(q_{n+1}, t_{n+1}) = 0
///   p_{n+1} = D_2 L_d - G_{n+1}^T mu,      d/dt Phi(q_{n+1}, v_{n+1}, t_{n+1}) = 0,   p = dL/dv
/// Elements see relative motions only, so linear and angular momentum of what floats freely are kept to round-off, whatever the step and
/// the tolerance. Where h is constant and resolves the fastest vibration, energy keeps within a bound that falls with h^2. Nothing is damped: not for stiff
/// scenes with vibrations that the step does not resolve, which ring or grow. Second order in positions, velocities, multipliers.
/// Sources: Marsden, West 2001; Leyendecker, Marsden, Ortiz 2008 (constraints); Andersen 1983 (RATTLE).
#include <vector>

#include "bough/step/advance.hpp"

namespace bough::step {

/// Momenta and forces of all elements, summed by node in a fixed order.
class MomentumSums {
 public:
  explicit MomentumSums(const plan::Plan& plan);
  /// Laws and slopes as in `field`; `nodes` of it are read.
  enum class Want { momenta, forces };
  [[nodiscard]] std::optional<Trouble> evaluate(const System& system, const elements::Field& field,
                                                const std::vector<double>& turns, double elastic_inertia, Want want);
  const motion::Vec6<double>& momentum(std::size_t node) const { return momentum_[node]; }  ///< P, own axes
  const motion::Vec6<double>& force(std::size_t node) const { return force_[node]; }        ///< F, resists, own axes
  const motion::Vec6<double>& force_size(std::size_t node) const { return force_size_[node]; }  ///< sum of |terms|

 private:
  std::vector<std::int64_t> begin_;             ///< by element: place in the arrays below
  std::vector<double> momenta_, forces_;        ///< by element, 6 per node
  std::vector<std::int64_t> use_begin_, uses_;  ///< by node: places that add up to it
  std::vector<motion::Vec6<double>> momentum_, force_, force_size_;
};

/// Values and gradients of all constraint rows at one instant.
class ConstraintRows {
 public:
  explicit ConstraintRows(const plan::Plan& plan);
  void evaluate(const System& system, const elements::Field& field, const std::vector<double>& turns);
  double value(std::size_t multiplier) const { return values_[multiplier]; }
  /// to[node] += factor G^T multipliers.
  void add_forces(const double* multipliers, double factor, std::vector<motion::Vec6<double>>& to) const;

  struct Place {
    const elements::Joint* joint = nullptr;
    int element = 0, block = 0, multiplier_begin = 0, num_nodes = 0;
    int nodes[2] = {-1, -1};
    std::size_t gradient_begin = 0;
  };
  const std::vector<Place>& places() const { return places_; }
  /// Of an element that has rows; null for others.
  const Place* place_of(int element) const {
    const int place = place_of_element_[static_cast<std::size_t>(element)];
    return place < 0 ? nullptr : &places_[static_cast<std::size_t>(place)];
  }
  /// Row `k` of a joint: 6 per node.
  const double* gradient(const Place& p, int k) const {
    return gradients_.data() + p.gradient_begin + static_cast<std::size_t>(6 * k * p.num_nodes);
  }

 private:
  std::vector<Place> places_;
  std::vector<int> place_of_element_;
  std::vector<double> values_, gradients_;
};

/// The integrator with its buffers, and a second linear solver, of [M G^T; G 0], for velocities and accelerations; both factors serve over
/// many steps. Allocates when made, not afterwards.
class Variational {
 public:
  /// `newmark_beta`: see StepOptions; (beta - 1/4) h^2 is the elastic inertia of elements/momentum.hpp.
  Variational(System& system, const scene::Solver& solver, double newmark_beta);

  /// Momenta of a consistent state (make_consistent). A step of any size may follow.
  [[nodiscard]] std::optional<Trouble> start(State& state);

  /// One step of size `state.step_size` to `end_time`. Velocities afterwards are those of the momenta and satisfy the constraints; accelerations
  /// and multipliers are those of the equations of motion there (left limit). Not converged: `state` is as it was, its momenta those of this
  /// step size.
  StepReport advance(State& state, const StepOptions& options, double end_time);

  /// Largest |v_{n+1} - v_n - h (a_n + a_{n+1})/2| over |h a| of the last step, lengths by the scene's size: small where the step resolves the
  /// motion, near 1 where it contains vibrations faster than the step, which this rule does not damp.
  double unresolved() const { return unresolved_; }

 private:
  using Vectors = std::vector<motion::Vec6<double>>;
  void predict(double h);
  std::optional<Trouble> place_nodes(State& next, double h);
  std::optional<Trouble> evaluate_step(const State& next, double h, ResidualSize& size);
  ResidualSize round_off_floor(double h) const;
  void evaluate_tangent(const elements::Slopes& slopes, double h);
  template <class E>
  void add_elastic_tangent(const E& e, const elements::Field& field, double h, double* matrix) const;
  StepReport try_step(State& state, const StepOptions& options, double end_time);
  StepReport iterate(State& next, const StepOptions& options, double h);
  double elastic_inertia(double h) const;
  std::optional<Trouble> set_momenta(State& state, double h);
  std::optional<Trouble> solve_velocities(State& state, double h);
  std::optional<Trouble> solve_accelerations(State& state, double h);
  std::optional<Trouble> recover_multipliers(State& state, double h);
  std::optional<Trouble> factor_mass(const State& state, double h);
  std::optional<Trouble> solve_mass(State& moving, std::vector<double>& multipliers, double h, double target);
  double add_solution(State& moving, std::vector<double>& multipliers, double scale);
  void add_counts();
  void compare_rates(const State& state, double h);
  double largest(const Vectors& vectors) const;

  motion::Vec6<double> node_part(std::size_t node) const {
    return system_.node_part(x_.data(), static_cast<int>(node));
  }
  bool is_held(std::size_t node) const { return system_.node_begin(static_cast<int>(node)) < 0; }
  void set_rows_of(int element, double* matrix) const;
  std::size_t row_unknown(const ConstraintRows::Place& p, int k) const {
    return static_cast<std::size_t>(system_.block_begin(p.block) + k);
  }
  template <class From>
  void set_rows(From&& from) {  ///< of rhs_, from a function of the multiplier
    for (const ConstraintRows::Place& p : after_.places())
      for (int k = 0; k < p.joint->num_rows; ++k)
        rhs_[row_unknown(p, k)] = from(static_cast<std::size_t>(p.multiplier_begin + k));
  }

  System& system_;
  double newmark_beta_;
  System mass_;  ///< for its matrices and its solver
  MomentumSums sums_;
  ConstraintRows before_, after_;  ///< at the ends of the step
  State base_, mid_;               ///< start and middle of the step; multipliers of the step in the middle
  Vectors D_, residual_, increments_, goal_, left_;
  std::vector<double> end_laws_, impulses_, row_goals_, rhs_, x_;
  std::vector<lanes::Taylor<double, 3>> series_;
  double unresolved_ = 0.0;
  double mass_step_ = 0.0;  ///< h of the factored mass matrix; 0: none
};

}  // namespace bough::step
