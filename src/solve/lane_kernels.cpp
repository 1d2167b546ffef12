#include "lane_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "element_store.hpp"
#include "lane_registers.hpp"

namespace bough::solve {

namespace {

using namespace packs;

/// U = L^-1 of C columns, the K x K triangle of L at `l`, unit.
template <int K, int C>
inline void update_head(const double* l, std::ptrdiff_t ld, double* head, std::ptrdiff_t step) {
  Lanes u[C][K];
#pragma GCC unroll 8
  for (int j = 0; j < C; ++j)
#pragma GCC unroll 8
    for (int i = 0; i < K; ++i) u[j][i] = load(head + j * step + i * wide);
#pragma GCC unroll 8
  for (int p = 0; p + 1 < K; ++p)
#pragma GCC unroll 8
    for (int i = p + 1; i < K; ++i) {
      const Lanes factor = load(l + p * ld + i * wide);
#pragma GCC unroll 8
      for (int j = 0; j < C; ++j) u[j][i] = take_product(factor, u[j][p], u[j][i]);
    }
#pragma GCC unroll 8
  for (int j = 0; j < C; ++j)
#pragma GCC unroll 8
    for (int i = 1; i < K; ++i) store(head + j * step + i * wide, u[j][i]);
}

/// Updates columns [column, column + C) of the left part by the K pivots from k0 on.
template <int K, int C>
inline void update_left(const Front& f, int k0, int column) {
  const std::ptrdiff_t ld = f.ld();
  const int k1 = k0 + K;
  double* head = f.left + column * ld;
  update_head<K, C>(f.left + k0 * (ld + wide), ld, head + k0 * wide, ld);
  subtract_columns<C>(f.n - k1, K, f.left + k0 * ld + k1 * wide, ld, head + k0 * wide, ld, head + k1 * wide, ld);
}

/// The same of U12 and the Schur complement.
template <int K, int C>
inline void update_right(const Front& f, int k0, int column) {
  const int b = f.n - f.e, k1 = k0 + K;
  const std::ptrdiff_t ld = f.ld(), step = static_cast<std::ptrdiff_t>(f.e) * wide;
  double* head = f.upper + column * step;
  update_head<K, C>(f.left + k0 * (ld + wide), ld, head + k0 * wide, step);
  subtract_columns<C>(f.e - k1, K, f.left + k0 * ld + k1 * wide, ld, head + k0 * wide, step, head + k1 * wide, step);
  const std::ptrdiff_t tail = static_cast<std::ptrdiff_t>(b) * wide;
  subtract_columns<C>(b, K, f.left + k0 * ld + f.e * wide, ld, head + k0 * wide, step, f.schur + column * tail, tail);
}

/// One register of lanes.
unsigned eliminate_register(const Front& f, const double* row_scale, const double* inverse_column_scale,
                            const PivotRule& rule, Transfers& beside) {
  unsigned failed = 0;
  for (int k0 = 0; k0 < f.e;) {
    const int k = std::min(panel_width, f.e - k0);
    with_size(k, [&](auto size) {
      constexpr int pivots = decltype(size)::value;
      failed |=
          eliminate_panel<pivots, Symmetry::general>(f, k0, row_scale, inverse_column_scale, rule, nullptr, beside);
      for_columns(k0 + pivots, f.e, [&](int j, auto c) {
        beside.step();
        update_left<pivots, decltype(c)::value>(f, k0, j);
      });
      for_columns(0, f.n - f.e, [&](int j, auto c) {
        beside.step();
        update_right<pivots, decltype(c)::value>(f, k0, j);
      });
    });
    k0 += k;
  }
  return failed;
}

}  // namespace

LaneSet eliminate_lanes(double* factor, double* schur, int n, int e, const double* row_scale,
                        const double* inverse_column_scale, const PivotRule& rule, Transfers& beside) {
  unsigned failed = 0;
  for (int l = 0; l < wide; l += width)
    failed |= eliminate_register(register_of(factor, schur, n, e, l, Symmetry::general), row_scale + l,
                                 inverse_column_scale + l, rule, beside)
              << l;
  return static_cast<LaneSet>(failed);
}

int elimination_steps(int n, int e) {
  int steps = 0;
  const auto count = [&](int, auto) { ++steps; };
  for (int k0 = 0; k0 < e; k0 += panel_width) {
    const int k1 = std::min(k0 + panel_width, e);
    for_columns(k1, n, count);  // rows below the panel
    for_columns(k1, e, count);
    for_columns(e, n, count);
  }
  return steps * (wide / width);
}

void neutralise_lanes(double* factor, double* schur, int n, int e, LaneSet lanes, Symmetry symmetry) {
  for (int l = 0; l < wide; l += width)
    neutralise(register_of(factor, schur, n, e, l, symmetry), static_cast<unsigned>(lanes) >> l);
}

namespace {

/// y_k -= sum_{p<k} l_kp y_p for K rows.
template <int K>
inline void forward_triangle(const double* l, std::ptrdiff_t ld, double* v) {
  Lanes y[K];
  for (int k = 0; k < K; ++k) y[k] = load(v + k * wide);
  for (int k = 0; k < K; ++k)
    for (int i = k + 1; i < K; ++i) y[i] = take_product(load(l + k * ld + i * wide), y[k], y[i]);
  for (int k = 1; k < K; ++k) store(v + k * wide, y[k]);
}

template <int K>
inline void backward_triangle(const double* u, std::ptrdiff_t ld, double* v) {
  Lanes x[K];
  for (int k = 0; k < K; ++k) x[k] = load(v + k * wide);
  for (int k = K - 1; k >= 0; --k) {
    x[k] *= load(u + k * ld + k * wide);
    for (int i = 0; i < k; ++i) x[i] = take_product(load(u + k * ld + i * wide), x[k], x[i]);
  }
  for (int k = 0; k < K; ++k) store(v + k * wide, x[k]);
}

}  // namespace

void forward_lanes(const double* factor, int n, int e, double* v) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int l = 0; l < wide; l += width)
    for (int k0 = 0; k0 < e;) {
      const int k = std::min(6, e - k0);
      const double* block = factor + k0 * ld + k0 * wide + l;
      with_size(k, [&](auto size) { forward_triangle<decltype(size)::value>(block, ld, v + k0 * wide + l); });
      k0 += k;
      accumulate_rows<false>(n - k0, block + k * wide, wide, ld, k, v + (k0 - k) * wide + l, v + k0 * wide + l);
    }
}

void backward_lanes(const double* factor, int n, int e, double* v) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int l = 0; l < wide; l += width) {
    accumulate_rows<false>(e, factor + e * ld + l, wide, static_cast<std::ptrdiff_t>(e) * wide, n - e, v + e * wide + l,
                           v + l);
    for (int k0 = (e + 5) / 6 * 6 - 6, k = e - k0; k0 >= 0; k0 -= 6, k = 6) {
      with_size(k, [&](auto size) {
        backward_triangle<decltype(size)::value>(factor + k0 * ld + k0 * wide + l, ld, v + k0 * wide + l);
      });
      accumulate_rows<false>(k0, factor + k0 * ld + l, wide, ld, k, v + k0 * wide + l, v + l);
    }
  }
}

void backward_left_lanes(const double* factor, int n, int e, double* v) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int l = 0; l < wide; l += width)
    for (int k = e - 1; k >= 0; --k) {
      Lanes sum = {};
      for (int i = k + 1; i < n; ++i)
        sum = take_product(load(factor + k * ld + i * wide + l), load(v + i * wide + l), sum);
      store(v + k * wide + l, sum);
    }
}

namespace {

/// Writes or adds N packs, one after the other, to targets that are `step` doubles apart.
template <int N, bool is_first>
inline void move_packs(const double* from, double* to, std::ptrdiff_t step) {
  for (int l = 0; l < wide; l += width) {
    Lanes pack[N];
#pragma GCC unroll 8
    for (int i = 0; i < N; ++i) {
      pack[i] = load(from + i * wide + l);
      if constexpr (!is_first) pack[i] += load(to + i * step + l);
    }
#pragma GCC unroll 8
    for (int i = 0; i < N; ++i) store(to + i * step + l, pack[i]);
  }
}

template <bool is_first>
inline void move_run(const double* from, int count, double* to, std::ptrdiff_t step) {
  for (; count >= 6; count -= 6, from += 6 * wide, to += 6 * step) move_packs<6, is_first>(from, to, step);
  if (count > 0) with_size(count, [&](auto n) { move_packs<decltype(n)::value, is_first>(from, to, step); });
}

/// Lanes of a pack in the order of another one: lane from_lane[l] goes to lane l, or zero if that is negative.
class LaneChoice {
 public:
  explicit LaneChoice(const std::int8_t* from_lane) {
    for (int l = 0; l < wide; ++l) {
      from_[l] = from_lane[l] < 0 ? 0 : from_lane[l];
      if (from_lane[l] >= 0) taken_ |= 1u << l;
    }
  }
  template <bool is_first>
  void move(const double* from, int count, double* to) const {
#if defined(__AVX512F__)
    const __m512i order = _mm512_loadu_si512(from_);
    const auto mask = static_cast<__mmask8>(taken_);
    for (int i = 0; i < count; ++i) {
      const __m512d moved = _mm512_maskz_permutexvar_pd(mask, order, _mm512_loadu_pd(from + i * wide));
      _mm512_storeu_pd(to + i * wide, is_first ? moved : _mm512_add_pd(_mm512_loadu_pd(to + i * wide), moved));
    }
#else
    for (int i = 0; i < count; ++i)
      for (int l = 0; l < wide; ++l) {
        const double moved = (taken_ >> l & 1u) != 0 ? from[i * wide + from_[l]] : 0.0;
        to[i * wide + l] = is_first ? moved : to[i * wide + l] + moved;
      }
#endif
  }

 private:
  long long from_[wide];
  unsigned taken_ = 0;
};

}  // namespace

void move_block(const Source& source, const Move& move, const Target& target) {
  if (source.from_lane != nullptr) {
    const LaneChoice choice(source.from_lane);
    for (int j = 0; j < move.columns; ++j) {
      const int above = move.is_triangle ? j : 0;
      const double* from = source.first + (j * source.column_step + above) * wide;
      double* to = target.first + j * target.step + above * wide;
      if (move.is_first)
        choice.move<true>(from, move.rows - above, to);
      else
        choice.move<false>(from, move.rows - above, to);
    }
    return;
  }
  // The source is read in its order in memory; the few lines of the target stay in the nearest cache.
  const bool by_row = source.column_step == 1;
  const int outer = by_row ? move.rows : move.columns, inner = by_row ? move.columns : move.rows;
  const std::ptrdiff_t from_step = (by_row ? source.row_step : source.column_step) * wide;
  const std::ptrdiff_t to_step = by_row ? wide : target.step, to_inner = by_row ? target.step : wide;
  for (int j = 0; j < outer; ++j) {
    const int begin = move.is_triangle && !by_row ? j : 0, end = move.is_triangle && by_row ? j + 1 : inner;
    const double* from = source.first + j * from_step + begin * wide;
    double* to = target.first + j * to_step + begin * to_inner;
    if (move.is_first)
      move_run<true>(from, end - begin, to, to_inner);
    else
      move_run<false>(from, end - begin, to, to_inner);
  }
}

void multiply_block_lanes(const double* element, int stride, int p, int q, const double* x, double* y) {
  for (int l = 0; l < wide; l += width)
    accumulate_rows<true>(p, element + l, static_cast<std::ptrdiff_t>(stride) * wide, wide, q, x + l, y + l);
}

namespace {

/// Whether every entry has the bits of its mirror image, in all lanes.
bool is_its_transpose(const double* element, int size) {
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(size) * wide;
  Flag different = {};
  for (int l = 0; l < wide; l += width)
    for (int i = 1; i < size; ++i) {
      const double *row = element + i * step + l, *column = element + i * wide + l;
      for (int j = 0; j < i; ++j) different |= bits_of(load(row + j * wide)) ^ bits_of(load(column + j * step));
    }
  long long any = 0;
  for (int l = 0; l < width; ++l) any |= different[l];
  return any == 0;
}

}  // namespace

double largest_asymmetry_lanes(const double* element, int size, std::span<const Run> blocks, const double* row_scale) {
  if (is_its_transpose(element, size)) return 0.0;
  double largest = 0.0;
  for (int l = 0; l < wide; l += width) {
    Lanes most = {};
    for (const Run& rows : blocks)
      for (int r = rows.to, i = rows.from; r < rows.to + rows.length; ++r, ++i) {
        const double* row = element + static_cast<std::ptrdiff_t>(i) * size * wide + l;
        const double* column = element + static_cast<std::ptrdiff_t>(i) * wide + l;
        const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(size) * wide;
        Lanes of_row = {};
        for (const Run& columns : blocks)
          for (int c = columns.to, j = columns.from; c < columns.to + columns.length && j < i; ++c, ++j)
            of_row = greater_of(
                of_row, magnitude((load(row + j * wide) - load(column + j * step)) * load(row_scale + c * wide + l)));
        most = greater_of(most, of_row * load(row_scale + r * wide + l));
      }
    for (int k = 0; k < width; ++k) {
      if (!std::isfinite(most[k])) return most[k];
      largest = std::max(largest, most[k]);
    }
  }
  return largest;
}

double largest_scaled(const double* v, const double* scale, int count) {
  Lanes most = {};
  for (int i = 0; i < count * wide; i += width) most = greater_of(most, magnitude(load(v + i) * load(scale + i)));
  double largest = 0.0;
  for (int l = 0; l < width; ++l) largest = larger(largest, most[l]);
  return largest;
}

void prefetch_packs(const double* packs, int count) {
  for (int i = 0; i < count * wide; i += 8) __builtin_prefetch(packs + i, 0, 2);
}

void add_packs(const double* from, int count, double* to) {
  for (int i = 0; i < count * wide; i += width) store(to + i, load(to + i) + load(from + i));
}

void add_packs(const double* from, int count, double* to, const std::int8_t* from_lane) {
  LaneChoice(from_lane).move<false>(from, count, to);
}

}  // namespace bough::solve
