/// Which elements are evaluated in lockstep.
#include "lane_batches.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bough/solve/any_solver.hpp"
#include "evaluation_work.hpp"
#include "small_scenes.hpp"
#include "support/rig.hpp"

namespace bough::step {
namespace {

/// A chain in which every third link is damped: sub-domains have equal unknowns, but elements of two kinds.
scene::Scene make_mixed_chain(int links) {
  scene::Scene s = test::make_chain(links);
  s.sections.push_back(s.sections[0]);
  s.sections[1].name = "damped";
  s.sections[1].damping = 1e-4 * s.sections[0].stiffness;
  for (std::size_t b = 0; b < s.beams.size(); b += 3) s.beams[b].section = "damped";
  return s;
}

struct Counted {
  int packs = 0, alone = 0;
  std::vector<int> seen;  ///< by element: how often it is evaluated
};

Counted count_batches(const test::Rig& rig) {
  Counted c;
  c.seen.assign(rig.plan.directory.size(), 0);
  rig.plan.with_group([&]<class G>() {
    const LinearSolution& linear = rig.system.linear();
    LaneBatches<G> batches;
    batches.make(rig.plan, linear.solver().batches(), linear.visits(), nullptr);
    for (std::size_t b = 0; b < batches.batches().size(); ++b) {
      c.packs += batches.holds(b) ? 1 : 0;
      for (const int id : batches.batches()[b].element) {
        if (id < 0) continue;
        ++c.seen[static_cast<std::size_t>(id)];
        c.alone += batches.holds(b) ? 0 : 1;
      }
    }
  });
  return c;
}

/// The solver puts sub-domains of equal unknowns together, and the elements of one of its batches may differ in kind:
/// they are separated, and packs that are not full are filled.
TEST(LaneBatches, elements_of_all_kinds_are_evaluated_in_lockstep) {
  for (const bool is_planar : {true, false}) {
    scene::Scene s = make_mixed_chain(40);
    if (!is_planar) s.without = {"planar"};
    const test::Rig rig(s);
    ASSERT_TRUE(rig.plan.took("lanes"));
    const Counted c = count_batches(rig);
    EXPECT_TRUE(std::all_of(c.seen.begin(), c.seen.end(), [](int n) { return n == 1; }));
    int packs = 0, alone = 0, elements = 0;
    for (const EvaluationWork& kind : count_evaluations(rig.plan)) {
      packs += kind.packs;
      alone += kind.alone;
      elements += kind.elements;
    }
    EXPECT_EQ(elements, rig.plan.graph.num_elements());
    EXPECT_LE(c.alone, 6) << "less than three of each kind: two of beams and one or two of hinges";
    EXPECT_EQ(c.packs, packs);
    EXPECT_EQ(c.alone, alone);
  }
}

}  // namespace
}  // namespace bough::step
