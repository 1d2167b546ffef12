#pragma once
/// The variational integrator over a group. Internal to step.
#include <vector>

#include "bough/elements/momentum.hpp"
#include "variational.hpp"

namespace bough::step {

/// Momenta and forces of all elements, summed by node in a fixed order.
template <class G>
class MomentumSums {
  using Vector = typename G::template Vector<double>;

 public:
  explicit MomentumSums(const plan::Plan& plan);
  /// What `evaluate` computes. It reads nodes, laws and slopes from `field`.
  enum class Want { momenta, forces };
  [[nodiscard]] std::optional<Trouble> evaluate(const System& system, const elements::FieldOn<G, double>& field,
                                                const std::vector<double>& turns, double elastic_inertia, Want want);
  const Vector& momentum(std::size_t node) const { return momentum_[node]; }      ///< P, own axes
  const Vector& force(std::size_t node) const { return force_[node]; }            ///< F, resists, own axes
  const Vector& force_size(std::size_t node) const { return force_size_[node]; }  ///< sum of |terms|

 private:
  std::vector<std::int64_t> begin_;             ///< by element: place in the arrays below
  std::vector<double> momenta_, forces_;        ///< by element, G::dof per node
  std::vector<std::int64_t> use_begin_, uses_;  ///< by node: its summands in the arrays above
  std::vector<Vector> momentum_, force_, force_size_;
};

/// Values and gradients, at one instant, of the constraint rows whose multipliers are unknowns.
template <class G>
class ConstraintRows {
 public:
  explicit ConstraintRows(const plan::Plan& plan);
  void evaluate(const System& system, const elements::FieldOn<G, double>& field, const std::vector<double>& turns);
  /// to[node] += factor G^T multipliers.
  void add_forces(const double* multipliers, double factor, std::vector<typename G::template Vector<double>>& to) const;

  struct Place {
    const elements::JointOn<G>* joint = nullptr;
    const plan::JointPlan* plan = nullptr;
    int element = 0, num_nodes = 0;
    int nodes[2] = {-1, -1};
    std::size_t gradient_begin = 0, value_begin = 0;
    /// Index of row k of the joint among all multipliers.
    std::size_t multiplier(int k) const {
      return static_cast<std::size_t>(plan->multiplier_begin + plan->rows[static_cast<std::size_t>(k)]);
    }
  };
  const std::vector<Place>& places() const { return places_; }
  /// Rows of an element; null if it has none.
  const Place* place_of(int element) const {
    const int place = place_of_element_[static_cast<std::size_t>(element)];
    return place < 0 ? nullptr : &places_[static_cast<std::size_t>(place)];
  }
  double value(const Place& p, int k) const { return values_[p.value_begin + static_cast<std::size_t>(k)]; }
  /// Row `k` of a joint: G::dof per node.
  const double* gradient(const Place& p, int k) const {
    return gradients_.data() + p.gradient_begin + static_cast<std::size_t>(G::dof * k * p.num_nodes);
  }

 private:
  std::vector<Place> places_;
  std::vector<int> place_of_element_;
  std::vector<double> values_, gradients_;
};

/// The integrator on the group G.
template <class G>
class VariationalOn final : public Integrator {
 public:
  VariationalOn(System& system, const scene::Solver& solver, double newmark_beta);
  /// The state holds everything that persists between steps, so the copy only has to factor its mass matrix anew.
  std::unique_ptr<Integrator> clone() const override {
    return std::make_unique<VariationalOn>(system_, solver_, newmark_beta_);
  }
  StartReport start(State& state, const StepOptions& options, double step_size) override;
  StartReport change_step_size(State& state, const StepOptions& options, double step_size) override;
  StepReport advance(State& state, const StepOptions& options, double end_time) override;
  double unresolved() const override { return unresolved_; }
  void checkpoint(records::Archive& archive) override;
  bool write_matrices(long matrices) override;

 private:
  using On = motion::VectorsOn<G>;
  using Vector = typename G::template Vector<double>;
  using Vectors = std::vector<Vector>;
  using Field = elements::FieldOn<G, double>;
  using Rows = ConstraintRows<G>;
  using Place = typename Rows::Place;
  using Sums = MomentumSums<G>;
  using Nodes = std::vector<elements::NodeMotionOn<G, double>>;
  static const Nodes& nodes(const State& state) { return state.on<G>().motion; }
  static Nodes& change(State& state) { return state.change<G>().motion; }
  void predict(double h);
  std::optional<Trouble> place_nodes(State& next, double h);
  void predict_signals(double h);
  std::optional<Trouble> evaluate_signals(const elements::Slopes& slopes, double h, ResidualSize& size);
  std::optional<Trouble> end_signals(State& next, double h);
  void observe_signals(State& next, double h);
  std::optional<Trouble> evaluate_step(State& next, const elements::Slopes& slopes, double h, ResidualSize& size);
  ResidualSize round_off_floor(double h) const;
  /// What tangents were evaluated at.
  struct Tangents {
    long matrices = -1;  ///< LinearSolution::num_matrices
    State base, mid;
    Vectors D;
    std::vector<double> end_laws;
    elements::Slopes slopes;
    double h = 0.0, end_time = 0.0;
    void checkpoint(records::Archive& archive) { archive(matrices, base, mid, D, end_laws, slopes, h, end_time); }
  };
  void keep_tangents(const elements::Slopes& slopes, double h);
  void evaluate_tangent(const elements::Slopes& slopes, double h);
  template <class E>
  void add_elastic_tangent(const E& e, const Field& field, double h, double* matrix) const;
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

  Vector node_part(std::size_t node) const { return system_.places().part_on<G>(x_.data(), static_cast<int>(node)); }
  bool is_held(std::size_t node) const { return system_.places().node_begin(static_cast<int>(node)) < 0; }
  /// A wrench on a node without its moment if the node is a point, which has no rotation that it could change.
  Vector without_moment_on_point(std::size_t node, Vector wrench) const {
    for (int i = system_.plan().unknowns.count_of(node); i < G::dof; ++i) wrench[i] = 0.0;
    return wrench;
  }
  void set_rows_of(int element, double* matrix) const;
  std::size_t row_unknown(const Place& p, int k) const {
    return static_cast<std::size_t>(system_.places().block_begin(p.plan->block) + k);
  }
  template <class From>
  void set_rows(From&& from) {  ///< sets the constraint rows of rhs_ from a function of joint and row
    for (const Place& p : after_.places())
      for (int k = 0; k < p.joint->num_rows; ++k) rhs_[row_unknown(p, k)] = from(p, k);
  }

  System& system_;
  const scene::Solver& solver_;  ///< of the scene
  double newmark_beta_;
  System mass_;  ///< a second system, whose solver factors the mass matrix
  Sums sums_;
  std::unique_ptr<ResidualSums> signal_sums_;  ///< of equations of signals, where there are any
  Rows before_, after_;                        ///< at the ends of the step
  State base_, mid_;                           ///< start and middle of the step; multipliers of the step in the middle
  std::vector<motion::Vec6<double>> inertia_;  ///< of nodes in space, for recover_multipliers
  Vectors D_, residual_, increments_, goal_, left_;
  std::vector<double> end_laws_, impulses_, row_goals_, rhs_, x_;
  std::vector<lanes::Taylor<double, 3>> series_;
  double end_time_ = 0.0;  ///< of the step
  double unresolved_ = 0.0;
  double mass_step_ = 0.0;  ///< h of the factored mass matrix; 0: none
  State mass_state_;        ///< of which it is, where the system remembers
  std::vector<Tangents> remembered_;
};

}  // namespace bough::step
