/// The matrices of the linearised equations against differences of residuals, and their factored combinations.
#include "bough/step/linearisation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "small_scenes.hpp"
#include "support/rig.hpp"

namespace bough::step {
namespace {

using Part = Linearisation::Part;
using Vector = std::vector<double>;

/// A number in [-1, 1] for every index.
double any(std::size_t i) {
  return std::sin(12.9898 * static_cast<double>(i + 1)) * std::cos(0.37 * static_cast<double>(i));
}

/// A chain that is bent, moves, accelerates and pulls at its hinges, with a follower load at its end.
scene::Scene moving_chain() {
  scene::Scene s = test::make_chain(2);
  s.without = {"planar", "line", "translation", "held", "welded"};
  scene::PointLoad load;
  load.name = "thrust";
  load.at.to = "b1";
  load.force = {{30.0, -50.0, 20.0}};
  load.axes = scene::LoadAxes::body;
  s.point_loads.push_back(load);
  s.sections[0].damping = 1e-4 * s.sections[0].stiffness;
  return s;
}

void disturb(test::Rig& rig) {
  for (std::size_t n = 0; n < rig.plan.nodes.size(); ++n) {
    motion::Vec6<double> eta, v, a;
    for (int i = 0; i < 6; ++i) {
      eta[i] = 0.02 * any(6 * n + static_cast<std::size_t>(i));
      v[i] = 2.0 * any(100 + 6 * n + static_cast<std::size_t>(i));
      a[i] = 5.0 * any(200 + 6 * n + static_cast<std::size_t>(i));
    }
    move_node(rig.plan, rig.state, n, eta);
    set_velocity(rig.plan, rig.state, n, v);
    set_acceleration(rig.plan, rig.state, n, a);
  }
  for (std::size_t k = 0; k < rig.state.multipliers.size(); ++k) rig.state.multipliers[k] = 100.0 * any(300 + k);
  ASSERT_FALSE(rig.system.set_time(0.0));
}

/// Residuals beside the state, by a change of one unknown.
Vector residual_at(test::Rig& rig, Part part, std::size_t unknown, double by) {
  State state = rig.state;
  Vector x(rig.system.places().size(), 0.0);
  x[unknown] = by;
  for (std::size_t n = 0; n < rig.plan.nodes.size(); ++n) {
    const motion::Vec6<double> eta = rig.system.places().node_part(x.data(), static_cast<int>(n));
    const elements::NodeMotion& node = rig.nodes()[n];
    if (part == Part::stiffness) move_node(rig.plan, state, n, eta);
    if (part == Part::damping) set_velocity(rig.plan, state, n, node.v + eta);
    if (part == Part::mass) set_acceleration(rig.plan, state, n, node.a + eta);
  }
  if (part == Part::stiffness)
    for (const auto& m : rig.system.places().multipliers()) state.multipliers[m.multiplier] += x[m.unknown];
  EXPECT_FALSE(rig.system.evaluate(state, {}, false));
  Vector r = rig.system.right_hand_side();
  for (double& value : r) value = -value;
  return r;
}

TEST(Linearisation, matrices_are_derivatives_of_residuals_where_parts_move_and_pull) {
  test::Rig rig(moving_chain());
  disturb(rig);
  Linearisation linear(rig.system);
  ASSERT_FALSE(linear.take(rig.state));
  const std::size_t n = linear.size();
  Vector unit(n, 0.0), column(n);
  for (const Part part : {Part::stiffness, Part::damping, Part::mass}) {
    double most = 0.0, worst = 0.0;
    // Residuals are quadratic in velocities and linear in accelerations.
    const double h = part == Part::stiffness ? 1e-6 : part == Part::damping ? 1e-2 : 1e4;
    for (std::size_t j = 0; j < n; ++j) {
      unit[j] = 1.0;
      linear.multiply(part, unit, column);
      unit[j] = 0.0;
      const Vector after = residual_at(rig, part, j, h), before = residual_at(rig, part, j, -h);
      for (std::size_t i = 0; i < n; ++i) {
        most = std::max(most, std::abs(column[i]));
        worst = std::max(worst, std::abs(column[i] - (after[i] - before[i]) / (2.0 * h)));
      }
    }
    EXPECT_GT(most, 0.0);
    EXPECT_LT(worst, 3e-9 * most) << static_cast<int>(part);  // of central differences of 1e-6, and eps / 1e-6
  }
}

TEST(Linearisation, a_factored_combination_solves_and_counts) {
  test::Rig rig(moving_chain());
  disturb(rig);
  Linearisation linear(rig.system);
  ASSERT_FALSE(linear.take(rig.state));
  const std::size_t n = linear.size();
  Vector x(n), K(n), C(n), M(n), y(n), back(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = any(500 + i);
  linear.multiply(Part::stiffness, x, K);
  linear.multiply(Part::damping, x, C);
  linear.multiply(Part::mass, x, M);
  for (std::size_t i = 0; i < n; ++i) y[i] = K[i] + 30.0 * C[i] + 900.0 * M[i];
  ASSERT_TRUE(linear.factor({.damping = 30.0, .mass = 900.0}, solve::Symmetry::general).ok());
  ASSERT_TRUE(linear.solve(y, back));
  for (std::size_t i = 0; i < n; ++i)
    if (linear.weights()[i] > 0.0) {
      EXPECT_NEAR(back[i], x[i], 1e-7);
    }
  // With much mass nothing is negative on the motions that the hinges allow, with less than none everything is.
  ASSERT_TRUE(linear.factor({.mass = 1e14}, solve::Symmetry::symmetric).ok());
  EXPECT_EQ(linear.num_negative(), 0);
  ASSERT_TRUE(linear.factor({.mass = -1e14}, solve::Symmetry::symmetric).ok());
  EXPECT_EQ(linear.num_negative(), static_cast<int>(n) - 2 * linear.num_rows());
  EXPECT_EQ(linear.factorizations(), 3);
}

TEST(Linearisation, symmetry_is_seen_and_dampers_are_left_out) {
  test::Rig rig(moving_chain());
  disturb(rig);
  Linearisation linear(rig.system);
  ASSERT_FALSE(linear.take(rig.state));
  EXPECT_GT(linear.asymmetry(Part::stiffness), 1e-6);
  EXPECT_LT(linear.asymmetry(Part::mass), 1e-12);
  linear.take_symmetric_part(Part::stiffness);
  EXPECT_EQ(linear.asymmetry(Part::stiffness), 0.0);
  const double damped = linear.largest(Part::damping);
  linear.leave_out_dampers();
  EXPECT_LT(linear.largest(Part::damping), 1e-2 * damped);
}

}  // namespace
}  // namespace bough::step
