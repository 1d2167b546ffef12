/// Nodes without unknowns since joints hold them: the same equations and results as with all unknowns.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bough/schedule/threads.hpp"
#include "bough/step/residual_rate.hpp"
#include "same_motion.hpp"
#include "support/given.hpp"

namespace bough::step {
namespace {

using motion::Vec6;
using test::block;
using test::expand;
using test::expect_equal;
using test::largest;
using test::Rig;
using test::rounding_of_forces;
using test::stir;
using test::take_steps;

/// Three links, the first clamped; a block fixed to the ground beside its own origin, which carries an arm on a
/// hinge, a spring, a rope to the links and a load.
scene::Scene varied(int order) {
  scene::Scene s = test::make_chain(3, order);
  s.without = {"planar"};
  s.joints[0].kind = scene::JointKind::fixed;
  s.bodies = {block("block", 0.0, 1.0, 0.0), block("arm", 0.5, 1.0, 0.2)};
  scene::Joint wall;
  wall.name = "wall";
  wall.kind = scene::JointKind::fixed;
  wall.first.to = "block";  // the other way round
  wall.first.offset.x = {{0.1, 0.2, 0.3}};
  wall.first.offset.R = s.joints[1].first.offset.R;
  wall.second.offset.x = {{0.1, 1.2, 0.3}};
  wall.second.offset.R = wall.first.offset.R;
  s.joints.push_back(wall);
  s.joints.push_back(test::make_arm_hinge());
  support::GivenSpring rope;
  rope.name = "rope";
  rope.first.to = "block";
  rope.second.to = "b1";
  rope.stiffness = 30.0;
  rope.damping = 2.0;
  rope.rest_length = 1.5;
  s.couplings.push_back(rope);
  scene::PointLoad load;
  load.name = "push";
  load.at.to = "block";
  load.force = {{3.0, -4.0, 5.0}};
  load.moment = {{0.3, 0.2, 0.1}};
  s.point_loads.push_back(load);
  return s;
}

scene::Scene barred(scene::Scene s) {
  s.without.push_back("held");
  return s;
}

TEST(HeldNodes, are_struck_out_of_the_equations_and_nothing_else_is) {
  for (int order : {1, 2, 3})
    for (const elements::Slopes& slopes : {elements::Slopes{120.0, 2e4, false}, elements::Slopes{0.0, 0.0, true}}) {
      Rig held(varied(order)), whole(barred(varied(order)));
      ASSERT_EQ(held.plan.held.size(), 2u);
      ASSERT_EQ(held.system.places().size() + 24, whole.system.places().size());
      stir(held, whole);
      for (Rig* rig : {&held, &whole}) {
        ASSERT_FALSE(rig->system.set_time(0.0));
        ASSERT_FALSE(rig->system.evaluate(rig->state, slopes, true));
      }
      const auto left = [&](std::vector<double> v) {  // what is held zero
        const std::vector<double> mask = expand(held, whole, std::vector<double>(held.system.places().size(), 1.0));
        for (std::size_t i = 0; i < v.size(); ++i) v[i] *= mask[i];
        return v;
      };
      EXPECT_EQ(expand(held, whole, held.system.right_hand_side()), left(whole.system.right_hand_side()));
      std::vector<double> x(held.system.places().size(), 0.0), product(x.size()), other(whole.system.places().size());
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = 1.0;
        held.system.linear().solver().multiply(held.system.walker(), x.data(), product.data());
        whole.system.linear().solver().multiply(whole.system.walker(), expand(held, whole, x).data(), other.data());
        EXPECT_EQ(expand(held, whole, product), left(other)) << "column " << i;
        x[i] = 0.0;
      }
      const ResidualSize a = held.system.residual_size(), b = whole.system.residual_size();
      EXPECT_LE(a.force, b.force);
      EXPECT_GE(a.force_scale, 0.3 * b.force_scale);
      EXPECT_LE(a.force_scale, 3.0 * b.force_scale);
      std::vector<double> rate, whole_rate;
      evaluate_rate(held.system, held.state, rate);
      evaluate_rate(whole.system, whole.state, whole_rate);
      EXPECT_EQ(expand(held, whole, rate), left(whole_rate));
    }
}

/// What is left of the forces on the nodes that are held, in the system that has all unknowns, beyond
/// round-off, over the largest force at a node.
double unbalanced(const Rig& held, Rig& whole) {
  EXPECT_FALSE(whole.system.set_time(held.state.time));
  EXPECT_FALSE(whole.system.evaluate(held.state, {}, true));
  std::vector<double> forces = whole.system.right_hand_side();
  if (!held.state.unsettled.empty()) {  // f + K eta
    std::vector<double> eta(forces.size(), 0.0), more(forces.size());
    for (std::size_t n = 0; n < held.plan.nodes.size(); ++n)
      whole.system.places().set_node_part(eta.data(), static_cast<int>(n), held.state.unsettled[n]);
    whole.system.linear().solver().multiply(whole.system.walker(), eta.data(), more.data());
    for (std::size_t i = 0; i < forces.size(); ++i) forces[i] -= more[i];
  }
  double most = 0.0;
  for (const plan::HeldNode& h : held.plan.held) {
    const Vec6<double> f = whole.system.places().node_part(forces.data(), h.node);
    for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(f[i]));
  }
  return std::max(0.0, most - rounding_of_forces(whole)) / whole.system.residual_size().force_scale;
}

/// A run with what is held and one without.
void compare_steps(scene::Scene s, scene::Integrator integrator = scene::Integrator::generalized_alpha) {
  constexpr double h = 5e-4;
  s.analysis.tolerance = 1e-13;
  s.analysis.integrator = integrator;
  Rig held(s), whole(barred(s));
  ASSERT_FALSE(held.plan.held.empty());
  for (Rig* rig : {&held, &whole}) ASSERT_TRUE(make_consistent(rig->system, rig->state, true, h).ok);
  expect_equal(held, whole, 1e-11);  // accelerations and multipliers at the start
  EXPECT_LT(unbalanced(held, whole), 1e-13);
  for (Rig* rig : {&held, &whole}) take_steps(*rig, h);
  expect_equal(held, whole, 1e-10);
  if (integrator != scene::Integrator::variational) {  // whose multipliers belong to inertia of its own
    EXPECT_LT(unbalanced(held, whole), 1e-13);
  }
  test::expect_near_momenta(held.state, whole.state, 1e-10);
  EXPECT_LT(held.system.constraints().relative_violation(held.state, 0), 1e-12);
}

TEST(HeldNodes, move_nothing_else_in_time) {
  for (int order : {1, 2, 3}) compare_steps(varied(order));
  compare_steps(varied(1), scene::Integrator::bdf);
  compare_steps(varied(2), scene::Integrator::variational);
}

TEST(HeldNodes, of_a_plane_move_nothing_else_in_time) {
  scene::Scene s = test::make_chain(12);  // in lanes
  s.joints[0].kind = s.joints[6].kind = scene::JointKind::fixed;
  compare_steps(s);
}

/// Equal beams side by side, each clamped: sub-domains with a held node each, one to a lane.
TEST(HeldNodes, in_lockstep_move_nothing_else) {
  for (bool is_planar : {false, true}) {
    scene::Scene s = test::make_chain(32, 2);
    if (!is_planar) s.without = {"planar"};
    for (std::size_t l = 0; l < s.joints.size(); ++l) {
      s.joints[l].kind = scene::JointKind::fixed;
      s.joints[l].first.to = "";
      s.joints[l].first.offset.x = {{static_cast<double>(l), 0.0, 0.0}};
    }
    ASSERT_EQ(Rig(s).plan.held.size(), 32u);
    ASSERT_GT(Rig(s).system.linear().solver().counters().fronts_in_lanes, 0);
    compare_steps(s);
  }
}

TEST(HeldNodes, in_a_frame_that_turns_move_nothing_else) {
  scene::Scene s = varied(2);
  s.frames.push_back(test::make_turntable({{0.0, 0.6, 0.8}}));
  s.joints[0].first.to = "table";
  s.analysis.frame = "table";
  compare_steps(s);
}

/// Masses on springs along a line and beside it, one of them held by its displacements.
TEST(HeldNodes, without_rotations_move_nothing_else) {
  for (double beside : {0.0, 0.4}) {
    scene::Scene s;
    s.gravity = {{0.0, 0.0, -9.81}};
    for (int k = 0; k < 3; ++k) {
      scene::Body b;
      b.name = "m" + std::to_string(k);
      b.mass = 1.0 + k;
      b.is_point_mass = true;
      b.placement.pose.x = {{k == 2 ? beside : 0.0, 0.5 * beside * k, -static_cast<double>(k)}};
      s.bodies.push_back(b);
      if (k == 0) continue;
      support::GivenSpring spring;
      spring.name = "s" + std::to_string(k);
      spring.first.to = "m" + std::to_string(k - 1);
      spring.second.to = b.name;
      spring.stiffness = 200.0;
      spring.rest_length = 1.0;
      s.couplings.push_back(spring);
    }
    if (beside > 0.0) {
      scene::PrescribedMotion hold;
      hold.name = "hold";
      hold.at.to = "m0";
      for (auto& law : hold.displacement) law = laws::make_constant(0.0);
      s.motions.push_back(hold);
    } else {
      scene::Joint ball;
      ball.name = "ball";
      ball.kind = scene::JointKind::spherical;
      ball.second.to = "m0";
      s.joints.push_back(ball);
    }
    EXPECT_EQ(Rig(s).plan.unknowns.count, beside > 0.0 ? 3 : 1);
    compare_steps(s);
  }
}

TEST(HeldNodes, bend_nothing_else_in_statics) {
  for (int order : {1, 3})
    for (bool is_planar : {false, true}) {
      scene::Scene s = test::make_chain(1, order);
      s.analysis.kind = scene::AnalysisKind::statics;
      s.joints[0].kind = scene::JointKind::fixed;
      if (!is_planar) s.without = {"planar"};
      scene::PointLoad load;
      load.name = "tip";
      load.at.to = "b0";
      load.force = {{0.0, is_planar ? 0.0 : 300.0, 2000.0}};
      s.point_loads.push_back(load);
      Rig held(s), whole(barred(s));
      ASSERT_EQ(held.plan.held.size(), 1u);
      ASSERT_EQ(held.plan.unknowns.count, is_planar ? 3 : 6);
      const StepOptions options = make_step_options(s.analysis);
      for (Rig* rig : {&held, &whole})
        for (double factor : {0.5, 1.0}) ASSERT_TRUE(equilibrate(rig->system, rig->state, options, factor).converged);
      ASSERT_FALSE(held.state.unsettled.empty());
      expect_equal(held, whole, 1e-10);
      EXPECT_LT(unbalanced(held, whole), 1e-12);
    }
}

/// Velocities that do not fit jump at the start; the clamp gives its share of the impulse.
TEST(HeldNodes, tell_the_impulse_of_their_joints) {
  scene::Scene s = varied(1);
  scene::InitialVelocity v;
  v.of = "arm";
  v.velocity = {{0.3, 0.2, -1.0}};
  s.initial_velocities.push_back(v);
  Rig held(s), whole(barred(s));
  ASSERT_EQ(held.plan.held.size(), 2u);
  const StartReport a = make_consistent(held.system, held.state, true, 1e-3),
                    b = make_consistent(whole.system, whole.state, true, 1e-3);
  ASSERT_TRUE(a.ok && b.ok);
  EXPECT_GT(b.velocity_impulse, 0.1);
  EXPECT_NEAR(a.velocity_impulse, b.velocity_impulse, 1e-12);
  EXPECT_NEAR(a.velocity_change, b.velocity_change, 1e-12);
  expect_equal(held, whole, 1e-11);
}

TEST(HeldNodes, give_the_same_bits_on_any_number_of_threads) {
  scene::Scene s = varied(2);
  s.without.push_back("small");
  s.solver.leaf_size = 3;
  std::vector<State> ends;
  for (int threads : {1, 2, 8}) {
    const schedule::Threads pool(threads);
    Rig rig(s, pool.walker());
    rig.run(10, 1e-3);
    ends.push_back(rig.state);
  }
  for (std::size_t k = 1; k < ends.size(); ++k) {
    EXPECT_EQ(ends[0].multipliers, ends[k].multipliers);
    test::expect_same_nodes(ends[0], ends[k]);
  }
}

}  // namespace
}  // namespace bough::step
