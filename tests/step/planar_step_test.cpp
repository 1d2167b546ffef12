/// Steps that iterate in the plane, in planes that do not lie along the axes and far from the origin.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

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
    ASSERT_TRUE(plane.plan.is_on<motion::Se2>());
    s.without = {"planar"};
    test::Rig space(s);
    plane.run(30, 2e-3);
    space.run(30, 2e-3);
    const std::vector<elements::NodeMotion>&a = plane.nodes(), &b = space.nodes();
    std::vector<motion::Vec6<double>> velocity[2], acceleration[2], algorithmic, in_space;
    for (std::size_t n = 0; n < a.size(); ++n) {
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[n].x.hi[i], b[n].x.hi[i], 1e-12);
      for (int i = 0; i < 9; ++i) EXPECT_NEAR(a[n].R.m[i], b[n].R.m[i], 1e-12);
      velocity[0].push_back(a[n].v);
      velocity[1].push_back(b[n].v);
      acceleration[0].push_back(a[n].a);
      acceleration[1].push_back(b[n].a);
      const motion::Vec3<double> own = plane.state.on<motion::Se2>().algorithmic[n];
      algorithmic.push_back(plane.plan.unknowns.expanded(&own[0], n));
      in_space.push_back(space.state.on<motion::Se3>().algorithmic[n]);
    }
    // Where the plane is inclined, places in it are rounded, by up to EA/L eps |x| = 1.5e-7 N of forces: 1e-3 rad/s^2
    // of a node's own inertia.
    const double noise = is_inclined ? 1e-6 : 1e-9;
    const std::vector<motion::Vec6<double>> still(a.size(), motion::Vec6<double>::zero());
    EXPECT_LT(largest_difference(velocity[0], velocity[1]), noise * largest_difference(velocity[1], still));
    EXPECT_LT(largest_difference(acceleration[0], acceleration[1]), noise * largest_difference(acceleration[1], still));
    EXPECT_LT(largest_difference(algorithmic, in_space), noise * largest_difference(in_space, still));
  }
}

TEST(PlanarStep, is_seen_in_space_with_the_digits_that_it_iterated_with) {
  // 860 m away a double holds 1e-13 m, which would strain an element of half a metre by 2e-13 and load it by 2e-5 N.
  for (const Mat3<double>& turn : {Mat3<double>::identity(), inclined}) {
    const scene::Scene s = make_placed_chain(3, turn, far_away);
    test::Rig rig(s);
    ASSERT_TRUE(rig.plan.is_on<motion::Se2>());
    rig.run(5, 1e-3);
    const StepOptions options = make_step_options(s.analysis);
    ASSERT_TRUE(advance(rig.system, rig.state, options, 6e-3).converged);
    const ResidualSize iterated = rig.system.residual_size();
    scene::Scene spatial = s;
    spatial.without = {"planar"};
    test::Rig space(spatial);
    State shown = make_spatial(rig.plan, rig.state);
    ASSERT_EQ(shown.multipliers.size(), space.state.multipliers.size());
    ASSERT_FALSE(space.system.set_time(shown.time));
    ASSERT_FALSE(space.system.evaluate(shown, {}, false));
    const ResidualSize left = space.system.residual_size();
    double most =
        0.0;  // along the plane: off it the rounded places of the scene are loaded, which planar elements do not see
    for (std::size_t n = 0; n < rig.plan.nodes.size(); ++n) {
      const motion::Vec6<double> force =
          space.system.places().node_part(space.system.right_hand_side().data(), static_cast<int>(n));
      double x[3];
      rig.plan.unknowns.project(force, n, x);
      most = std::max({most, std::abs(x[0]), std::abs(x[1])});
    }
    EXPECT_LT(most, 1e-8 * left.force_scale) << iterated.force;
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
  ASSERT_TRUE(rig.plan.is_on<motion::Se2>());
  const StepOptions options = make_step_options(s.analysis);
  ASSERT_TRUE(make_consistent(rig.system, rig.state, true, 1e-3).ok);
  ASSERT_TRUE(start_alpha(rig.system, rig.state, options, 0.1).ok);
  const State before = rig.state;
  const StepReport report = advance(rig.system, rig.state, options, 0.1);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.cause.find("half a turn"), std::string::npos) << report.cause;
  test::expect_same_nodes(before, rig.state);
  // And goes on from there in smaller ones.
  ASSERT_TRUE(change_step_size(rig.system, rig.state, options, 1e-4).ok);
  EXPECT_TRUE(advance(rig.system, rig.state, options, 1e-4).converged);
}

/// A bar held at one end, its plane inclined.
scene::Scene make_held_bar() {
  scene::Scene s = make_placed_chain(1, inclined, Vec3<double>{{3.0, -5.0, 2.0}});
  s.joints[0].kind = scene::JointKind::fixed;
  s.beams[0].elements = 11;  // nodes that do not fill their lanes
  return s;
}
/// A link that spins about its hinge, whose angle is measured.
scene::Scene make_spinning_link() {
  scene::Scene s = test::make_chain(1);
  scene::Sensor angle;
  angle.name = "angle";
  angle.kind = scene::SensorKind::joint_angle;
  angle.joint = "hinge0";
  s.sensors.push_back(angle);
  s.beams[0].elements = 1;
  for (const auto& [node, speed] : {std::pair{"a0", 0.0}, std::pair{"b0", -40.0}}) {
    scene::InitialVelocity v;
    v.of = node;
    v.angular_velocity = {{0.0, 40.0, 0.0}};
    v.velocity = {{0.0, 0.0, speed}};
    s.initial_velocities.push_back(v);
  }
  return s;
}

TEST(PlanarStep, counts_turns_as_steps_in_space_do) {
  scene::Scene s = make_spinning_link();
  test::Rig plane(s);
  ASSERT_TRUE(plane.plan.is_on<motion::Se2>());
  s.without = {"planar"};
  test::Rig space(s);
  for (test::Rig* rig : {&plane, &space}) {
    rig->run(0, 1e-3);
    const StepOptions options = make_step_options(s.analysis);
    for (int k = 1; k <= 250; ++k) {  // ten radians
      ASSERT_TRUE(advance(rig->system, rig->state, options, k * 1e-3).converged);
      accept_turns(rig->system, rig->state);
    }
  }
  EXPECT_GT(std::abs(plane.state.turns[0]), 8.0);
  for (std::size_t j = 0; j < plane.state.turns.size(); ++j)
    EXPECT_NEAR(plane.state.turns[j], space.state.turns[j], 1e-6);
}

TEST(PlanarStep, shows_nodes_in_space_anew_once_they_are_changed) {
  test::Rig rig(make_held_bar());
  rig.run(3, 1e-3);
  const elements::NodeMotion before = rig.nodes().back();
  EXPECT_EQ(&rig.nodes(), &rig.nodes());
  ASSERT_TRUE(advance(rig.system, rig.state, make_step_options(rig.scene.analysis), 4e-3).converged);
  const elements::NodeMotion after = rig.nodes().back();
  EXPECT_NE(before.v[1], after.v[1]);
  const State copy = rig.state;
  const motion::Vec6<double> still = motion::Vec6<double>::zero();
  set_velocity(rig.plan, rig.state, 0, still);
  EXPECT_EQ(rig.nodes().back().v[1], after.v[1]);
  EXPECT_EQ(rig.nodes().front().v[1], 0.0);
  EXPECT_EQ(nodes_in_space(rig.plan, copy).back().v[1], after.v[1]);
}

// A change of a position that a double does not hold is seen in space.
TEST(PlanarStep, shows_both_parts_of_positions) {
  test::Rig rig(make_held_bar());
  ASSERT_TRUE(rig.plan.is_on<motion::Se2>());
  rig.run(5, 1e-3);
  const elements::NodeMotion before = rig.nodes().back();
  const double change = 1e-19;
  State changed = rig.state;
  changed.change_all([&]<class G>(NodesOn<G>& nodes) {
    if constexpr (std::is_same_v<G, motion::Se2>) nodes.motion.back().x.lo[0] += change;
  });
  const elements::NodeMotion& after = nodes_in_space(rig.plan, changed).back();
  const motion::Vec3<double> seen = (after.x.hi - before.x.hi) + (after.x.lo - before.x.lo);
  EXPECT_NEAR(std::sqrt(lanes::dot(seen, seen)), change, 1e-6 * change);
}

TEST(PlanarStep, shows_some_nodes_with_the_bits_of_all) {
  test::Rig rig(make_held_bar());
  rig.run(5, 1e-3);
  std::vector<elements::NodeMotion> some(rig.plan.nodes.size());
  const std::vector<int> which{10, 3};
  copy_nodes_in_space(rig.plan, rig.state, which, some);
  for (const int n : which)
    for (int i = 0; i < elements::numbers_of_node<motion::Se3>; ++i)
      EXPECT_EQ(reinterpret_cast<const double*>(some.data() + n)[i],
                reinterpret_cast<const double*>(rig.nodes().data() + n)[i]);
}

TEST(PlanarStep, gives_the_same_bits_whether_its_end_is_looked_at_or_not) {
  const scene::Scene s = make_held_bar();
  test::Rig seen(s), unseen(s);
  for (test::Rig* rig : {&seen, &unseen}) rig->run(3, 1e-3);
  for (int k = 4; k <= 9; ++k)
    for (test::Rig* rig : {&seen, &unseen}) {
      ASSERT_TRUE(advance(rig->system, rig->state, make_step_options(s.analysis), k * 1e-3).converged);
      if (rig == &seen) (void)rig->nodes();
    }
  test::expect_same_nodes(seen.state, unseen.state);
  EXPECT_EQ(seen.state.multipliers, unseen.state.multipliers);
}

TEST(PlanarStep, of_a_chain_is_solved_in_lanes_but_for_the_root) {
  // The leaf at the free end has fronts of its own; it takes the lane that the other fifteen leave.
  scene::Scene s = test::make_chain(128);
  for (scene::Beam& b : s.beams) b.elements = 4;
  test::Rig rig(s);
  ASSERT_TRUE(rig.plan.is_on<motion::Se2>());
  const tree::Tree& tree = rig.system.linear().tree();
  const tree::Subdomain& root = tree.subdomains[static_cast<std::size_t>(tree.root())];
  EXPECT_EQ(rig.system.linear().solver().counters().fronts_in_lanes,
            tree.num_fronts() - (root.front_end - root.front_begin));
  rig.run(2, 1e-3);
  EXPECT_LT(rig.system.linear().last_solution().backward_error, 1e-14);
}

}  // namespace
}  // namespace bough::step
