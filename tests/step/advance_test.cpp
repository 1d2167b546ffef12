#include "bough/step/advance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bough/schedule/threads.hpp"
#include "lattice_scene.hpp"
#include "small_scenes.hpp"
#include "support/rig.hpp"

namespace bough::step {
namespace {

State run(const scene::Scene& scene, int threads, int steps, double h) {
  const schedule::Threads pool(threads);
  test::Rig rig(scene, pool.walker());
  rig.run(steps, h);
  return rig.state;
}

/// What the solver is told where the plan takes symmetric parts, so that it compares nothing.
TEST(Advance, symmetric_parts_are_mirror_images_bit_by_bit) {
  test::Rig rig(test::make_lattice(scene::AnalysisKind::dynamics));
  ASSERT_TRUE(rig.system.linear().takes_symmetric_parts());
  rig.run(3, 1e-3);
  ASSERT_TRUE(rig.system.linear().takes_symmetric_parts());
  std::vector<std::int64_t> unknowns;
  for (int e = 0; e < rig.plan.graph.num_elements(); ++e) {
    const solve::ConstElementView a = rig.system.elements().matrix_of(e, unknowns);
    const auto n = static_cast<std::int64_t>(unknowns.size());
    for (std::int64_t i = 0; i < n; ++i)
      for (std::int64_t j = 0; j < i; ++j)
        ASSERT_EQ(a[i * n + j], a[j * n + i]) << rig.plan.element_owner[static_cast<std::size_t>(e)];
  }
}

TEST(Advance, gives_the_same_bits_on_any_number_of_threads) {
  scene::Scene s = test::make_chain(12);
  s.solver.leaf_size = 3;
  const State one = run(s, 1, 15, 1e-3);
  for (int threads : {2, 3, 8}) {
    const State many = run(s, threads, 15, 1e-3);
    test::expect_same_nodes(one, many);
    for (std::size_t m = 0; m < one.multipliers.size(); ++m) EXPECT_EQ(one.multipliers[m], many.multipliers[m]);
  }
}

TEST(Advance, refuses_a_step_in_which_a_body_turns_by_nearly_half_a_turn) {
  scene::Scene s;
  scene::Body b;
  b.name = "top";
  b.mass = 1.0;
  b.inertia = motion::Mat3<double>::identity();
  s.bodies.push_back(b);
  scene::InitialVelocity v;
  v.of = "top";
  v.angular_velocity = {{0.0, 0.0, 30.0}};
  s.initial_velocities.push_back(v);
  const plan::Plan plan = plan::make_plan(s);
  const schedule::Threads pool(1);
  System system(plan, s.solver, pool.walker());
  State state = make_initial_state(plan);
  const StepOptions options = make_step_options(s.analysis);
  ASSERT_TRUE(make_consistent(system, state, true, 1e-3).ok);
  ASSERT_TRUE(start_alpha(system, state, options, 0.1).ok);
  const StepReport report = advance(system, state, options, 0.1);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.cause.find("top"), std::string::npos) << report.cause;
}

TEST(Equilibrate, converges_quadratically_under_a_bending_load) {
  scene::Scene s;
  s.analysis.kind = scene::AnalysisKind::statics;
  s.sections.push_back(test::make_bar_section());
  for (double x : {0.0, 1.0}) {
    scene::Node n;
    n.name = x == 0.0 ? "root" : "tip";
    n.placement.pose.x = {{x, 0.0, 0.0}};
    s.nodes.push_back(n);
  }
  scene::Beam b;
  b.name = "beam";
  b.section = "bar";
  b.start = "root";
  b.end = "tip";
  b.elements = 4;
  s.beams.push_back(b);
  scene::Joint clamp;
  clamp.name = "clamp";
  clamp.second.to = "root";
  s.joints.push_back(clamp);
  scene::PointLoad load;
  load.name = "weight";
  load.at.to = "tip";
  load.force = {{0.0, 0.0, -4000.0}};
  s.point_loads.push_back(load);
  const plan::Plan plan = plan::make_plan(s);
  const schedule::Threads pool(1);
  System system(plan, s.solver, pool.walker());
  State state = make_initial_state(plan);
  StepOptions options = make_step_options(s.analysis);
  const StepReport report = equilibrate(system, state, options, 1.0);
  ASSERT_TRUE(report.converged) << report.cause;
  const auto changes = report.changes();
  // change_{k+1} <= change_k^2 down to round-off: a linear rate breaks the bound at the small end.
  int small = 0;
  for (std::size_t k = 0; k + 1 < changes.size(); ++k) {
    if (changes[k] > 0.05 || changes[k] < 1e-12) continue;
    ++small;
    EXPECT_LE(changes[k + 1], std::max(changes[k] * changes[k], 1e-13)) << "iteration " << k + 1;
  }
  EXPECT_GE(small, 2);
}

TEST(MoveNode, adds_up_increments_like_the_group) {
  scene::Scene s = test::make_chain(1);
  for (const bool is_planar : {false, true}) {
    s.without = is_planar ? std::vector<std::string>{} : std::vector<std::string>{"planar"};
    const plan::Plan plan = plan::make_plan(s);
    ASSERT_EQ(plan.is_on<motion::Se2>(), is_planar);
    State state = make_initial_state(plan);
    motion::Vec6<double> a{{0.1, -0.2, 0.3, 0.4, 0.5, -0.6}}, b{{-0.3, 0.1, 0.2, 0.2, -0.4, 0.1}};
    if (is_planar)  // the plane is that of axes 1 and 3
      for (motion::Vec6<double>* v : {&a, &b}) (*v)[1] = (*v)[3] = (*v)[5] = 0.0;
    const motion::Frame<double> start{nodes_in_space(plan, state)[1].R, nodes_in_space(plan, state)[1].x.hi};
    move_node(plan, state, 1, a);
    move_node(plan, state, 1, b);
    const auto step = motion::compose(motion::Se3::exp(a), motion::Se3::exp(b));
    const auto expected = motion::compose(start, step);
    const auto dq = motion::Se3::log(step);
    const elements::NodeMotion& node = nodes_in_space(plan, state)[1];
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(node.x.hi[i], expected.x[i], 1e-15);
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(node.R.m[i], expected.R.m[i], 1e-15);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(node.dq[i], dq[i], 1e-15);
  }
}

}  // namespace
}  // namespace bough::step
