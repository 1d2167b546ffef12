/// The forms with global multipliers and the hybrid one give the hierarchical solution, floating sub-domains and
/// dependent rows included.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bough/schedule/threads.hpp"
#include "bough/solve/any_solver.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

using solve::DualForm;
using solve::DualOptions;
using solve::InterfaceSolution;

constexpr DualForm both_forms[] = {DualForm::global, DualForm::hybrid};

struct Torn {
  solve::Dual solver;
  solve::SolveReport report;
  Torn(const Solved& s, const DualOptions& form, const solve::SolveOptions& options = {})
      : solver(s.scene.graph, s.tree, form, options) {
    write_elements(s.scene, solver);
  }
  solve::FactorStatus factor() { return solver.factor(schedule::make_serial_walker()); }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) {
    Eigen::VectorXd x(b.size());
    report = solver.solve(schedule::make_serial_walker(), b.data(), x.data());
    return x;
  }
};

Eigen::VectorXd consistent_rhs(const Solved& s, unsigned seed) {
  SceneMaker m(seed);
  const Eigen::MatrixXd A = s.scaled_dense();
  const Eigen::VectorXd b = A * m.uniform_matrix(static_cast<int>(A.rows()), 1).col(0);
  return b.cwiseQuotient(Eigen::Map<const Eigen::VectorXd>(s.solver.row_scale().data(), A.rows()));
}

void expect_same_solution(const Scene& scene, int leaf, DualForm form, double backward_bar,
                          const solve::SolveOptions& options = {}) {
  const std::string what =
      scene.name + ", leaf " + std::to_string(leaf) + (form == DualForm::global ? ", global" : ", hybrid");
  Solved s(scene, {.leaf_size = leaf}, {});
  ASSERT_TRUE(s.factor().ok()) << what;
  Torn t(s, {.form = form}, options);
  const auto status = t.factor();
  ASSERT_TRUE(status.ok()) << what << " block " << status.block;
  EXPECT_EQ(status.deficiency, s.solver.last_status().deficiency) << what;
  const Eigen::VectorXd b = status.deficiency > 0 ? consistent_rhs(s, 7) : s.random_rhs(7);
  const Eigen::VectorXd x = s.solve(b), y = t.solve(b);
  EXPECT_LE(t.report.backward_error, backward_bar) << what;
  if (status.deficiency == 0) {
    EXPECT_LE(s.scaled_difference(y, x), condition_of(s.scaled_dense()) * (t.report.backward_error + 1e-15)) << what;
  } else {
    EXPECT_LE(s.scaled_difference(y, x), 1e-8) << what;
  }
}

TEST(Forms, GiveTheHierarchicalSolutionInDynamics) {
  for (const DualForm form : both_forms)
    for (const Scene& scene : make_all_families(61))
      for (const int leaf : {1, 3, 8, 1000}) expect_same_solution(scene, leaf, form, 1e-14);
}

TEST(Forms, NeedNoRefinementToKeepMostDigits) {
  for (const DualForm form : both_forms)
    for (const Scene& scene : make_all_families(67))
      expect_same_solution(scene, 3, form, 1e-10, {.refinement_steps = 0});  // eps / floating_pivot
}

/// Beams and joints without mass, held at one place or two: every sub-domain away from there floats.
Scene make_static_structure(unsigned seed, bool is_closed) {
  SceneMaker m(seed, 0.0);
  int end = m.add_node();
  m.add_joint({end}, 6);
  for (int l = 0; l < 9; ++l) {
    const int next = m.add_node();
    m.add_beam({end, next}, 0.0);
    end = next;
    if (l % 3 == 1) {  // a hinge with a rotary spring beside it
      const int hinge = m.add_node();
      m.add_joint({end, hinge}, 5);
      m.add_beam({end, hinge}, 0.0);
      end = hinge;
    }
  }
  if (is_closed) m.add_joint({end}, 3);
  return m.finish(is_closed ? "static, closed" : "static, open");
}

TEST(Forms, SolveStructuresWhoseSubdomainsFloat) {
  for (const DualForm form : both_forms)
    for (const bool is_closed : {false, true})
      for (unsigned seed = 1; seed <= 3; ++seed)
        for (const int leaf : {1, 2, 4})
          expect_same_solution(make_static_structure(seed, is_closed), leaf, form, 1e-14);
  const Scene scene = make_static_structure(1, false);
  Solved s(scene, {.leaf_size = 1}, {});
  ASSERT_TRUE(s.factor().ok());
  Torn t(s, {});
  ASSERT_TRUE(t.factor().ok());
  ASSERT_EQ(t.solver.interfaces().size(), 1u);
  EXPECT_GE(t.solver.interfaces()[0].num_floating, 6 * 8);  // eight beams float at least
}

TEST(Forms, DependentRowsWithinAndAcrossSubdomains) {
  for (const DualForm form : both_forms)
    for (const int leaf : {1, 3, 1000}) {
      const Scene scene = make_hinged_beams(71, 6, 2);
      expect_same_solution(scene, leaf, form,
                           1e-12);  // the left null vectors are blurred by eps over the least pivot taken
      Solved s(scene, {.leaf_size = leaf}, {});
      ASSERT_TRUE(s.factor().ok());
      Torn t(s, {.form = form});
      ASSERT_TRUE(t.factor().ok());
      EXPECT_EQ(t.solver.blocks_not_unique(), s.solver.blocks_not_unique());
      Eigen::VectorXd b = consistent_rhs(s, 1);
      const int row = scene.first_unknown()[static_cast<std::size_t>(s.solver.blocks_not_unique().back())];
      b(row) += 1.0 / s.solver.row_scale()[static_cast<std::size_t>(row)];  // a joint against its copy
      const Eigen::VectorXd x = s.solve(b), y = t.solve(b);
      EXPECT_NEAR(t.report.inconsistency, s.report.inconsistency, 1e-8);
      EXPECT_GT(t.report.inconsistency, 1e-6);
      EXPECT_EQ(t.report.inconsistent_block, s.report.inconsistent_block);
      EXPECT_LE(s.scaled_difference(y, x), 1e-7);
    }
}

TEST(Forms, AFreeStructureIsRefusedByName) {
  for (const DualForm form : both_forms)
    for (const int leaf : {1, 2, 1000}) {
      SceneMaker m(5, 0.0);
      int end = m.add_node();
      m.add_joint({end}, 6);
      for (int i = 0; i < 5; ++i) {
        const int next = m.add_node();
        m.add_beam({end, next}, 0.0);
        end = next;
      }
      const int floating = m.add_node(), other = m.add_node(), third = m.add_node();
      m.add_beam({floating, other}, 0.0);
      m.add_beam({other, third}, 0.0);
      const Scene scene = m.finish("floating");
      Solved s(scene, {.leaf_size = leaf}, {});
      Torn t(s, {.form = form});
      const auto status = t.factor();
      EXPECT_EQ(status.outcome, solve::FactorOutcome::singular) << leaf;
      EXPECT_EQ(status.deficiency, 6) << leaf;
      EXPECT_TRUE(status.block >= floating && status.block <= third) << status.block;
    }
}

TEST(Forms, ABlockThatNoElementTouchesIsRefusedByName) {
  for (const DualForm form : both_forms) {
    SceneMaker m(8);
    const int a = m.add_node(), b = m.add_node();
    m.add_beam({a, b});
    const int lonely = m.add_node(3);
    const Scene scene = m.finish("lonely");
    Solved s(scene, {.leaf_size = 1}, {});
    Torn t(s, {.form = form});
    EXPECT_EQ(t.factor().outcome, solve::FactorOutcome::singular);
    EXPECT_EQ(t.solver.last_status().block, lonely);
  }
}

TEST(Forms, IterationOnTheInterfaceGivesTheSameAndCounts) {
  for (const DualForm form : both_forms)
    for (Scene scene : {make_chain(3, 3, 5), make_lattice(4, 5, 5), make_star(5, 4, 4)})
      for (const bool is_symmetric : {true, false}) {
        if (is_symmetric)
          for (Eigen::MatrixXd& e : scene.elements) e = (0.5 * (e + e.transpose())).eval();
        Solved s(scene, {.leaf_size = 3}, {});
        ASSERT_TRUE(s.factor().ok());
        Torn t(s, {.form = form, .solution = InterfaceSolution::iterative});
        ASSERT_TRUE(t.factor().ok());
        const Eigen::VectorXd b = s.random_rhs(3), x = s.solve(b), y = t.solve(b);
        EXPECT_TRUE(t.report.interface_converged) << scene.name;
        EXPECT_GT(t.report.interface_iterations, 0) << scene.name;
        EXPECT_LE(t.report.backward_error, 1e-11) << scene.name;
        EXPECT_LE(s.scaled_difference(y, x), 1e-6) << scene.name;
        EXPECT_EQ(t.solver.interfaces()[0].iterations, t.report.interface_iterations);
      }
}

TEST(Forms, TheHybridInterfaceProblemIsSmallerAndBetterConditioned) {
  const Scene scene = make_chain(4, 1, 64, 1e-2);  // 15 interfaces of one node
  Solved s(scene, {.leaf_size = 4}, {});
  ASSERT_TRUE(s.factor().ok());
  Torn global(s, {}), hybrid(s, {.form = DualForm::hybrid});
  ASSERT_TRUE(global.factor().ok());
  ASSERT_TRUE(hybrid.factor().ok());
  const auto g = global.solver.interfaces()[0], h = hybrid.solver.interfaces()[0];
  EXPECT_LT(h.num_unknowns, g.num_unknowns);
  EXPECT_LE(h.condition, g.condition);
  EXPECT_GT(g.condition, 1.0);
  EXPECT_GT(g.flops, 0.0);
  EXPECT_GT(h.flops, 0.0);
  EXPECT_GE(g.seconds, 0.0);
}

TEST(Forms, DoNotDependOnTheNumberOfThreads) {
  const Scene scene = make_lattice(9, 5, 5);
  Solved s(scene, {.leaf_size = 3}, {});
  ASSERT_TRUE(s.factor().ok());
  const Eigen::VectorXd b = s.random_rhs(3);
  for (const DualForm form : both_forms) {
    Torn serial(s, {.form = form}), parallel(s, {.form = form});
    schedule::Threads threads(3);
    ASSERT_TRUE(serial.factor().ok());
    ASSERT_TRUE(parallel.solver.factor(threads.walker()).ok());
    const Eigen::VectorXd x = serial.solve(b);
    Eigen::VectorXd y(b.size());
    static_cast<void>(parallel.solver.solve(threads.walker(), b.data(), y.data()));
    EXPECT_EQ((x - y).cwiseAbs().maxCoeff(), 0.0);
  }
}

}  // namespace
}  // namespace bough::test
