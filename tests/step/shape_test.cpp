/// Limits of the shapes of elements, which are checked only after steps that can have reached one.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "small_scenes.hpp"
#include "support/rig.hpp"

namespace bough::step {
namespace {

/// A soft free beam whose ends spin against each other.
scene::Scene make_folding_beam() {
  scene::Scene s = test::make_chain(1);
  s.gravity = motion::Vec3<double>::zero();
  s.joints.clear();
  s.beams[0].elements = 1;
  for (int i = 0; i < 6; ++i) {
    s.sections[0].stiffness(i, i) = i < 3 ? 10.0 : 1e-3;
    s.sections[0].mass(i, i) = 1e-3;
  }
  for (const auto& [node, speed] : {std::pair{"a0", 20.0}, std::pair{"b0", -20.0}}) {
    scene::InitialVelocity v;
    v.of = node;
    v.angular_velocity = {{0.0, speed, 0.0}};
    s.initial_velocities.push_back(v);
  }
  return s;
}

TEST(Shape, of_an_element_past_its_limit_is_found_in_the_step_that_takes_it_there) {
  scene::Scene s = make_folding_beam();
  for (const bool in_plane : {true, false}) {
    if (!in_plane) s.without = {"planar"};
    test::Rig usual(s), strict(s);  // strict: checked after every step
    ASSERT_EQ(usual.plan.is_on<motion::Se2>(), in_plane);
    usual.run(0, 1e-3);
    strict.run(0, 1e-3);
    const StepOptions options = make_step_options(s.analysis);
    int steps = 0, unchecked = 0;
    for (;; ++steps) {
      ASSERT_LT(steps, 200);
      const StepReport last = advance(usual.system, usual.state, options, (steps + 1) * 1e-3);
      strict.state.shape_margin = 0.0;
      const StepReport checked = advance(strict.system, strict.state, options, (steps + 1) * 1e-3);
      ASSERT_EQ(last.converged, checked.converged) << steps << ": " << last.cause << checked.cause;
      EXPECT_EQ(last.cause, checked.cause);
      test::expect_same_nodes(usual.state, strict.state);
      if (!last.converged) {
        EXPECT_NE(last.cause.find("bends by nearly half a turn"), std::string::npos) << last.cause;
        break;  // both states are as they were
      }
      EXPECT_LE(usual.state.shape_margin, strict.state.shape_margin);
      unchecked += usual.state.shape_margin < strict.state.shape_margin ? 1 : 0;
    }
    EXPECT_GT(steps, 20);
    EXPECT_GT(2 * unchecked, steps);
  }
}

TEST(Shape, is_checked_anew_once_a_node_was_moved) {
  test::Rig rig(test::make_chain(2));
  rig.run(3, 1e-3);
  EXPECT_GT(rig.state.shape_margin, 0.0);
  move_node(rig.plan, rig.state, 1, motion::Vec6<double>{{0.0, 0.0, 0.0, 0.0, 1e-3, 0.0}});
  EXPECT_EQ(rig.state.shape_margin, 0.0);
}

/// Frames of prescribed motion turn by more than nodes do.
TEST(Shape, is_checked_after_every_step_where_frames_move) {
  scene::Scene s = test::make_chain(2);
  s.frames.push_back(test::make_turntable({{0.0, 1.0, 0.0}}));
  s.joints[0].first.to = "table";
  test::Rig rig(s);
  rig.run(3, 1e-3);
  EXPECT_EQ(rig.state.shape_margin, 0.0);
}

}  // namespace
}  // namespace bough::step
