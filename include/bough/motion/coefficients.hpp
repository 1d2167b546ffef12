#pragma once
/// Coefficients of rotations as analytic functions of x = phi^2, with their derivatives by x, free of cancellation.
///   c_n(x) = sum_k (-x)^k / (2k + n)!        (Stumpff functions: c_0 = cos phi, c_1 = sin phi / phi, ...)
///   a = c_1 = sin(phi)/phi,  b = c_2 = (1 - cos phi)/phi^2,  c = c_3 = (phi - sin phi)/phi^3
///   k = (1 - (phi/2) cot(phi/2)) / phi^2     (poles at phi = 2 pi, 4 pi, ...)
/// They are functions of x, not of phi, so no square root is taken near zero, and derivative types are valid at phi =
/// 0.
#include <array>
#include <cmath>

#include "bough/lanes/jet.hpp"
#include "bough/motion/types.hpp"

namespace bough::motion {

namespace detail {

/// Polynomial sum_k table[k] x^k by Horner's rule in x^2, for even and odd terms separately: two short chains of
/// dependent operations instead of a long one.
template <class S, class L, std::size_t N>
S horner(const std::array<L, N>& table, const S& x) {
  const S xx = x * x;
  S even(table[(N - 1) / 2 * 2]), odd(table[N / 2 * 2 - 1]);
  for (std::size_t k = (N - 1) / 2 * 2; k >= 2; k -= 2) even = multiply_add(even, xx, S(table[k - 2]));
  for (std::size_t k = N / 2 * 2 - 1; k >= 2; k -= 2) odd = multiply_add(odd, xx, S(table[k - 2]));
  return multiply_add(odd, x, even);
}
/// Its derivative by x.
template <class S, class L, std::size_t N>
S horner_slope(const std::array<L, N>& table, const S& x) {
  S r(table[N - 1]), d(0.0);
  for (std::size_t k = N - 1; k-- > 0;) {
    d = d * x + r;
    r = r * x + table[k];
  }
  return d;
}
/// A table in the precision of a scalar's literals, rounded when the program is compiled.
template <class L, std::size_t N>
constexpr std::array<L, N> rounded(const std::array<long double, N>& table) {
  std::array<L, N> t{};
  for (std::size_t k = 0; k < N; ++k) t[k] = static_cast<L>(table[k]);
  return t;
}

/// The first M terms of a table.
template <std::size_t M, std::size_t N>
constexpr std::array<long double, M> first_of(const std::array<long double, N>& table) {
  static_assert(M <= N);
  std::array<long double, M> t{};
  for (std::size_t k = 0; k < M; ++k) t[k] = table[k];
  return t;
}

/// (-1)^k / (2k + n)! for k = 0 .. 13: at x = 16 the first term left out is below 3e-19 of the sum.
constexpr std::array<long double, 14> stumpff_table(int n) {
  std::array<long double, 14> t{};
  long double f = 1.0L;
  for (int j = 2; j <= n; ++j) f *= j;
  for (int k = 0; k < 14; ++k) {
    t[static_cast<std::size_t>(k)] = (k % 2 ? -1.0L : 1.0L) / f;
    f *= static_cast<long double>(2 * k + n + 1) * static_cast<long double>(2 * k + n + 2);
  }
  return t;
}
template <class L>
inline constexpr std::array<L, 14> stumpff_6 = rounded<L>(stumpff_table(6));
template <class L>
inline constexpr std::array<L, 14> stumpff_7 = rounded<L>(stumpff_table(7));
template <class L>
inline constexpr std::array<L, 8> near_stumpff_6 = rounded<L>(first_of<8>(stumpff_table(6)));
template <class L>
inline constexpr std::array<L, 8> near_stumpff_7 = rounded<L>(first_of<8>(stumpff_table(7)));
template <class L>
inline constexpr std::array<L, 14> stumpff_8 = rounded<L>(stumpff_table(8));
template <class L>
inline constexpr std::array<L, 14> stumpff_9 = rounded<L>(stumpff_table(9));

/// 2 sum_{m >= 3} (2 pi m)^-(2n+2): power series of k without its first two poles, which converges up to phi = 6 pi.
template <class L>
inline constexpr std::array<L, 15> inverse_rest = rounded<L>(std::array<long double, 15>{
    0.0200075935568722261809087L, 2.54381206886256215795349e-5L, 5.58456839049441513112409e-8L,
    1.40882415747610468617681e-10L, 3.75671620021579781148421e-13L, 1.02801253753604610784426e-15L,
    2.85002212921379123826149e-18L, 7.95557541071984498358231e-21L, 2.22893266455370115667057e-23L,
    6.25747115080577223920474e-26L, 1.75867304929096798907852e-28L, 4.94584695005793873891076e-31L,
    1.39138267890808799277361e-33L, 3.91504425254531424268482e-36L, 1.10172689146714187787501e-38L});

/// 2 sum_m (2 pi m)^-(2n+2): power series of k itself, used where x is small.
constexpr std::array<long double, 15> inverse_table{
    0.0833333333333333333333333L,     0.00138888888888888888888889L,  0.0000330687830687830687830688L,
    0.00000082671957671957671957672L, 2.08767569878680989792101e-8L,  5.28419013868749318484768e-10L,
    1.3382536530684678832827e-11L,    3.3896802963225828668302e-13L,  8.58606205627784456413591e-15L,
    2.17486869855806187304152e-16L,   5.50900282836022951520265e-18L, 1.39544646858125233407077e-19L,
    3.53470703962946747169323e-21L,   8.95351742703754685040261e-23L, 2.26795245233768306031095e-24L};
/// Coefficients of the derivative of a series.
template <std::size_t N>
constexpr std::array<long double, N - 1> slope_of(const std::array<long double, N>& t) {
  std::array<long double, N - 1> d{};
  for (std::size_t k = 1; k < N; ++k) d[k - 1] = static_cast<long double>(k) * t[k];
  return d;
}
template <class L>
inline constexpr std::array<L, 12> near_inverse = rounded<L>(first_of<12>(inverse_table));
template <class L>
inline constexpr std::array<L, 12> near_inverse_1 = rounded<L>(first_of<12>(slope_of(inverse_table)));
template <class L>
inline constexpr std::array<L, 12> near_inverse_2 = rounded<L>(first_of<12>(slope_of(slope_of(inverse_table))));
template <class L>
inline constexpr std::array<L, 12> near_inverse_3 =
    rounded<L>(first_of<12>(slope_of(slope_of(slope_of(inverse_table)))));

/// Below this x = phi^2 (phi = 1/2) series of a few terms suffice. Most relative rotations of neighbouring nodes are
/// below.
inline constexpr double near_x = 0.25;

/// Below this x = phi^2 (phi = 4) polynomials are used, beyond it closed forms. There the factor 1/x^3 reduces the
/// rounding of sin and cos to one ulp of the highest coefficient, so one limit suits all coefficients and their
/// derivatives.
inline constexpr double switch_x = 16.0;

}  // namespace detail

/// c_0 .. c_7 at x = phi^2 >= 0. Below phi = 4, c_6 and c_7 are polynomials (shorter ones below phi = 1/2), and the
/// stable recurrence c_n = 1/n! - x c_{n+2} gives the others. Beyond, sine and cosine of phi/2 give c_0 to c_2, and the
/// recurrence, upwards, the others. Errors are round-off of the largest value.
template <class S>
lanes::Vec<S, 8> eval_stumpff(const S& x) {
  using L = Literal<S>;
  constexpr L one = 1, third = one / 3;
  const auto small = less(x, S(detail::switch_x)), near = less(x, S(detail::near_x));
  const auto by_recurrence = [&](const S& y, const S& c6, const S& c7) {
    lanes::Vec<S, 8> c;
    c[7] = c7;
    c[6] = c6;
    c[5] = one / 120 - y * c[7];
    c[4] = one / 24 - y * c[6];
    c[3] = third / 2 - y * c[5];
    c[2] = one / 2 - y * c[4];
    c[1] = one - y * c[3];
    c[0] = one - y * c[2];
    return c;
  };
  return choose(
      near,
      [&] {
        const S y = select(near, x, S(0.0));
        return by_recurrence(y, detail::horner(detail::near_stumpff_6<L>, y),
                             detail::horner(detail::near_stumpff_7<L>, y));
      },
      [&] {
        return choose(
            small,
            [&] {
              const S y = select(small, x, S(0.0));
              return by_recurrence(y, detail::horner(detail::stumpff_6<L>, y), detail::horner(detail::stumpff_7<L>, y));
            },
            [&] {
              using std::cos;
              using std::sin;
              using std::sqrt;
              const S safe = select(small, S(detail::switch_x), x), inv = S(1.0) / safe, phi = sqrt(safe);
              const S half = L(0.5) * phi, s = sin(half), co = cos(half);
              lanes::Vec<S, 8> c;
              c[0] = (co - s) * (co + s);
              c[1] = L(2) * s * co / phi;
              c[2] = L(2) * s * s * inv;
              c[3] = (one - c[1]) * inv;
              c[4] = (one / 2 - c[2]) * inv;
              c[5] = (third / 2 - c[3]) * inv;
              c[6] = (one / 24 - c[4]) * inv;
              c[7] = (one / 120 - c[5]) * inv;
              return c;
            });
      });
}

/// c_8 and c_9, which third derivatives need as well. c = eval_stumpff(x).
template <class S>
lanes::Vec<S, 2> eval_last_stumpff(const S& x, const lanes::Vec<S, 8>& c) {
  using L = Literal<S>;
  const auto small = less(x, S(detail::switch_x));
  return choose(
      small,
      [&] {
        const S near = select(small, x, S(0.0));
        return lanes::Vec<S, 2>{
            {detail::horner(detail::stumpff_8<L>, near), detail::horner(detail::stumpff_9<L>, near)}};
      },
      [&] {
        const S inv = S(1.0) / select(small, S(detail::switch_x), x);
        return lanes::Vec<S, 2>{{(L(1) / 720 - c[6]) * inv, (L(1) / 5040 - c[7]) * inv}};
      });
}

/// The same for jets. Values are those of S; slopes c_n' = (n c_{n+2} - c_{n+1}) / 2 are computed in S, without series
/// of jets.
template <class S, int N>
lanes::Vec<lanes::Jet<S, N>, 8> eval_stumpff(const lanes::Jet<S, N>& x) {
  using L = Literal<S>;
  const lanes::Vec<S, 8> c = eval_stumpff(x.a);
  const auto small = less(x.a, S(detail::switch_x));
  const lanes::Vec<S, 2> last = choose(
      small,
      [&] {
        const S near = select(small, x.a, S(0.0));
        return lanes::Vec<S, 2>{
            {detail::horner_slope(detail::stumpff_6<L>, near), detail::horner_slope(detail::stumpff_7<L>, near)}};
      },
      [&] {
        const S inv = S(1.0) / select(small, S(detail::switch_x), x.a);
        const S c8 = (L(1) / 720 - c[6]) * inv, c9 = (L(1) / 5040 - c[7]) * inv;
        return lanes::Vec<S, 2>{{L(0.5) * (L(6) * c8 - c[7]), L(0.5) * (L(7) * c9 - c8)}};
      });
  lanes::Vec<lanes::Jet<S, N>, 8> r;
  r[0] = lanes::chain(x, c[0], S(-L(0.5) * c[1]));
  for (int n = 1; n < 6; ++n) r[n] = lanes::chain(x, c[n], S(L(0.5) * (L(n) * c[n + 2] - c[n + 1])));
  for (int n = 6; n < 8; ++n) r[n] = lanes::chain(x, c[n], last[n - 6]);
  return r;
}

/// a, b, c with first (d) and second (dd) derivatives by x = phi^2, from c_n' = (n c_{n+2} - c_{n+1}) / 2, which has no
/// division by x. Once a call is inlined, the compiler removes the members that the caller does not use.
template <class S>
struct AngleCoefficients {
  S a, b, c;        ///< sin(phi)/phi, (1 - cos phi)/phi^2, (phi - sin phi)/phi^3
  S da, db, dc;     ///< d/dx
  S dda, ddb, ddc;  ///< d^2/dx^2
};
template <class S>
AngleCoefficients<S> eval_angle_coefficients(const S& x) {
  using L = Literal<S>;
  const lanes::Vec<S, 8> c = eval_stumpff(x);
  AngleCoefficients<S> r;
  r.a = c[1];
  r.b = c[2];
  r.c = c[3];
  r.da = L(0.5) * (c[3] - c[2]);
  r.db = c[4] - L(0.5) * c[3];
  r.dc = L(0.5) * (L(3) * c[5] - c[4]);
  r.dda = L(0.25) * (c[3] + L(3) * (c[5] - c[4]));
  r.ddb = L(0.25) * (c[4] - L(5) * c[5]) + L(2) * c[6];
  r.ddc = L(0.25) * (c[5] - L(7) * c[6] + L(15) * c[7]);
  return r;
}

/// k = (1 - (phi/2) cot(phi/2))/phi^2 with derivatives up to the third by x = phi^2. phi must not be 2 pi, 4 pi, ...
/// Below phi = 4 they come from the partial fractions of the cotangent, k = sum_m 2/((2 pi m)^2 - x): two poles and a
/// polynomial, all terms positive, no trigonometric function. Below phi = 1/2 the power series is used. Beyond phi = 4
/// they come from y = (phi/2) cot(phi/2) and 2 x y' = y - y^2 - x/4.
template <class S>
struct InverseCoefficients {
  S k, dk, ddk, dddk;
};
template <class S>
InverseCoefficients<S> eval_inverse_coefficients(const S& x) {
  using L = Literal<S>;
  const auto small = less(x, S(detail::switch_x)), close = less(x, S(detail::near_x));
  const lanes::Vec<S, 4> r = choose(
      close,
      [&] {
        const S y = select(close, x, S(0.0));
        return lanes::Vec<S, 4>{
            {detail::horner(detail::near_inverse<L>, y), detail::horner(detail::near_inverse_1<L>, y),
             detail::horner(detail::near_inverse_2<L>, y), detail::horner(detail::near_inverse_3<L>, y)}};
      },
      [&] {
        return choose(
            small,
            [&] {
              constexpr L pole1 = static_cast<L>(39.478417604357434475338L),
                          pole2 = static_cast<L>(157.913670417429737901352L);
              const S near = select(small, x, S(0.0)), a = pole1 - near, b = pole2 - near, inv = S(1.0) / (a * b);
              const S p = b * inv, q = a * inv, pp = p * p, qq = q * q;
              S f(0.0), df(0.0), hf(0.0), tf(0.0);  // rest, its first derivative, half its second, a sixth of its third
              for (std::size_t n = detail::inverse_rest<L>.size(); n-- > 0;) {
                tf = multiply_add(tf, near, hf);
                hf = multiply_add(hf, near, df);
                df = multiply_add(df, near, f);
                f = multiply_add(f, near, S(detail::inverse_rest<L>[n]));
              }
              return lanes::Vec<S, 4>{{f + L(2) * (p + q), df + L(2) * (pp + qq), L(2) * hf + L(4) * (p * pp + q * qq),
                                       L(6) * tf + L(12) * (pp * pp + qq * qq)}};
            },
            [&] {
              using std::cos;
              using std::sin;
              using std::sqrt;
              const S safe = select(small, S(detail::switch_x), x), inv = S(1.0) / safe, half = L(0.5) * sqrt(safe);
              const S y = half * cos(half) / sin(half);
              const S dy = L(0.5) * inv * (y - y * y) - L(0.125);
              const S ddy = -L(0.5) * inv * (dy + L(2) * y * dy + L(0.25));
              const S dddy = -L(0.5) * inv * (L(3) * ddy + L(2) * (dy * dy + y * ddy));
              const S k = (L(1) - y) * inv, dk = -(dy + k) * inv, ddk = -(ddy + L(2) * dk) * inv;
              return lanes::Vec<S, 4>{{k, dk, ddk, -(dddy + L(3) * ddk) * inv}};
            });
      });
  return {r[0], r[1], r[2], r[3]};
}

}  // namespace bough::motion
