/// Penalty factors and depths of the tree: results must equal one LU of the whole matrix, whatever the penalty.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "bench.hpp"
#include "bough/scene/parts.hpp"
#include "tangent_matrix.hpp"

namespace bough::stress {

namespace {

scene::Scene links(int count) {
  scene::Scene s;
  s.name = "links";
  s.gravity = {{0.0, -9.81, 0.0}};
  s.sections = {scene::make_section("bar", 8.4e7, 2.7e7, 2.7e7, 1.8e3, 2.8e3, 2.8e3)};
  scene::set_mass(s.sections[0], 3.14, 2.1e-4, 1.05e-4, 1.05e-4);
  for (int k = 0; k < count; ++k) {
    const std::string n = std::to_string(k), before = k == 0 ? "" : "b" + std::to_string(k - 1);
    const auto x = static_cast<double>(k);
    s.nodes.push_back(scene::make_node("a" + n, {{x, 0, 0}}));
    s.nodes.push_back(scene::make_node("b" + n, {{x + 1.0, 0, 0}}));
    s.beams.push_back(scene::make_beam("link " + n, "bar", "a" + n, "b" + n, 8, 1));
    s.joints.push_back(
        scene::make_joint("hinge " + n, scene::JointKind::revolute, before, Vec3::zero(), "a" + n, Vec3::zero()));
  }
  s.sensors = {scene::make_point_sensor("tip", scene::SensorKind::position, "b" + std::to_string(count - 1))};
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 1e-2;
  return s;
}

/// The reference is the solution in extended precision, refined. Errors are measured in variables scaled independently
/// of the solver.
void all_depths(Bench& bench) {
  using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  scene::Scene s = links(3);
  s.solver.depth = 0;
  bench.require_memory(s);
  const TangentMatrix whole = tangent_matrix(s);
  Eigen::VectorXd row, column;
  equilibrate(whole.matrix, row, column);
  const Eigen::MatrixXd A = row.asDiagonal() * whole.matrix * column.asDiagonal();
  const Long A_long = A.cast<long double>();
  const Eigen::PartialPivLU<Long> lu_long(A_long);
  const double condition = condition_of(A);
  bench.condition(condition);
  double worst = 0.0, largest = 0.0, lu_worst = 0.0;
  for (int depth = 0; depth <= 5; ++depth) {
    s.solver.depth = depth;
    const TangentMatrix t = tangent_matrix(s);
    bench.backward_error(t.backward_error, static_cast<double>(t.matrix.rows()));
    // The depth does not change the matrix; only its sums may be rounded differently.
    const Eigen::VectorXd b = row.asDiagonal() * t.rhs;
    const LongVector b_long = b.cast<long double>();
    LongVector x = lu_long.solve(b_long);
    x += lu_long.solve(b_long - A_long * x);
    const double size = static_cast<double>(x.cwiseAbs().maxCoeff());
    const Eigen::VectorXd exact = x.cast<double>();
    const double of_lu = (A.partialPivLu().solve(b) - exact).cwiseAbs().maxCoeff() / size;
    const Eigen::VectorXd mine = t.solution.cwiseQuotient(column);
    const double error = (mine - exact).cwiseAbs().maxCoeff() / size;
    worst = std::max(worst, error / (10.0 * std::max(of_lu, 0x1p-53 * condition)));
    largest = std::max(largest, error);
    lu_worst = std::max(lu_worst, of_lu);
  }
  bench.figure("largest error over 10 max(error of one LU, u cond)", worst, 1.0);
  bench.round_off_error("largest error", largest, 1e-9);
  bench.tell("largest error of one LU of the whole", lu_worst);
}

/// Runs with the penalties of the augmented form against the local form, which has none. Newton's iteration corrects
/// what a linear solution has lost.
void runs_are_the_same(Bench& bench) {
  scene::Scene s = links(2);
  s.solver.leaf_size = 2;
  const run::MemoryRun base = bench.run(s);
  s.solver.form = scene::SolverForm::augmented;
  for (const double factor : {1e-3, 1.0}) {
    s.solver.penalty_factor = factor;
    const run::MemoryRun other = bench.run(s);
    double difference = 0.0;
    for (std::size_t r = 0; r < base.rows.size(); ++r)
      for (std::size_t c = 0; c < base.header.columns.size(); ++c)
        difference = std::max(difference, std::abs(base.rows[r].values[c] - other.rows.at(r).values[c]));
    char text[80];
    std::snprintf(text, sizeof text, "places with a penalty factor of %.0e", factor);
    bench.round_off_error(text, difference, 1e-9);
  }
}

}  // namespace

void add_penalty(std::vector<Definition>& table) {
  table.push_back(
      {"penalty_and_depth", "penalty",
       "depths 0 to 5: the error of a linear solution is at most 10 times that of one LU of the whole or of "
       "round-off times condition",
       all_depths});
  table.push_back({"penalty_in_runs", "penalty",
                   "runs of the augmented form with factors 1e-3 and 1 agree with those of the local form",
                   runs_are_the_same});
}

}  // namespace bough::stress
