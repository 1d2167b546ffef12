/// Matrices that must be refused, and whom the refusal names.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solving.hpp"
#include "support/untrapped.hpp"

namespace bough::test {
namespace {

TEST(Singular, AFloatingPartOfAStaticSceneIsNamed) {
  for (int leaf : {1, 4, 1000}) {
    SceneMaker m(5, 0.0);
    int end = m.add_node();
    m.add_joint({end}, 6);
    for (int i = 0; i < 5; ++i) {
      const int next = m.add_node();
      m.add_beam({end, next}, 0.0);
      end = next;
    }
    const int floating = m.add_node(), other = m.add_node();
    m.add_beam({floating, other}, 0.0);
    const Scene scene = m.finish("floating");
    Solved s(scene, {.leaf_size = leaf}, {});
    const auto status = s.factor();
    EXPECT_EQ(status.outcome, solve::FactorOutcome::singular);
    EXPECT_EQ(status.deficiency, 6);
    EXPECT_TRUE(status.block == floating || status.block == other) << status.block;
    EXPECT_GT(status.magnitude, 0.1);
  }
}

TEST(Singular, AHingeWithoutStiffnessIsNamedAtTheOuterLink) {
  SceneMaker m(6, 0.0);
  const int a = m.add_node(), b = m.add_node(), c = m.add_node(), d = m.add_node();
  m.add_joint({a}, 6);
  m.add_beam({a, b}, 0.0);
  m.add_joint({b, c}, 5);
  m.add_beam({c, d}, 0.0);
  const Scene scene = m.finish("hinge");
  Solved s(scene, {.leaf_size = 1}, {});
  const auto status = s.factor();
  EXPECT_EQ(status.outcome, solve::FactorOutcome::singular);
  EXPECT_EQ(status.deficiency, 1);
  EXPECT_TRUE(status.block == c || status.block == d) << status.block;
}

TEST(Singular, AnUnknownThatNoElementStiffensIsNamedWithItsIndex) {
  SceneMaker m(7);
  const int a = m.add_node(), b = m.add_node(), c = m.add_node();
  m.add_beam({a, b});
  m.add_beam({b, c});
  Scene scene = m.finish("empty unknown");
  scene.elements[1].row(6 + 4).setZero();
  scene.elements[1].col(6 + 4).setZero();
  Solved s(scene, {}, {});
  const auto status = s.factor();
  EXPECT_EQ(status.outcome, solve::FactorOutcome::singular);
  EXPECT_EQ(status.block, c);
  EXPECT_EQ(status.local, 4);
}

TEST(Singular, ABlockThatNoElementTouchesIsNamed) {
  SceneMaker m(8);
  m.add_body(m.add_node());
  const int lonely = m.add_node(3);
  const Scene scene = m.finish("lonely");
  Solved s(scene, {}, {});
  const auto status = s.factor();
  EXPECT_EQ(status.outcome, solve::FactorOutcome::singular);
  EXPECT_EQ(status.block, lonely);
}

TEST(Singular, FactoringAgainAfterRepairIsRegular) {
  SceneMaker m(9);
  const int a = m.add_node(), b = m.add_node();
  m.add_beam({a, b});
  Scene scene = m.finish("repair");
  const Eigen::MatrixXd good = scene.elements[0];
  scene.elements[0].setZero();
  Solved s(scene, {}, {});
  EXPECT_EQ(s.factor().outcome, solve::FactorOutcome::singular);
  scene.elements[0] = good;
  write_elements(scene, s.solver);
  s.solver.rescale();
  EXPECT_TRUE(s.factor().ok());
  s.solve(s.random_rhs(1));
  EXPECT_LE(s.report.backward_error, 1e-15);
}

TEST(Singular, NotANumberAndInfinityAreToldFromTheLowestFront) {
  const Untrapped untrapped;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (Scene& scene : std::vector<Scene>{make_chain(1, 4, 4), make_lattice(2, 4, 4)}) {
      const auto e = scene.elements.size() / 2;
      scene.elements[e](1, 0) = bad;
      Solved s(scene, {.leaf_size = 2}, {});
      const auto status = s.factor();
      EXPECT_EQ(status.outcome, solve::FactorOutcome::not_finite);
      const auto& front = s.tree.fronts[static_cast<std::size_t>(status.front)];
      bool holds = false;
      for (int other : s.tree.elements(front)) holds = holds || other == static_cast<int>(e);
      // lowest front that saw it: the one that assembles the element, or the first above it that eliminates anything
      EXPECT_TRUE(holds || front.num_eliminated > 0);
    }
}

}  // namespace
}  // namespace bough::test
