/// Fronts with very many children.
#include "solving.hpp"

namespace bough::test {
namespace {

/// More children of one front than 16 bits count.
TEST(ManyChildren, AHubMayHaveAnyNumberOfArms) {
  SceneMaker m(11);
  const int hub = m.add_node();
  const auto add_row = [&](int beams) {
    for (int i = 0, end = hub; i < beams; ++i) {
      const int next = m.add_node();
      m.add_beam({end, next});
      end = next;
    }
  };
  for (int a = 0; a < 33000; ++a) add_row(1);
  add_row(40);  // the root lies there, not at the hub
  const Scene scene = m.finish("hub");
  Solved s(scene, {.leaf_size = scene.graph.num_elements()}, {.refinement_steps = 0});
  ASSERT_TRUE(s.factor().ok());
  (void)s.solve(s.random_rhs(5));
  EXPECT_LE(s.report.backward_error, 1e-13);
}

}  // namespace
}  // namespace bough::test
