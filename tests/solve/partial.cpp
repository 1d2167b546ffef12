/// Factorizations of what changed alone: the bits are those of a whole one, whatever else happens on the way.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "bough/schedule/threads.hpp"
#include "random_cases.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

using solve::SolveOptions;
using solve::Symmetry;

/// The same scene factored in parts and as a whole. Scales are those of the first factorization in both.
class Twins {
 public:
  Twins(const Scene& scene, const tree::TreeOptions& tree_options, SolveOptions options, int num_threads)
      : scene_(scene),
        tree_(tree::make_tree(scene.graph, tree_options)),
        threads_(num_threads, 0.0),
        whole_(scene.graph, tree_, options),
        parts_(scene.graph, tree_, with_partial(options)),
        changed_(static_cast<std::size_t>(scene.graph.num_elements()), 1) {
    write_elements(scene, whole_);
    write_elements(scene, parts_);
  }

  void scale_element(int e, double factor) {
    changed_[static_cast<std::size_t>(e)] = 1;
    for (solve::Hierarchical* s : {&whole_, &parts_})
      write_element(factor * scene_.elements[static_cast<std::size_t>(e)], s->element(e));
  }

  /// Both factor and solve; the share of the work that the second did.
  double compare(bool with_rhs, const std::string& what) {
    const Eigen::Index n = tree_.num_unknowns();
    Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1.0, 1.0), x(n), y(n);
    const tree::Walker walker = threads_.walker();
    const double before = parts_.counters().flops_done;
    const solve::FactorStatus status = whole_.factor(walker, {}, with_rhs ? b.data() : nullptr);
    const solve::FactorStatus same = parts_.factor(walker, {}, with_rhs ? b.data() : nullptr, changed_);
    const double share = (parts_.counters().flops_done - before) / parts_.counters().factor_flops;
    EXPECT_EQ(status.outcome, same.outcome) << what;
    EXPECT_EQ(status.deficiency, same.deficiency) << what;
    EXPECT_EQ(status.delayed_pivots, same.delayed_pivots) << what;
    if (share > 0.0) {
      EXPECT_EQ(whole_.counters().lanes_left - lanes_left_[0], parts_.counters().lanes_left - lanes_left_[1]) << what;
    }
    lanes_left_[0] = whole_.counters().lanes_left;
    lanes_left_[1] = parts_.counters().lanes_left;
    changed_.assign(changed_.size(), 0);
    if (!status.ok() || !same.ok()) return share;
    for (int again = 0; again < 2; ++again) {  // a solution must not spoil what the next needs
      const auto solve = [&](solve::Hierarchical& s, Eigen::VectorXd& to) {
        return with_rhs && again == 0 ? s.finish(walker, to.data()) : s.solve(walker, b.data(), to.data());
      };
      const solve::SolveReport of_whole = solve(whole_, x), of_parts = solve(parts_, y);
      EXPECT_EQ(of_whole.backward_error, of_parts.backward_error) << what;
      EXPECT_EQ(x, y) << what;
    }
    return share;
  }

  solve::Hierarchical& whole() { return whole_; }
  solve::Hierarchical& parts() { return parts_; }

 private:
  static SolveOptions with_partial(SolveOptions o) {
    o.partial = true;
    return o;
  }
  const Scene& scene_;
  tree::Tree tree_;
  schedule::Threads threads_;
  solve::Hierarchical whole_, parts_;
  std::vector<char> changed_;
  std::int64_t lanes_left_[2] = {0, 0};
};

void compare_rounds(const Scene& scene, const SolveOptions& options, unsigned seed) {
  for (const int leaf : {0, 3}) {
    Twins twins(scene, {.leaf_size = leaf}, options, 2);
    const std::string what = scene.name + ", leaf size " + std::to_string(leaf);
    EXPECT_NEAR(twins.compare(false, what), 1.0, 1e-12) << what;
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> element(0, scene.graph.num_elements() - 1);
    std::uniform_real_distribution<double> factor(0.9, 1.1);
    for (int round = 0; round < 4; ++round) {
      for (int i = 0; i < round; ++i) twins.scale_element(element(random), factor(random));
      const double share = twins.compare(round % 2 == 1, what + ", round " + std::to_string(round));
      if (round == 0) {
        EXPECT_EQ(share, 0.0) << what;
      }
    }
  }
}

TEST(Partial, AllFamiliesAreTheSameBitByBit) {
  for (const bool lanes : {true, false})
    for (const Scene& scene : make_all_families(7)) compare_rounds(scene, {.lanes = lanes}, 11);
}

TEST(Partial, SymmetricFrontsAreTheSameBitByBit) {
  for (const bool lanes : {true, false})
    for (Scene scene : {make_chain(3, 24, 4), make_lattice(4, 10, 10), make_star(5, 5, 6)}) {
      for (Eigen::MatrixXd& a : scene.elements) a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
      for (const Symmetry symmetry :
           {Symmetry::symmetric, Symmetry::definite})  // with multipliers: fronts that are not
        compare_rounds(scene, {.symmetry = symmetry, .lanes = lanes}, 12);
    }
}

/// In lanes no front stands whole: what reports look at comes from elsewhere, as without `partial`.
TEST(Partial, InterfacesAreReportedAsOfAWholeFactorization) {
  const Scene scene = make_chain(4, 64, 4);
  Twins twins(scene, {}, {}, 1);
  twins.compare(false, scene.name);
  ASSERT_GT(twins.parts().counters().fronts_in_lanes, 100);
  const std::vector<solve::InterfaceReport> whole = twins.whole().interfaces(), parts = twins.parts().interfaces();
  ASSERT_EQ(whole.size(), parts.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_GT(parts[i].num_unknowns, 0) << i;
    EXPECT_EQ(parts[i].num_unknowns, whole[i].num_unknowns) << i;
    EXPECT_EQ(parts[i].condition, whole[i].condition) << i;
  }
}

/// Dependent rows, delayed pivots, lanes that leave: what is left alone keeps them.
TEST(Partial, HardCasesAreTheSameBitByBit) {
  for (int number = 0; number < 20; ++number)
    compare_rounds(make_case(number, 150).scene, {}, static_cast<unsigned>(number));
}

TEST(Partial, OneElementAsksForTheSubdomainsAboveItAlone) {
  const Scene lattice = make_lattice(4, 24, 24);
  Twins twins(lattice, {}, {.lanes = false}, 1);
  (void)twins.compare(false, "first");
  for (const int e : {0, lattice.graph.num_elements() / 2, lattice.graph.num_elements() - 1}) {
    twins.scale_element(e, 1.01);
    const double share = twins.compare(false, "element " + std::to_string(e));
    EXPECT_GT(share, 0.0);
    EXPECT_LT(share, 0.9);
  }
  const Scene chain = make_chain(4, 256, 4);
  Twins in_lanes(chain, {}, {}, 1);
  (void)in_lanes.compare(false, "first");
  in_lanes.scale_element(0, 1.01);
  EXPECT_LT(in_lanes.compare(false, "chain"), 0.5);
}

/// A failure leaves parts in no known state: the next factorization does all, whatever it is told.
TEST(Partial, AfterAFailureOrNewScalesAllIsDone) {
  const Scene scene = make_lattice(6, 12, 12);
  Twins twins(scene, {}, {}, 2);
  (void)twins.compare(false, "first");
  twins.scale_element(5, std::numeric_limits<double>::quiet_NaN());
  (void)twins.compare(false, "not finite");
  EXPECT_FALSE(twins.parts().last_status().ok());
  twins.scale_element(5, 1.0);
  EXPECT_NEAR(twins.compare(false, "after it"), 1.0, 1e-12);
  twins.whole().rescale();
  twins.parts().rescale();
  EXPECT_NEAR(twins.compare(false, "new scales"), 1.0, 1e-12);
}

}  // namespace
}  // namespace bough::test
