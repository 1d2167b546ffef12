// A pack against doubles, lane by lane and bit by bit.
#include <gtest/gtest.h>

#include <vector>

#include "bough/lanes/transpose.hpp"

namespace bough::lanes {
namespace {

template <class P>
class PackOf : public testing::Test {};
using Widths = testing::Types<Pack<1>, Pack<2>, Pack<4>, Pack<8>, Pack<16>>;
TYPED_TEST_SUITE(PackOf, Widths);

template <class P>
P ramp(double first, double step) {
  P p;
  for (int i = 0; i < P::width; ++i) p.set(i, first + step * i);
  return p;
}

TYPED_TEST(PackOf, arithmetic_gives_the_bits_of_doubles_in_every_lane) {
  using P = TypeParam;
  const P a = ramp<P>(-1.3, 0.37), b = ramp<P>(0.11, 0.71);
  const P sum = a + b, difference = a - b, product = a * b, quotient = a / b, negative = -a, root = sqrt(b);
  const P left = 2.5 * a, right = a * 2.5, shifted = a + 1.0, inverse = 1.0 / b;
  P updated = a;
  updated += b;
  for (int i = 0; i < P::width; ++i) {
    EXPECT_EQ(sum[i], a[i] + b[i]);
    EXPECT_EQ(updated[i], a[i] + b[i]);
    EXPECT_EQ(difference[i], a[i] - b[i]);
    EXPECT_EQ(product[i], a[i] * b[i]);
    EXPECT_EQ(quotient[i], a[i] / b[i]);
    EXPECT_EQ(negative[i], -a[i]);
    EXPECT_EQ(root[i], std::sqrt(b[i]));
    EXPECT_EQ(left[i], 2.5 * a[i]);
    EXPECT_EQ(right[i], a[i] * 2.5);
    EXPECT_EQ(shifted[i], a[i] + 1.0);
    EXPECT_EQ(inverse[i], 1.0 / b[i]);
  }
}

TYPED_TEST(PackOf, functions_give_the_bits_of_the_standard_library_in_every_lane) {
  using P = TypeParam;
  const P a = ramp<P>(-2.0, 0.37), b = ramp<P>(0.4, -0.21);
  const P s = sin(a), c = cos(a), t = atan2(a, b), m = abs(a);
  for (int i = 0; i < P::width; ++i) {
    EXPECT_EQ(s[i], std::sin(a[i]));
    EXPECT_EQ(c[i], std::cos(a[i]));
    EXPECT_EQ(t[i], std::atan2(a[i], b[i]));
    EXPECT_EQ(m[i], std::abs(a[i]));
  }
}

TYPED_TEST(PackOf, load_and_store_keep_the_order_of_unaligned_doubles) {
  using P = TypeParam;
  double buffer[P::width + 1], out[P::width + 1];
  for (int i = 0; i <= P::width; ++i) buffer[i] = out[i] = 0.5 * i;
  const P p = P::load(buffer + 1);
  (2.0 * p).store(out + 1);
  EXPECT_EQ(out[0], 0.0);
  for (int i = 0; i < P::width; ++i) {
    EXPECT_EQ(p[i], buffer[i + 1]);
    EXPECT_EQ(out[i + 1], 2.0 * buffer[i + 1]);
  }
}

TYPED_TEST(PackOf, masks_and_select_act_lane_by_lane) {
  using P = TypeParam;
  const P a = ramp<P>(0.0, 1.0), b = P(2.5), o = P(0.0);
  const auto low = less(a, b), positive = less(o, a);
  const P chosen = select(low, a, b), both = select(low & positive, P(1.0), o);
  const P either = select(low | positive, P(1.0), o), high = select(!low, P(1.0), o);
  for (int i = 0; i < P::width; ++i) {
    EXPECT_EQ(low[i], i < 2.5);
    EXPECT_EQ(chosen[i], i < 2.5 ? i : 2.5);
    EXPECT_EQ(both[i], i > 0 && i < 2.5 ? 1.0 : 0.0);
    EXPECT_EQ(either[i], 1.0);
    EXPECT_EQ(high[i], i > 2.5 ? 1.0 : 0.0);
  }
  EXPECT_TRUE(any(low));
  EXPECT_EQ(all(low), P::width <= 2);
  EXPECT_FALSE(any(less(a, o)));
}

TYPED_TEST(PackOf, choose_runs_only_the_side_that_is_needed) {
  using P = TypeParam;
  const P a = ramp<P>(0.0, 1.0);
  int first = 0, second = 0;
  const auto run = [&](double bound) {
    first = second = 0;
    return choose(
        less(a, P(bound)), [&] { return ++first, P(1.0); }, [&] { return ++second, P(2.0); });
  };
  run(100.0);
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 0);
  run(-1.0);
  EXPECT_EQ(first, 0);
  EXPECT_EQ(second, 1);
  const P mixed = run(0.5);
  for (int i = 0; i < P::width; ++i) EXPECT_EQ(mixed[i], i == 0 ? 1.0 : 2.0);
}

TYPED_TEST(PackOf, layout_does_not_depend_on_the_instruction_set) {
  using P = TypeParam;
  EXPECT_EQ(sizeof(P), 8u * P::width);
  EXPECT_EQ(alignof(P), 8u * P::width);
  EXPECT_EQ(sizeof(Mask<P::width>), sizeof(P));
}

TYPED_TEST(PackOf, derivative_types_and_vectors_of_packs_select_and_move_by_lane) {
  using P = TypeParam;
  using J = Jet<P, 2>;
  const P a = ramp<P>(0.0, 1.0);
  const J x = J::variable(a, 0), y = J::variable(P(1.5), 1);
  const J chosen = select(less(x, y), x, y);
  Taylor<P, 1> s(1.0), t(2.0);
  s.c[1] = P(3.0);
  t.c[1] = P(4.0);
  const Taylor<P, 1> series = select(less(a, P(1.5)), s, t);
  Vec<P, 3> v = cast<P>(Vec<double, 3>{{1, 2, 3}});
  set_lane(v, P::width - 1, Vec<double, 3>{{4, 5, 6}});
  Mat<P, 2, 2> m = Mat<P, 2, 2>::identity();
  set_lane(m, 0, Mat<double, 2, 2>{{1, 2, 3, 4}});
  for (int i = 0; i < P::width; ++i) {
    EXPECT_EQ(chosen.d[0][i], i < 1.5 ? 1.0 : 0.0);
    EXPECT_EQ(chosen.d[1][i], i < 1.5 ? 0.0 : 1.0);
    EXPECT_EQ(series.c[1][i], i < 1.5 ? 3.0 : 4.0);
    EXPECT_EQ(get_lane(v, i)[2], i == P::width - 1 ? 6.0 : 3.0);
    EXPECT_EQ(get_lane(m, i)(1, 0), i == 0 ? 3.0 : 0.0);
  }
}

TYPED_TEST(PackOf, arrays_turn_into_packs_and_back) {
  using P = TypeParam;
  constexpr int most = 21;
  for (int count = 0; count <= most; ++count) {
    std::vector<std::vector<double>> rows(P::width, std::vector<double>(most + 1, -1.0)), back = rows;
    const double* from[P::width];
    double* to[P::width];
    for (int l = 0; l < P::width; ++l) {
      for (int i = 0; i < count; ++i) rows[static_cast<std::size_t>(l)][static_cast<std::size_t>(i)] = 100.0 * l + i;
      from[l] = rows[static_cast<std::size_t>(l)].data();
      to[l] = back[static_cast<std::size_t>(l)].data();
    }
    std::vector<P> packs(most + 1, P(-2.0));
    gather_lanes(from, count, packs.data());
    for (int i = 0; i <= most; ++i)
      for (int l = 0; l < P::width; ++l)
        EXPECT_EQ(packs[static_cast<std::size_t>(i)][l], i < count ? 100.0 * l + i : -2.0) << count;
    scatter_lanes(packs.data(), count, to);
    EXPECT_EQ(back, rows) << count;
  }
}

TYPED_TEST(PackOf, lanes_are_loaded_from_where_they_lie) {
  using P = TypeParam;
  const std::vector<double> from{0.5, 1.5, 2.5, 3.5, 4.5};
  int at[P::width];
  for (int l = 0; l < P::width; ++l) at[l] = (3 * l + 1) % 5;
  const P p = load_lanes<P::width>(from.data(), at);
  for (int l = 0; l < P::width; ++l) EXPECT_EQ(p[l], 0.5 + at[l]);
}

}  // namespace
}  // namespace bough::lanes
