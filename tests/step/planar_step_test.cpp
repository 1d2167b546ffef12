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

/// A bar held at one end, its plane inclined.
scene::Scene make_held_bar() {
  scene::Scene s = make_placed_chain(1, inclined, Vec3<double>{{3.0, -5.0, 2.0}});
  s.joints[0].kind = scene::JointKind::fixed;
  s.beams[0].elements = 11;  // nodes that do not fill their lanes
  return s;
}
/// A link that spins about its hinge.
scene::Scene make_spinning_link() {
  scene::Scene s = test::make_chain(1);
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

void take_steps(test::Rig& rig, int first, int last, const Handover& handover) {
  const StepOptions options = make_step_options(rig.scene.analysis);
  for (int k = first; k <= last; ++k) {
    const StepReport report = advance(rig.system, rig.state, options, k * 1e-3, handover);
    ASSERT_TRUE(report.converged) << report.cause;
    accept_turns(rig.system, rig.state);
  }
}

void expect_same_state(const State& a, const State& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  EXPECT_EQ(a.behind, 0);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.predictor_order, b.predictor_order);
  for (std::size_t n = 0; n < a.nodes.size(); ++n) {
    for (int i = 0; i < 9; ++i) EXPECT_EQ(a.nodes[n].R.m[i], b.nodes[n].R.m[i]);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(a.nodes[n].x.hi[i], b.nodes[n].x.hi[i]);
      EXPECT_EQ(a.nodes[n].x.lo[i], b.nodes[n].x.lo[i]);
    }
    for (int i = 0; i < 6; ++i) {
      EXPECT_EQ(a.nodes[n].v[i], b.nodes[n].v[i]);
      EXPECT_EQ(a.nodes[n].a[i], b.nodes[n].a[i]);
      EXPECT_EQ(a.nodes[n].dq[i], b.nodes[n].dq[i]);
      EXPECT_EQ(a.algorithmic[n][i], b.algorithmic[n][i]);
      EXPECT_EQ(a.acceleration_trend[n][i], b.acceleration_trend[n][i]);
    }
  }
  for (std::size_t j = 0; j < a.turns.size(); ++j) EXPECT_NEAR(a.turns[j], b.turns[j], 1e-14);
  EXPECT_EQ(a.multipliers, b.multipliers);
}

constexpr Handover unread{true, false}, read{true, true};

TEST(PlanarStep, leaves_nodes_behind_until_they_are_asked_for) {
  for (const scene::Scene& s : {make_held_bar(), make_spinning_link()}) {
    test::Rig each(s), late(s), plain(s);
    for (test::Rig* rig : {&each, &late, &plain}) {
      ASSERT_TRUE(rig->plan.planar);
      rig->run(3, 1e-3);
    }
    int step = 3;
    for (const int more : {1, 7, 250}) {  // the link turns by ten radians in the last
      const double before = late.state.nodes.back().v[0];
      take_steps(each, step + 1, step + more, read);
      take_steps(late, step + 1, step + more, unread);
      take_steps(plain, step + 1, step + more, {});
      step += more;
      EXPECT_NE(late.state.behind, 0);
      EXPECT_EQ(late.state.nodes.back().v[0], before);
      EXPECT_THROW((void)late.system.field(late.state), std::logic_error);
      ASSERT_FALSE(late.system.catch_up(late.state));
      expect_same_state(late.state, each.state);
      for (std::size_t n = 0; n < late.state.nodes.size(); ++n)
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(late.state.nodes[n].x.hi[i], plain.state.nodes[n].x.hi[i], 1e-10);
      ASSERT_FALSE(late.system.catch_up(late.state)) << "a whole state stays as it is";
    }
    if (!s.initial_velocities.empty()) {
      EXPECT_GT(std::abs(late.state.turns[0]), 8.0);
    }
  }
}

TEST(PlanarStep, that_fails_loses_nothing_that_was_left_behind) {
  const scene::Scene s = make_held_bar();
  test::Rig each(s), late(s);
  for (test::Rig* rig : {&each, &late}) rig->run(3, 1e-3);
  take_steps(each, 4, 9, read);
  take_steps(late, 4, 9, unread);
  StepOptions hasty = make_step_options(s.analysis);
  hasty.max_iterations = 1;
  hasty.tolerance = 1e-15;
  for (test::Rig* rig : {&each, &late}) ASSERT_FALSE(advance(rig->system, rig->state, hasty, 10e-3, unread).converged);
  const State behind = late.state;
  ASSERT_NE(behind.behind, 0);
  ASSERT_FALSE(late.system.catch_up(late.state));
  expect_same_state(late.state, each.state);
  late.state = behind;  // goes on as if nobody had asked
  for (test::Rig* rig : {&each, &late}) take_steps(*rig, 10, 12, read);
  expect_same_state(late.state, each.state);
}

TEST(PlanarStep, tells_when_nodes_left_behind_are_lost) {
  test::Rig rig(make_held_bar());
  rig.run(3, 1e-3);
  take_steps(rig, 4, 4, unread);
  State old = rig.state;
  take_steps(rig, 5, 5, unread);
  const auto lost = rig.system.catch_up(old);
  ASSERT_TRUE(lost);
  EXPECT_NE(lost->text.find("lost"), std::string::npos) << lost->text;
  const StepReport report = advance(rig.system, old, make_step_options(rig.scene.analysis), 5e-3);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.cause, lost->text);
  EXPECT_NE(old.behind, 0);
  State whole = rig.state;
  ASSERT_FALSE(rig.system.catch_up(whole)) << "and those of the last step are not";
  // Unless another state was tried, even if that failed.
  StepOptions hasty = make_step_options(rig.scene.analysis);
  hasty.max_iterations = 1;
  hasty.tolerance = 1e-15;
  ASSERT_FALSE(advance(rig.system, whole, hasty, 6e-3).converged);
  EXPECT_TRUE(rig.system.catch_up(rig.state));
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
