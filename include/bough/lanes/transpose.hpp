#pragma once
/// Conversion between W plain arrays and one array of packs, entry by entry: lane l of to[i] = from[l][i], and back.
/// Registers of eight or four doubles are transposed as square blocks, because writing single lanes and then reading
/// the whole register stalls the processor.
#include <cstddef>
#include <utility>

#include "bough/lanes/pack.hpp"

namespace bough::lanes {
inline namespace BOUGH_REGISTER_NAMESPACE {

namespace detail {
/// Transposes N registers of N doubles: rows[i][j] <-> rows[j][i].
template <class Real, int N>
void transpose_square(Real (&r)[N]) {
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j) {
      const double below = r[i][j];
      r[i][j] = r[j][i];
      r[j][i] = below;
    }
}
#if BOUGH_REGISTER_DOUBLES >= 4
using Real4 = Register<4>::Real;
inline void transpose_square(Real4 (&r)[4]) {
  const Real4 a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6), b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Real4 c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6), d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}
#endif
#if BOUGH_REGISTER_DOUBLES >= 8
using Real8 = Register<8>::Real;
/// Interleaves pairs of rows, then exchanges the 4 x 4 blocks of pairs.
inline void transpose_square(Real8 (&r)[8]) {
  Real8 even[4], odd[4];
  for (int k = 0; k < 4; ++k) {
    even[k] = __builtin_shufflevector(r[2 * k], r[2 * k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    odd[k] = __builtin_shufflevector(r[2 * k], r[2 * k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  const auto spread = [&r](const Real8(&p)[4], int first) {
    const Real8 a = __builtin_shufflevector(p[0], p[1], 0, 1, 4, 5, 8, 9, 12, 13);
    const Real8 b = __builtin_shufflevector(p[2], p[3], 0, 1, 4, 5, 8, 9, 12, 13);
    const Real8 c = __builtin_shufflevector(p[0], p[1], 2, 3, 6, 7, 10, 11, 14, 15);
    const Real8 d = __builtin_shufflevector(p[2], p[3], 2, 3, 6, 7, 10, 11, 14, 15);
    r[first] = __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13);
    r[first + 4] = __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15);
    r[first + 2] = __builtin_shufflevector(c, d, 0, 1, 4, 5, 8, 9, 12, 13);
    r[first + 6] = __builtin_shufflevector(c, d, 2, 3, 6, 7, 10, 11, 14, 15);
  };
  spread(even, 0);
  spread(odd, 1);
}
#endif

/// A register at any address. memcpy is not used, since compilers split it into narrower moves, and loading a register
/// that two narrower stores have just written stalls the processor.
template <int N>
struct Anywhere {
  typedef double Real __attribute__((vector_size(8 * N), aligned(8), may_alias));
};

#if BOUGH_REGISTER_DOUBLES >= 4
/// Loads the first `count` of four doubles, 1 <= count <= 4; the memory behind them is not read.
inline Real4 load_some(const double* from, int count) {
  if (count == 4) return *reinterpret_cast<const Anywhere<4>::Real*>(from);
  static constexpr long long wanted[8] = {-1, -1, -1, -1, 0, 0, 0, 0};
  const __m256i mask = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(wanted + 4 - count));
  return Real4(_mm256_maskload_pd(from, mask));
}
/// Stores the first `count` of four doubles, 1 <= count <= 4. Narrow stores are faster than one under a mask.
inline void store_some(double* to, const Real4& x, int count) {
  if (count == 4) {
    *reinterpret_cast<Anywhere<4>::Real*>(to) = x;
    return;
  }
  if (count >= 2) _mm_storeu_pd(to, _mm256_castpd256_pd128(__m256d(x)));
  if (count != 2) to[count - 1] = x[count - 1];
}

/// Works through the array in squares of four. If the count is no multiple of four, the last square overlaps the one
/// before.
template <int W>
void gather_by_fours(const double* const (&from)[W], int count, Pack<W>* to) {
  constexpr int groups = W / 4;
  for (int at = 0; at < count; at += 4) {
    const int some = count < 4 ? count : 4, i = at + some <= count ? at : count - some;
    Real4 square[groups][4];
    BOUGH_UNROLL
    for (int g = 0; g < groups; ++g) {
      BOUGH_UNROLL
      for (int l = 0; l < 4; ++l) square[g][l] = load_some(from[4 * g + l] + i, some);
      transpose_square(square[g]);
    }
    for (int k = 0; k < some; ++k)
      for (int c = 0; c < Pack<W>::chunks; ++c) to[i + k].r[c] = square[c][k];
  }
}
template <int W>
void scatter_by_fours(const Pack<W>* from, int count, double* const (&to)[W]) {
  using Loose = typename Anywhere<4>::Real;
  constexpr int groups = W / 4;
  for (int at = 0; at < count; at += 4) {
    const int i = at + 4 <= count ? at : count - 4;
    BOUGH_UNROLL
    for (int g = 0; g < groups; ++g) {
      Real4 square[4];
      BOUGH_UNROLL
      for (int k = 0; k < 4; ++k) square[k] = from[i + k].r[g];
      transpose_square(square);
      BOUGH_UNROLL
      for (int l = 0; l < 4; ++l) *reinterpret_cast<Loose*>(to[4 * g + l] + i) = square[l];
    }
  }
}
#endif
#if BOUGH_REGISTER_DOUBLES >= 8
/// Loads or stores the first `count` of eight doubles, the others being 0; the memory behind them is neither read nor
/// written.
inline Real8 load_eight(const double* from, int count) {
  if (count == 8) return *reinterpret_cast<const Anywhere<8>::Real*>(from);
  return Real8(_mm512_maskz_loadu_pd(static_cast<__mmask8>((1 << count) - 1), from));
}
inline void store_eight(double* to, const Real8& x, int count) {
  if (count == 8)
    *reinterpret_cast<Anywhere<8>::Real*>(to) = x;
  else
    _mm512_mask_storeu_pd(to, static_cast<__mmask8>((1 << count) - 1), __m512d(x));
}

/// Two rows of four numbers in one register, and back.
BOUGH_INLINE Real8 join_halves(const Real4& low, const Real4& high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
BOUGH_INLINE void store_halves(double* low, double* high, const Real8& x, int count) {
  store_some(low, __builtin_shufflevector(x, x, 0, 1, 2, 3), count);
  store_some(high, __builtin_shufflevector(x, x, 4, 5, 6, 7), count);
}

/// Up to four numbers of each of eight lanes, beginning with number i: half the work of a square of eight. Rows are
/// paired such that the lanes come out in their order.
template <class Row>
BOUGH_INLINE void gather_half_square(const Row& row, int i, int count, Real8 (&to)[4]) {
  Real8 even[2], odd[2];
  BOUGH_UNROLL
  for (int k = 0; k < 2; ++k) {
    const auto load = [&](int l) { return load_some(row(4 * k + l) + i, count); };
    const Real8 a = join_halves(load(0), load(2)), b = join_halves(load(1), load(3));
    even[k] = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    odd[k] = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  to[0] = __builtin_shufflevector(even[0], even[1], 0, 1, 4, 5, 8, 9, 12, 13);
  to[1] = __builtin_shufflevector(odd[0], odd[1], 0, 1, 4, 5, 8, 9, 12, 13);
  to[2] = __builtin_shufflevector(even[0], even[1], 2, 3, 6, 7, 10, 11, 14, 15);
  to[3] = __builtin_shufflevector(odd[0], odd[1], 2, 3, 6, 7, 10, 11, 14, 15);
}
template <class Row>
BOUGH_INLINE void scatter_half_square(const Real8 (&from)[4], int i, int count, const Row& row) {
  const Real8 even[] = {__builtin_shufflevector(from[0], from[1], 0, 8, 2, 10, 4, 12, 6, 14),
                        __builtin_shufflevector(from[2], from[3], 0, 8, 2, 10, 4, 12, 6, 14)},
              odd[] = {__builtin_shufflevector(from[0], from[1], 1, 9, 3, 11, 5, 13, 7, 15),
                       __builtin_shufflevector(from[2], from[3], 1, 9, 3, 11, 5, 13, 7, 15)};
  const auto store = [&](const Real8(&p)[2], int l) {
    store_halves(row(l) + i, row(l + 2) + i, __builtin_shufflevector(p[0], p[1], 0, 1, 8, 9, 2, 3, 10, 11), count);
    store_halves(row(l + 4) + i, row(l + 6) + i, __builtin_shufflevector(p[0], p[1], 4, 5, 12, 13, 6, 7, 14, 15),
                 count);
  };
  store(even, 0);
  store(odd, 1);
}

/// Works through the array in squares of eight, and in half a square where at most four numbers remain; row(l) is the
/// address of the numbers of lane l. If the count is no multiple of eight, the last square overlaps the one before.
template <int W, class Row>
BOUGH_INLINE void gather_by_eights(const Row& row, int count, Pack<W>* to) {
  BOUGH_UNROLL
  for (int at = 0; at < count; at += 8)
    for (int c = 0; c < Pack<W>::chunks; ++c) {
      const auto row_of_chunk = [&](int l) { return row(c * 8 + l); };
      if (count - at <= 4) {
        const int some = count < 4 ? count : 4, i = count - some;
        Real8 half[4];
        gather_half_square(row_of_chunk, i, some, half);
        BOUGH_UNROLL
        for (int k = 0; k < 4; ++k)
          if (k < some) to[i + k].r[c] = half[k];
        continue;
      }
      const int some = count < 8 ? count : 8, i = at + some <= count ? at : count - some;
      Real8 square[8];
      BOUGH_UNROLL
      for (int l = 0; l < 8; ++l) square[l] = load_eight(row_of_chunk(l) + i, some);
      transpose_square(square);
      BOUGH_UNROLL
      for (int k = 0; k < 8; ++k)
        if (k < some) to[i + k].r[c] = square[k];
    }
}
template <int W, class Row>
BOUGH_INLINE void scatter_by_eights(const Pack<W>* from, int count, const Row& row) {
  BOUGH_UNROLL
  for (int at = 0; at < count; at += 8)
    for (int c = 0; c < Pack<W>::chunks; ++c) {
      const auto row_of_chunk = [&](int l) { return row(c * 8 + l); };
      if (count - at <= 4) {
        const int some = count < 4 ? count : 4, i = count - some;
        Real8 half[4];
        BOUGH_UNROLL
        for (int k = 0; k < 4; ++k) half[k] = k < some ? from[i + k].r[c] : Real8{};
        scatter_half_square(half, i, some, row_of_chunk);
        continue;
      }
      const int some = count < 8 ? count : 8, i = at + some <= count ? at : count - some;
      Real8 square[8];
      BOUGH_UNROLL
      for (int k = 0; k < 8; ++k) square[k] = k < some ? from[i + k].r[c] : Real8{};
      transpose_square(square);
      BOUGH_UNROLL
      for (int l = 0; l < 8; ++l) store_eight(row_of_chunk(l) + i, square[l], some);
    }
}
#endif
}  // namespace detail

/// Lane l of to[i] <- from[l][i] for i < count.
template <int W>
BOUGH_INLINE void gather_lanes(const double* const (&from)[W], int count, Pack<W>* to) {
#if BOUGH_REGISTER_DOUBLES >= 8
  if constexpr (Pack<W>::chunk == 8) return detail::gather_by_eights<W>([&from](int l) { return from[l]; }, count, to);
#endif
#if BOUGH_REGISTER_DOUBLES >= 4
  if constexpr (Pack<W>::chunk == 4) return detail::gather_by_fours(from, count, to);
#endif
  for (int i = 0; i < count; ++i)
    for (int l = 0; l < W; ++l) to[i].set(l, from[l][i]);
}

/// to[l][i] <- lane l of from[i] for i < count; the arrays must not overlap.
template <int W>
BOUGH_INLINE void scatter_lanes(const Pack<W>* from, int count, double* const (&to)[W]) {
#if BOUGH_REGISTER_DOUBLES >= 8
  if constexpr (Pack<W>::chunk == 8) return detail::scatter_by_eights<W>(from, count, [&to](int l) { return to[l]; });
#endif
#if BOUGH_REGISTER_DOUBLES >= 4
  if constexpr (Pack<W>::chunk == 4)
    if (count >= 4) return detail::scatter_by_fours(from, count, to);
#endif
  for (int i = 0; i < count; ++i)
    for (int l = 0; l < W; ++l) to[l][i] = from[i][l];
}

/// As above for arrays `stride` numbers apart, with all counts known at compile time.
template <int count, int stride, int W>
void gather_rows(const double* from, Pack<W>* to) {
#if BOUGH_REGISTER_DOUBLES >= 8
  if constexpr (Pack<W>::chunk == 8)
    return detail::gather_by_eights<W>([from](int l) { return from + l * stride; }, count, to);
#endif
  const double* rows[W];
  for (int l = 0; l < W; ++l) rows[l] = from + l * stride;
  gather_lanes(rows, count, to);
}
template <int count, int stride, int W>
void scatter_rows(const Pack<W>* from, double* to) {
#if BOUGH_REGISTER_DOUBLES >= 8
  if constexpr (Pack<W>::chunk == 8)
    return detail::scatter_by_eights<W>(from, count, [to](int l) { return to + l * stride; });
#endif
  double* rows[W];
  for (int l = 0; l < W; ++l) rows[l] = to + l * stride;
  scatter_lanes(from, count, rows);
}

namespace detail {
template <int W, class Place, std::size_t... I>
Pack<W> load_lanes(const double* from, const Place* at, std::index_sequence<I...>) {
  Pack<W> p;
  for (int c = 0; c < Pack<W>::chunks; ++c)
    p.r[c] = typename Pack<W>::Real{from[at[c * Pack<W>::chunk + static_cast<int>(I)]]...};
  return p;
}
}  // namespace detail
/// Lane l <- from[at[l]], without writing single lanes to memory first.
template <int W, class Place>
Pack<W> load_lanes(const double* from, const Place* at) {
  return detail::load_lanes<W>(from, at, std::make_index_sequence<static_cast<std::size_t>(Pack<W>::chunk)>());
}

}  // namespace BOUGH_REGISTER_NAMESPACE
}  // namespace bough::lanes
