/// When factors are renewed, and when an iteration ends without one.
#include <gtest/gtest.h>

#include <algorithm>

#include "bough/scene/parts.hpp"
#include "bough/step/step_cost.hpp"
#include "lattice_scene.hpp"
#include "small_scenes.hpp"
#include "support/rig.hpp"

namespace bough::step {
namespace {

/// A steel bar of 64 elements, held at one end, under a share of its weight.
scene::Scene make_bar(double share) {
  scene::Scene s = test::make_chain(1);
  s.joints[0].kind = scene::JointKind::fixed;
  s.beams[0].elements = 64;
  s.gravity = share * s.gravity;
  return s;
}

/// Places rounded to eps leave forces of eps EA over the length of an element, 1e-6 N, beside 3e-3 and 3e-5 N of
/// weight: the tolerance cannot be met. Nodes that lie still ask for neither more solutions nor new factors. Under the
/// larger weight iterations end before that, where the motion left out is far below the local error.
TEST(Renewal, none_for_forces_that_round_off_leaves) {
  constexpr int steps = 100;
  for (const double share : {1e-4, 1e-6}) {
    test::Rig rig(make_bar(share));
    rig.run(0, 1e-3);
    const long solutions = rig.system.counts().solutions, factors = rig.system.counts().factorizations;
    const StepOptions options = make_step_options(rig.scene.analysis);
    int at_floor = 0;
    for (int k = 1; k <= steps; ++k) {
      const StepReport report = advance(rig.system, rig.state, options, 1e-3 * k);
      ASSERT_TRUE(report.converged) << report.cause;
      at_floor += report.at_floor ? 1 : 0;
    }
    EXPECT_LE(rig.system.counts().solutions - solutions, 2.3 * steps) << share;
    EXPECT_LE(rig.system.counts().factorizations - factors, 0.15 * steps) << share;
    if (share < 1e-4) {
      EXPECT_GT(at_floor, steps / 5) << "the scene is meant to end at round-off, " << share;
    }
  }
}

/// Most elements of a lattice have hardly any equals that are factored in lockstep with theirs, and are evaluated
/// eight at a time all the same.
TEST(StepCost, counts_elements_as_they_are_evaluated) {
  const test::Rig rig(test::make_lattice(scene::AnalysisKind::dynamics));
  int alone = 0;
  for (const solve::ElementBatch& batch : rig.system.linear().solver().batches()) {
    const auto present = std::count_if(batch.element.begin(), batch.element.end(), [](int id) { return id >= 0; });
    alone += present == 1 ? 1 : 0;
  }
  ASSERT_GT(alone, rig.plan.graph.num_elements() / 2);
  const auto beams = static_cast<double>(plan::array_of<elements::Beam<2>>(rig.plan.elements).size());
  ASSERT_EQ(beams, static_cast<double>(rig.plan.directory.size()));
  const elements::Cost& cost = elements::Beam<2>::cost;
  const StepCost step = estimate_step_cost(rig.system);
  EXPECT_GE(step.residual, beams * cost.lane);
  EXPECT_LT(step.residual, beams * 0.5 * cost.alone);
  EXPECT_LT(step.tangent, beams * 0.5 * cost.alone_tangent);
  EXPECT_GT(step.renewal(), 1.0) << "a tangent and its factor cost more than a solution";
}

/// Three rows of each planar loop in space depend on others. The plane leaves them out.
TEST(StepCost, counts_dependent_rows_of_loops) {
  const auto factor_and_solve = [](int windows, double out_of_plane) {
    scene::Scene s = scene::make_four_bars(windows);
    s.gravity[2] = out_of_plane;
    const test::Rig rig(s);
    EXPECT_EQ(rig.plan.is_on<motion::Se2>(), out_of_plane == 0.0);
    return estimate_step_cost(rig.system);
  };
  const StepCost space = factor_and_solve(160, 0.1), half = factor_and_solve(80, 0.1),
                 plane = factor_and_solve(160, 0.0);
  EXPECT_GT(space.factor, 5.0 * plane.factor);
  EXPECT_GT(space.solve, 4.0 * plane.solve);
  EXPECT_NEAR(space.factor / half.factor, 2.0, 0.2);
  EXPECT_NEAR(space.solve / half.solve, 2.0, 0.2);
}

/// A plane has half the unknowns: each part of a step costs less, tangents and the motion of nodes less than half.
TEST(StepCost, is_lower_in_a_plane) {
  scene::Scene s = test::make_chain(16);
  const test::Rig plane(s);
  s.without = {"planar"};
  const test::Rig space(s);
  ASSERT_TRUE(plane.plan.is_on<motion::Se2>() && space.plan.is_on<motion::Se3>());
  const StepCost a = estimate_step_cost(plane.system), b = estimate_step_cost(space.system);
  EXPECT_LT(a.residual, b.residual);
  EXPECT_LT(a.solve, b.solve);
  EXPECT_LT(a.tangent, 0.5 * b.tangent);
  EXPECT_LT(a.factor, b.factor);
  EXPECT_LT(a.update, 0.5 * b.update);
}

/// A small lattice is visited by one thread, and its leaves are not alike: nothing is gained where it is cut.
TEST(Tree, is_one_subdomain_where_cuts_only_add_interfaces) {
  const auto count = [](scene::Scene s, const std::vector<std::string>& without) {
    s.without.insert(s.without.end(), without.begin(), without.end());
    return test::Rig(s).system.linear().tree().num_subdomains();
  };
  scene::Scene lattice = test::make_lattice(scene::AnalysisKind::dynamics);
  EXPECT_EQ(count(lattice, {}), 1);
  EXPECT_GT(count(lattice, {"small"}), 1) << "several threads share it";
  EXPECT_GT(count(test::make_chain(64), {"planar"}), 8) << "its leaves are alike";
  lattice.solver.form = scene::SolverForm::hybrid;
  EXPECT_GT(count(lattice, {}), 1) << "the form is about interfaces";
  lattice.solver.form = scene::SolverForm::local;
  lattice.solver.depth = 2;
  EXPECT_GT(count(lattice, {}), 1) << "a depth is given";
}

}  // namespace
}  // namespace bough::step
