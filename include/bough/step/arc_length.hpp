#pragma once
/// Statics along the path of equilibria (shape, load factor), past limit points of the load.
///
/// A step looks for the equilibrium at a given distance from the last one. With D = log(H_start^-1 H) of each of n
/// nodes, L the size of the structure,
///   R(q, f) = 0,   |D|^2 = s^2,   |D|^2 = (1/n) sum (|D_linear|^2 / L^2 + |D_angular|^2)
/// by Newton in q and the load factor f. The matrix K of the shape alone is factored as always and solved for two
/// right-hand sides,
///   K x_R = -R,  K x_f = -dR/df,   eta = x_R + df x_f,   df = ((s^2 - |D|^2)/2 - <D, T(D)^-1 x_R>) / <D, T(D)^-1 x_f>,
/// so that the solver need not know of the bordered system, which stays regular where K is not: at limit points.
/// Where K has no factor a spring k e e^T on one unknown gives it one, and is taken out of the solution again by one
/// equation more. Sources: Riks 1979; Crisfield 1981; Ramm 1981.
#include "bough/step/advance.hpp"

namespace bough::step {

class ArcLengthPath {
 public:
  using Vectors = std::vector<motion::Vec6<double>>;
  ArcLengthPath(System& system, const StepOptions& options);

  /// The tangent of the path at an equilibrium (the first: with the load factor growing). Keeps the direction of the
  /// step before.
  [[nodiscard]] std::optional<Trouble> set_tangent(const State& state);
  /// df/ds at the equilibrium of the last set_tangent, in the sense of the path [-].
  double slope() const { return slope_; }

  /// From the equilibrium of the last set_tangent to the next one at a distance of `length`. Not converged: `state`
  /// is as it was, and the tangent may serve again. The tangent there is not set.
  StepReport advance(State& state, double length);

  /// How long the first step may be, by how the path bends at an equilibrium at which set_tangent was called last:
  /// over it the direction of the path and its slope df/ds keep nearly what they are. At most 0.05. The tangent is set
  /// anew.
  double choose_first_step(const State& state);

  /// |D| between two states.
  double distance(const State& from, const State& to) const;

  /// The direction of the last step is the path's; call when it is kept.
  void accept() { direction_.swap(moved_); }
  /// By node, that of the last tangent or accepted step, which tells the sense of the next tangent: to come back to it.
  const Vectors& direction() const { return direction_; }
  void set_direction(const Vectors& direction) { direction_ = direction; }

  void checkpoint(records::Archive& archive) {
    archive(start_, load_, tangent_, correction_, x_, spring_, by_spring_, moved_, direction_, slope_, has_direction_);
  }

 private:
  /// Added to one unknown where K is singular.
  struct Spring {
    std::size_t unknown = 0;
    int element = 0;         ///< that takes it
    std::int64_t entry = 0;  ///< of its matrix, which held entry_without
    double stiffness = 0.0, entry_without = 0.0;
  };
  std::optional<Spring> find_spring(const solve::FactorStatus& status) const;
  [[nodiscard]] std::optional<Trouble> factor(bool rescale);
  void take_spring_out();
  std::optional<double> keep_length(double length);
  StepReport follow(State& state, double length);
  [[nodiscard]] std::optional<Trouble> solve_load(const State& state, double load_factor);
  /// moved_ = log(H_start^-1 H).
  void set_moved(const State& state);
  /// log(H_from^-1 H_to) of a node, in space.
  motion::Vec6<double> way_between(const State& from, const State& to, std::size_t node) const;
  double square(const Vectors& v) const;
  motion::Vec6<double> node_part(const std::vector<double>& x, std::size_t node) const;
  double inner(const motion::Vec6<double>& a, const motion::Vec6<double>& b) const;

  System& system_;
  const StepOptions& options_;
  State start_;
  std::vector<double> load_, tangent_, correction_, x_;
  std::optional<Spring> spring_;   ///< in the present factor
  std::vector<double> by_spring_;  ///< K'^-1 k e
  Vectors moved_, direction_;
  double scale_ = 1.0;  ///< 1 / L^2
  double slope_ = 0.0;
  bool has_direction_ = false;
};

}  // namespace bough::step
