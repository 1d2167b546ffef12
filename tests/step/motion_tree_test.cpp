/// Moving nodes along the motion tree: a path that starts like that of nodes moving alone, and whose power is told
/// truly.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "bough/schedule/serial.hpp"
#include "bough/step/system.hpp"
#include "small_scenes.hpp"
#include "support/given.hpp"

namespace bough::step {
namespace {

/// Beams of four nodes, the last held beside its node, hinges, a closing spring.
scene::Scene make_loop() {
  scene::Scene s = test::make_chain(3, 3);
  s.analysis.kind = scene::AnalysisKind::statics;
  s.beams[2].end_offset = motion::Vec3<double>{{0.1, -0.2, 0.15}};
  support::GivenSpring spring;
  spring.name = "spring";
  spring.first.to = "b2";
  spring.second.offset.x = {{1.0, 2.0, 3.0}};
  spring.stiffness = 10.0;
  s.couplings.push_back(spring);
  return s;
}

struct Fixture {
  scene::Scene scene = make_loop();
  plan::Plan plan = plan::make_plan(scene);
  System system{plan, scene.solver, schedule::make_serial_walker()};
  State state = make_initial_state(plan);
  std::vector<double> x = std::vector<double>(system.places().size());

  Fixture() {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::sin(1.0 + 2.7 * static_cast<double>(i));
    EXPECT_FALSE(system.set_time(1.0));
  }
};

motion::Vec6<double> difference(const plan::Plan& plan, const State& a, const State& b, std::size_t node) {
  const auto& p = nodes_in_space(plan, a)[node];
  const auto& q = nodes_in_space(plan, b)[node];
  return motion::Se3::log(motion::Frame<double>{lanes::transpose_times(p.R, q.R),
                                                lanes::transpose_times(p.R, motion::difference(q.x, p.x))});
}

double largest(const plan::Plan& plan, const State& a, const State& b) {
  double most = 0.0;
  for (std::size_t n = 0; n < a.num_nodes(); ++n) {
    const motion::Vec6<double> d = difference(plan, a, b, n);
    for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(d[i]));
  }
  return most;
}

TEST(MotionTree, holds_every_node_once_after_the_one_that_carries_it) {
  const Fixture f;
  const MotionTree tree = make_motion_tree(f.plan);
  std::set<int> seen{-1};
  for (const MotionTree::Link& link : tree.links) {
    EXPECT_TRUE(seen.count(link.parent)) << link.node;
    EXPECT_TRUE(seen.insert(link.node).second) << link.node;
  }
  EXPECT_EQ(seen.size(), f.plan.nodes.size() + 1);
}

TEST(MotionTree, moves_nodes_as_they_move_alone_to_first_order) {
  Fixture f;
  double last = 0.0;
  for (double size : {1e-2, 1e-3, 1e-4}) {
    std::vector<double> x = f.x;
    for (double& v : x) v *= size;
    State alone = f.state, carried = f.state;
    f.system.corrections().apply(alone, x.data());
    f.system.corrections().apply_along_tree(carried, x.data(), 1.0);
    const double d = largest(f.plan, alone, carried);
    EXPECT_LT(d, 100.0 * size * size);
    if (last > 0.0) {
      EXPECT_NEAR(d / last, 1e-2, 2e-3);
    }
    last = d;
    for (std::size_t m = 0; m < alone.multipliers.size(); ++m) EXPECT_EQ(alone.multipliers[m], carried.multipliers[m]);
  }
}

TEST(MotionTree, tells_the_power_at_the_end_of_the_path) {
  Fixture f;
  constexpr double s = 0.3, h = 1e-6;
  for (std::size_t k = 0; k < f.x.size(); ++k) f.x[k] *= 0.2;
  State before = f.state, after = f.state, at = f.state;
  f.system.corrections().apply_along_tree(before, f.x.data(), s - h);
  f.system.corrections().apply_along_tree(after, f.x.data(), s + h);
  f.system.corrections().apply_along_tree(at, f.x.data(), s);
  ASSERT_FALSE(f.system.evaluate(at, {}, false));
  double expected = 0.0, scale = 0.0;
  const auto add = [&](double force, double speed) {
    expected += force * speed;
    scale += std::abs(force * speed);
  };
  for (std::size_t n = 0; n < at.num_nodes(); ++n) {
    const motion::Vec6<double> twist = (0.5 / h) * difference(f.plan, before, after, n);
    const auto begin = static_cast<std::size_t>(f.system.places().block_begin(static_cast<int>(n)));
    for (std::size_t i = 0; i < 6; ++i) add(f.system.right_hand_side()[begin + i], twist[static_cast<int>(i)]);
  }
  for (const plan::JointPlan& j : f.plan.joints) {
    const auto begin = static_cast<std::size_t>(f.system.places().block_begin(j.block));
    const int size = f.plan.graph.block_size[static_cast<std::size_t>(j.block)];
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i)
      add(f.system.right_hand_side()[begin + i], f.x[begin + i]);
  }
  EXPECT_NEAR(f.system.corrections().power_along_tree(f.system.right_hand_side().data(), f.x.data()), expected,
              1e-8 * scale);
}

}  // namespace
}  // namespace bough::step
