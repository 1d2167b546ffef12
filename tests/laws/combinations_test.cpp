#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bough/laws/make_law.hpp"
#include "check_law.hpp"

namespace bough::laws {
namespace {

using Times = std::vector<double>;

TEST(Combinations, sum_adds_and_scaled_multiplies_all_three) {
  const Law a = make_harmonic(2.0, 3.0, 0.1);
  const Law b = make_smooth_ramp(0.0, 2.0, 1.0, 4.0);
  const Law law = make_sum({a, make_scaled(-3.0, b), make_constant(10.0)});
  for (double t : {-0.5, 0.3, 1.7}) {
    const LawValue x = a.at(t);
    const LawValue y = b.at(t);
    expect_equal(law.at(t),
                 {x.value - 3.0 * y.value + 10.0, x.rate - 3.0 * y.rate, x.acceleration - 3.0 * y.acceleration}, 1e-14);
  }
}

TEST(Combinations, combinations_of_constants_are_constant) {
  const Law two = make_constant(2.0);
  EXPECT_TRUE(make_sum({}).is_constant());
  EXPECT_TRUE(make_sum({two, Law{}}).is_constant());
  EXPECT_EQ(make_sum({two, two}).at(1.0).value, 4.0);
  EXPECT_TRUE(make_product(two, two).is_constant());
  EXPECT_EQ(make_product(two, make_scaled(3.0, two)).at(1.0).value, 12.0);
  EXPECT_TRUE(make_scaled(0.0, make_harmonic(1.0, 1.0)).is_constant());
  EXPECT_FALSE(make_product(two, make_harmonic(1.0, 1.0)).is_constant());
}

TEST(Combinations, product_obeys_the_rule_of_leibniz) {
  // sin(t) cos(t) = sin(2 t) / 2 needs all terms of the rule.
  const Law law = make_product(make_harmonic(1.0, 1.0), make_harmonic(1.0, 1.0, std::acos(0.0)));
  const Law expected = make_harmonic(0.5, 2.0);
  for (double t = -3.0; t < 3.0; t += 0.37) expect_equal(law.at(t), expected.at(t), 1e-14);
}

TEST(Combinations, breaks_of_a_combination_are_those_of_its_parts_without_doubles) {
  const Law a = make_ramp(1.0, 2.0, 0.0, 1.0);
  const Law b = make_ramp(2.0, 3.0, 0.0, 1.0);
  EXPECT_EQ(make_sum({a, b}).breakpoints(0.0, 9.0), (Times{1.0, 2.0, 3.0}));
  EXPECT_EQ(make_product(a, b).breakpoints(0.0, 9.0), (Times{1.0, 2.0, 3.0}));
  EXPECT_EQ(make_scaled(2.0, a).breakpoints(1.5, 9.0), (Times{2.0}));
}

TEST(Combinations, piecewise_takes_the_law_that_has_begun) {
  const Law law =
      make_piecewise({{0.0, make_constant(1.0)}, {1.0, make_ramp(1.0, 2.0, 5.0, 6.0)}, {3.0, make_constant(0.0)}});
  EXPECT_EQ(law.at(-4.0).value, 1.0);
  EXPECT_EQ(law.at(1.0, Side::left).value, 1.0);
  EXPECT_EQ(law.at(1.0, Side::right).value, 5.0);
  EXPECT_EQ(law.at(1.0).rate, 1.0);
  EXPECT_EQ(law.at(3.0, Side::left).value, 6.0);
  EXPECT_EQ(law.at(3.0).value, 0.0);
  EXPECT_EQ(law.breakpoints(-10.0, 10.0), (Times{1.0, 2.0, 3.0}));
}

TEST(Combinations, piecewise_hides_the_breaks_of_a_law_that_does_not_hold) {
  const Law law = make_piecewise({{0.0, make_ramp(5.0, 6.0, 0.0, 1.0)}, {2.0, make_ramp(0.0, 3.0, 0.0, 1.0)}});
  EXPECT_EQ(law.breakpoints(-10.0, 10.0), (Times{2.0, 3.0}));
}

TEST(Combinations, law_outlives_its_parts_and_copies_share_it) {
  Law law;
  {
    const Law part = make_harmonic(1.0, 1.0);
    law = make_sum({part, part});
  }
  const Law copy = law;
  EXPECT_EQ(copy.at(0.7).value, 2.0 * std::sin(0.7));
}

}  // namespace
}  // namespace bough::laws
