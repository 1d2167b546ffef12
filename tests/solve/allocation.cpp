/// Nothing allocates after the first factorization and solution; with delayed pivots not after they have been met once.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#include "loops.hpp"
#include "solving.hpp"

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t align) {
  ++allocations;
  const auto a = static_cast<std::size_t>(align);
  if (void* p = std::aligned_alloc(a, (size + a - 1) / a * a)) return p;
  throw std::bad_alloc();
}
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // both sides are replaced here
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace bough::test {
namespace {

TEST(Allocation, NothingAllocatesAfterTheFirstFactorAndSolve) {
  const tree::Walker walker = schedule::make_serial_walker();
  std::vector<std::pair<Scene, solve::Symmetry>> cases;
  for (Scene& scene : make_all_families(5)) {
    cases.emplace_back(scene, solve::Symmetry::general);
    for (Eigen::MatrixXd& a : scene.elements) a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
    cases.emplace_back(scene, solve::Symmetry::symmetric);
    cases.emplace_back(make_definite(std::move(scene)), solve::Symmetry::symmetric);
  }
  cases.emplace_back(make_loops({.columns = 20, .long_bar = true}), solve::Symmetry::general);  // dependent rows
  for (const auto& [scene, symmetry] : cases) {
    for (const tree::TreeOptions& cut : {tree::TreeOptions{.leaf_size = 3}, tree::TreeOptions{}}) {
      Solved s(scene, cut, {.symmetry = symmetry});
      const Eigen::VectorXd b = Eigen::VectorXd::Ones(scene.num_unknowns());
      Eigen::VectorXd x(b.size());
      ASSERT_TRUE(s.factor().ok());
      (void)s.solver.solve(walker, b.data(), x.data());
      const auto enlarging = s.solver.counters().enlarging_allocations;
      const long before = allocations;
      for (int i = 0; i < 3; ++i) {
        s.solver.rescale();
        ASSERT_TRUE(s.solver.factor(walker).ok());
        (void)s.solver.solve(walker, b.data(), x.data());
        s.solver.multiply(walker, x.data(), x.data() == nullptr ? nullptr : const_cast<double*>(b.data()));
      }
      EXPECT_EQ(allocations - before, 0) << scene.name;
      EXPECT_EQ(s.solver.counters().enlarging_allocations, enlarging);
    }
  }
}

TEST(Allocation, EvenTheFirstFactorizationTakesMemoryForDelayedPivotsOnly) {
  const tree::Walker walker = schedule::make_serial_walker();
  for (const Scene& scene : make_all_families(5)) {
    Solved s(scene, {.leaf_size = 3}, {});
    const long before = allocations;
    ASSERT_TRUE(s.solver.factor(walker).ok());
    EXPECT_LE(allocations - before, 3 * s.solver.counters().enlarging_allocations) << scene.name;
  }
}

}  // namespace
}  // namespace bough::test
