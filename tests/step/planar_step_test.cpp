/// Steps that iterate in the plane, in planes that do not lie along the axes and far from the origin.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bough/motion/so3.hpp"
#include "bough/schedule/threads.hpp"
#include "small_scenes.hpp"
#include "support/rig.hpp"

namespace bough::step {
namespace {

using motion::Mat3;
using motion::Vec3;

/// A chain whose plane is turned and shifted, all of it.
scene::Scene make_placed_chain(int links, const Mat3<double>& turn, const Vec3<double>& shift) {
  scene::Scene s = test::make_chain(links);
  s.gravity = turn * s.gravity;
  for (scene::Node& n : s.nodes) {
    n.placement.pose.x = shift + turn * n.placement.pose.x;
    n.placement.pose.R = turn;
  }
  scene::Joint& hinge = s.joints.front();
  hinge.first.offset.R = turn * hinge.first.offset.R;
  hinge.first.offset.x = shift;
  return s;
}

const Vec3<double> far_away{{400.0, -700.0, 300.0}};
const Mat3<double> inclined = motion::exp_so3(Vec3<double>{{0.3, -0.8, 0.5}});

double largest_difference(const std::vector<motion::Vec6<double>>& a, const std::vector<motion::Vec6<double>>& b) {
  double most = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n)
    for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(a[n][i] - b[n][i]));
  return most;
}

TEST(PlanarStep, agrees_with_steps_in_space_in_any_plane) {
  for (const bool is_inclined : {false, true}) {
    scene::Scene s = make_placed_chain(4, is_inclined ? inclined : Mat3<double>::identity(), Vec3<double>::zero());
    s.analysis.tolerance = 1e-12;
    test::Rig plane(s);
    ASSERT_TRUE(plane.plan.planar);
    s.without = {"planar"};
    test::Rig space(s);
    plane.run(30, 2e-3);
    space.run(30, 2e-3);
    const State &a = plane.state, &b = space.state;
    std::vector<motion::Vec6<double>> velocity[2], acceleration[2];
    for (std::size_t n = 0; n < a.nodes.size(); ++n) {
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(a.nodes[n].x.hi[i], b.nodes[n].x.hi[i], 1e-12);
      for (int i = 0; i < 9; ++i) EXPECT_NEAR(a.nodes[n].R.m[i], b.nodes[n].R.m[i], 1e-12);
      velocity[0].push_back(a.nodes[n].v);
      velocity[1].push_back(b.nodes[n].v);
      acceleration[0].push_back(a.nodes[n].a);
      acceleration[1].push_back(b.nodes[n].a);
    }
    // Where the plane is inclined, places in it are rounded, by up to EA/L eps |x| = 1.5e-7 N of forces: 1e-3 rad/s^2 of a node's own inertia.
    const double noise = is_inclined ? 1e-6 : 1e-9;
    const std::vector<motion::Vec6<double>> still(a.nodes.size(), motion::Vec6<double>::zero());
    EXPECT_LT(largest_difference(velocity[0], velocity[1]), noise * largest_difference(velocity[1], still));
    EXPECT_LT(largest_difference(acceleration[0], acceleration[1]), noise * largest_difference(acceleration[1], still));
    EXPECT_LT(largest_difference(a.algorithmic, b.algorithmic), noise * largest_difference(b.algorithmic, still));
  }
}

TEST(PlanarStep, leaves_nodes_in_space_with_the_digits_that_it_iterated_with) {
  // 860 m away a double holds 1e-13 m, which would strain an element of half a metre by 2e-13 and load it by 2e-5 N.
  for (const Mat3<double>& turn : {Mat3<double>::identity(), inclined}) {
    const scene::Scene s = make_placed_chain(3, turn, far_away);
    test::Rig rig(s);
    ASSERT_TRUE(rig.plan.planar);
    rig.run(5, 1e-3);
    const StepOptions options = make_step_options(s.analysis);
    ASSERT_TRUE(advance(rig.system, rig.state, options, 6e-3).converged);
    const ResidualSize iterated = rig.system.residual_size();
    ASSERT_FALSE(rig.system.evaluate(rig.state, {}, false));
    const ResidualSize left = rig.system.residual_size();
    EXPECT_LT(left.force, 1e-8 * left.force_scale) << iterated.force;
    EXPECT_LT(left.length, 1e-12);
  }
}

TEST(PlanarStep, refuses_a_step_in_which_a_link_turns_by_nearly_half_a_turn) {
  scene::Scene s = test::make_chain(1);
  scene::InitialVelocity v;
  v.of = "a0";
  v.angular_velocity = {{0.0, 40.0, 0.0}};
  s.initial_velocities.push_back(v);
  v.of = "b0";
  v.velocity = {{0.0, 0.0, -40.0}};
  s.initial_velocities.push_back(v);
  test::Rig rig(s);
  ASSERT_TRUE(rig.plan.planar);
  const StepOptions options = make_step_options(s.analysis);
  ASSERT_TRUE(make_consistent(rig.system, rig.state, true, 1e-3).ok);
  ASSERT_TRUE(start_alpha(rig.system, rig.state, options, 0.1).ok);
  const State before = rig.state;
  const StepReport report = advance(rig.system, rig.state, options, 0.1);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.cause.find("half a turn"), std::string::npos) << report.cause;
  for (std::size_t n = 0; n < before.nodes.size(); ++n)
    for (int i = 0; i < 3; ++i) EXPECT_EQ(before.nodes[n].x.hi[i], rig.state.nodes[n].x.hi[i]);
  // And goes on from there in smaller ones.
  ASSERT_TRUE(change_step_size(rig.system, rig.state, options, 1e-4).ok);
  EXPECT_TRUE(advance(rig.system, rig.state, options, 1e-4).converged);
}

TEST(PlanarStep, of_a_chain_is_solved_in_lanes_but_for_the_root) {
  // The leaf at the free end has fronts of its own; it takes the lane that the other fifteen leave.
  scene::Scene s = test::make_chain(128);
  for (scene::Beam& b : s.beams) b.elements = 4;
  test::Rig rig(s);
  ASSERT_TRUE(rig.plan.planar);
  const tree::Tree& tree = rig.system.tree();
  const tree::Subdomain& root = tree.subdomains[static_cast<std::size_t>(tree.root())];
  EXPECT_EQ(rig.system.solver().counters().fronts_in_lanes, tree.num_fronts() - (root.front_end - root.front_begin));
  rig.run(2, 1e-3);
  EXPECT_LT(rig.system.last_solution().backward_error, 1e-14);
}

}  // namespace
}  // namespace bough::step
