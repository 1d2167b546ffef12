/// Values that are declared symmetric: factored as such, looked at in every factorization, given up by name where
/// they are not.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <limits>
#include <utility>

#include "bough/schedule/threads.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

using solve::Symmetry;
using solve::SymmetryLoss;

std::vector<Scene> make_symmetric_families() {
  std::vector<Scene> scenes = make_all_families(4);
  scenes.push_back(make_lattice(4, 12, 12));
  for (Scene& s : scenes) s = make_symmetric(std::move(s));
  return scenes;
}

/// The first or the last element that is no joint.
int find_stiff(const Scene& scene, bool first) {
  const int count = scene.graph.num_elements();
  for (int k = 0; k < count; ++k)
    if (const int e = first ? k : count - 1 - k; scene.elements[static_cast<std::size_t>(e)].trace() > 0.0) return e;
  return -1;
}

/// An entry off the diagonal of the first block, and of the last.
void spoil(Solved& s, int element, bool in_first_block) {
  const Eigen::MatrixXd& a = s.scene.elements[static_cast<std::size_t>(element)];
  s.solver.element(element)[in_first_block ? 1 : a.rows() * a.rows() - 2] += 1e-3 * a.cwiseAbs().maxCoeff();
}

TEST(Symmetry, DeclaredValuesAreFactoredAsSuchInLessMemory) {
  for (const Scene& scene : make_symmetric_families())
    for (const bool lanes : {true, false}) {
      Solved s(scene, {}, {.symmetry = Symmetry::symmetric, .lanes = lanes}), general(scene, {}, {.lanes = lanes});
      ASSERT_TRUE(s.factor().ok()) << scene.name;
      ASSERT_TRUE(general.factor().ok()) << scene.name;
      EXPECT_EQ(s.solver.symmetry().used, Symmetry::symmetric) << scene.name;
      EXPECT_EQ(s.solver.symmetry().loss, SymmetryLoss::none) << scene.name;
      EXPECT_EQ(general.solver.symmetry().used, Symmetry::general);
      const Eigen::VectorXd b = s.random_rhs(3);
      const Eigen::VectorXd x = s.solve(b), y = general.solve(b);
      EXPECT_LE(s.report.backward_error, 1e-14) << scene.name;
      EXPECT_LE(s.scaled_difference(x, y), 1e-9) << scene.name;
    }
  // Lanes: a long chain of equal links.
  const Scene chain = make_symmetric(make_chain(4, 64, 4));
  Solved in_lanes(chain, {}, {.symmetry = Symmetry::symmetric}), general_lanes(chain, {}, {});
  EXPECT_GT(in_lanes.solver.counters().fronts_in_lanes, 100);
  EXPECT_LT(static_cast<double>(in_lanes.solver.counters().memory_bytes),
            0.95 * static_cast<double>(general_lanes.solver.counters().memory_bytes));
  const Scene lattice = make_symmetric(make_lattice(4, 24, 24));
  Solved s(lattice, {}, {.symmetry = Symmetry::symmetric, .lanes = false}), general(lattice, {}, {.lanes = false});
  EXPECT_LT(s.solver.counters().factor_flops, 0.51 * general.solver.counters().factor_flops);
  // Schur complements stand in the places of factors, of which half are left.
  EXPECT_LT(static_cast<double>(s.solver.counters().memory_bytes),
            0.92 * static_cast<double>(general.solver.counters().memory_bytes));
}

TEST(Symmetry, ValuesThatAreNotAreNamedAndFactoredAsIfNothingHadBeenDeclared) {
  for (const Scene& scene : make_symmetric_families())
    for (const bool first : {true, false}) {
      const int element = find_stiff(scene, first);
      Solved s(scene, {.leaf_size = 3}, {.symmetry = Symmetry::symmetric}), general(scene, {.leaf_size = 3}, {});
      spoil(s, element, first);
      spoil(general, element, first);
      ASSERT_TRUE(s.factor().ok()) << scene.name;
      ASSERT_TRUE(general.factor().ok()) << scene.name;
      const solve::SymmetryReport& report = s.solver.symmetry();
      EXPECT_EQ(report.declared, Symmetry::symmetric);
      EXPECT_EQ(report.used, Symmetry::general) << scene.name;
      EXPECT_EQ(report.loss, SymmetryLoss::values) << scene.name;
      EXPECT_EQ(report.element, element) << scene.name;
      EXPECT_EQ(report.block, scene.graph.element_blocks[static_cast<std::size_t>(
                                  scene.graph.element_begin[static_cast<std::size_t>(element)])]);
      EXPECT_GT(report.difference, 1e-6) << scene.name;
      const Eigen::VectorXd b = s.random_rhs(3);
      EXPECT_TRUE(same_bits(s.solve(b), general.solve(b))) << scene.name;
      EXPECT_EQ(s.solver.counters().factor_flops, general.solver.counters().factor_flops);
    }
}

TEST(Symmetry, TrustedValuesGiveTheSameBitsAndAreComparedWhereScalesAreTaken) {
  for (const Scene& scene : make_symmetric_families())
    for (const bool lanes : {true, false}) {
      const int element = find_stiff(scene, true);
      const solve::SolveOptions options{.symmetry = Symmetry::symmetric, .lanes = lanes, .refinement_steps = 0};
      Solved s(scene, {.leaf_size = 3}, options), compared(scene, {.leaf_size = 3}, options);
      s.solver.trust_symmetry(true);
      ASSERT_TRUE(s.factor().ok()) << scene.name;
      ASSERT_TRUE(s.factor().ok()) << scene.name;
      ASSERT_TRUE(compared.factor().ok()) << scene.name;
      const Eigen::VectorXd b = s.random_rhs(3);
      EXPECT_TRUE(same_bits(s.solve(b), compared.solve(b))) << scene.name;
      spoil(s, element, true);  // a broken promise is not noticed
      ASSERT_TRUE(s.factor().ok()) << scene.name;
      EXPECT_EQ(s.solver.symmetry().loss, SymmetryLoss::none) << scene.name;
      s.solver.rescale();
      ASSERT_TRUE(s.factor().ok()) << scene.name;
      EXPECT_EQ(s.solver.symmetry().loss, SymmetryLoss::values) << scene.name;
      EXPECT_EQ(s.solver.symmetry().element, element) << scene.name;
      spoil(compared, element, true);
      compared.solver.trust_symmetry(false);
      ASSERT_TRUE(compared.factor().ok()) << scene.name;
      EXPECT_EQ(compared.solver.symmetry().loss, SymmetryLoss::values) << scene.name;
    }
}

TEST(Symmetry, IsLookedAtInEveryFactorizationAndMatricesAreEvaluatedOnce) {
  for (const Scene& scene : make_symmetric_families())
    for (const bool first : {true, false})
      for (const int threads : {1, 2}) {
        const int element = find_stiff(scene, first);
        Solved s(scene, {.leaf_size = 3}, {.symmetry = Symmetry::symmetric, .refinement_steps = 0});
        ASSERT_TRUE(s.factor().ok()) << scene.name;
        const schedule::Threads pool(threads, 0.0);
        const auto batches = s.solver.batches();
        std::atomic<int> evaluated{0};
        const solve::SolverVisits visits = s.solver.visits();
        auto evaluate = [&](int visit) {  // in the visit, as time steps do
          const auto v = static_cast<std::size_t>(visit);
          for (int k = visits.batch_begin[v]; k < visits.batch_begin[v + 1]; ++k)
            for (int e : batches[static_cast<std::size_t>(k)].element)
              if (e == element) {
                spoil(s, element, first);
                ++evaluated;
              }
        };
        ASSERT_TRUE(s.solver.factor(pool.walker(), solve::make_visit_work(evaluate)).ok()) << scene.name;
        EXPECT_EQ(s.solver.symmetry().loss, SymmetryLoss::values) << scene.name;
        EXPECT_EQ(s.solver.symmetry().element, element) << scene.name;
        EXPECT_EQ(evaluated, 1) << scene.name;
        const Eigen::VectorXd b = s.random_rhs(3);
        s.solve(b);
        EXPECT_LE(s.report.backward_error, 1e-13) << scene.name;
        EXPECT_EQ(s.solver.counters().factorizations, 2);
      }
}

TEST(Symmetry, HasNoVerdictOnWhatIsNotFinite) {
  const Scene scene = make_symmetric(make_lattice(4, 8, 8));
  for (const bool lanes : {true, false}) {
    Solved s(scene, {}, {.symmetry = Symmetry::symmetric, .lanes = lanes});
    ASSERT_TRUE(s.factor().ok());
    s.solver.element(20)[1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(s.factor().outcome, solve::FactorOutcome::not_finite);
    EXPECT_EQ(s.solver.symmetry().used, Symmetry::symmetric);
    s.solver.element(20)[1] = scene.elements[20](0, 1);
    EXPECT_TRUE(s.factor().ok());
  }
}

}  // namespace
}  // namespace bough::test
