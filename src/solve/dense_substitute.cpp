#include <algorithm>
#include <cstddef>
#include <utility>

#include "dense.hpp"
#include "dense_tiles.hpp"

namespace bough::solve {

namespace {

using tiles::add_product;
using tiles::add_some_products;
using tiles::all;
using tiles::Lanes;
using tiles::load;
using tiles::load_some;
using tiles::store;
using tiles::store_some;
using tiles::take_product;
using tiles::width;

constexpr int columns_at_once =
    8;  ///< largest number of columns processed together: a vector is read once, and loads overlap

/// Calls f with C = count as a constant, 1 <= count <= columns_at_once.
template <class F>
void with_count(int count, F&& f) {
  const auto pick = [&]<int... C>(std::integer_sequence<int, C...>) {
    static_cast<void>(((C + 1 == count ? (f(std::integral_constant<int, C + 1>{}), true) : false) || ...));
  };
  pick(std::make_integer_sequence<int, columns_at_once>{});
}

/// f[0, n) -= C columns of a times y.
template <int C>
void take_columns(int n, const double* a, std::ptrdiff_t lda, const double* y, double* f) {
  Lanes factor[C];
  for (int c = 0; c < C; ++c) factor[c] = all(y[c]);
  int i = 0;
  for (; i + width <= n; i += width) {
    Lanes v = load(f + i);
    for (int c = 0; c < C; ++c) v = take_product(load(a + c * lda + i), factor[c], v);
    store(f + i, v);
  }
  if constexpr (width == 8) {
    if (i == n) return;
    Lanes v = load_some(n - i, f + i);
    for (int c = 0; c < C; ++c) v = take_product(load_some(n - i, a + c * lda + i), factor[c], v);
    store_some(n - i, f + i, v);
  } else {
    for (; i < n; ++i)
      for (int c = 0; c < C; ++c) f[i] = take_product(a[c * lda + i], y[c], f[i]);
  }
}

/// f[0, n) -= a y, k columns.
void take_product_with(int n, int k, const double* a, std::ptrdiff_t lda, const double* y, double* f) {
  for (int j = 0; j < k; j += columns_at_once)
    with_count(std::min(columns_at_once, k - j),
               [&](auto count) { take_columns<decltype(count)::value>(n, a + j * lda, lda, y + j, f); });
}

/// Products of C columns with x, each in eight partial sums for any width of the registers. Several columns at once let
/// loads from memory overlap.
template <int C>
void sum_products(int n, const double* a, std::ptrdiff_t lda, const double* x, double* to) {
  constexpr int registers = 8 / width;
  Lanes sum[C][registers] = {};
  int i = 0;
  for (; i + 8 <= n; i += 8)
    for (int r = 0; r < registers; ++r) {
      const Lanes xr = load(x + i + r * width);
      for (int c = 0; c < C; ++c) sum[c][r] = add_product(load(a + c * lda + i + r * width), xr, sum[c][r]);
    }
  for (int r = 0; r < registers && i < n; ++r, i += width)
    for (int c = 0; c < C; ++c) {
      const double* column = a + c * lda + i;
      sum[c][r] = n - i < width ? add_some_products(n - i, column, x + i, sum[c][r])
                                : add_product(load(column), load(x + i), sum[c][r]);
    }
  for (int c = 0; c < C; ++c) to[c] = tiles::sum_of_eight(sum[c]);
}

// Triangles of C rows are processed in registers: in memory every product would wait until the previous one is written
// and read again.

/// f[0, C) <- L^-1 f, L unit lower.
template <int C>
void solve_lower(const double* l, std::ptrdiff_t lda, double* f) {
  double v[C];
  std::copy(f, f + C, v);
#pragma GCC unroll 8
  for (int p = 0; p < C; ++p)
#pragma GCC unroll 8
    for (int i = p + 1; i < C; ++i) v[i] = take_product(l[p * lda + i], v[p], v[i]);
  std::copy(v, v + C, f);
}

/// x[0, C) <- L^-T (x - sum), L unit lower.
template <int C>
void solve_lower_transposed(const double* l, std::ptrdiff_t lda, const double* sum, double* x) {
  double v[C], to[C];
  std::copy(sum, sum + C, v);
#pragma GCC unroll 8
  for (int k = 0; k < C; ++k) {
    const int j = C - 1 - k;
    to[j] = x[j] - v[j];
#pragma GCC unroll 8
    for (int i = 0; i < j; ++i) v[i] = add_product(l[i * lda + j], to[j], v[i]);
  }
  std::copy(to, to + C, x);
}

/// x[0, C) <- U^-1 x
template <int C>
void solve_upper(const double* u, std::ptrdiff_t lda, double* x) {
  double v[C];
  std::copy(x, x + C, v);
#pragma GCC unroll 8
  for (int k = 0; k < C; ++k) {
    const int p = C - 1 - k;
    v[p] /= u[p * lda + p];
#pragma GCC unroll 8
    for (int i = 0; i < p; ++i) v[i] = take_product(u[p * lda + i], v[p], v[i]);
  }
  std::copy(v, v + C, x);
}

/// x[0, k) = L11^-T (x - L21^T x_B), L unit lower, its n rows in the first k columns of a.
void substitute_transposed(int n, int k, const double* a, std::ptrdiff_t lda, double* x) {
  for (int end = k; end > 0;) {
    const int count = (end - 1) % columns_at_once + 1, begin = end - count;
    const double* const first = a + begin * lda;
    with_count(count, [&](auto columns) {
      constexpr int C = decltype(columns)::value;
      double product[C];
      sum_products<C>(n - end, first + end, lda, x + end, product);
      solve_lower_transposed<C>(first + begin, lda, product, x + begin);
    });
    end = begin;
  }
}

}  // namespace

void substitute_forward(const FrontMatrix& front, int pivots, double* f) {
  const FrontParts v(front);
  for (int k = 0; k < pivots; k += columns_at_once) {
    const int end = std::min(k + columns_at_once, pivots);
    const double* l = v.a + k * v.lda;
    with_count(end - k, [&](auto count) {
      constexpr int C = decltype(count)::value;
      solve_lower<C>(l + k, v.lda, f + k);
      take_columns<C>(v.size - end, l + end, v.lda, f + k, f + end);
    });
  }
}

void substitute_backward(const FrontMatrix& front, int pivots, double* x) {
  const FrontParts v(front);
  if (front.d != nullptr) {
    for (int k = 0; k < pivots; ++k) {
      const double* d = front.d + 2 * k;
      if (d[1] == 0.0) {
        x[k] /= d[0];
        continue;
      }
      const double ratio = d[0] / d[1], other = d[2] / d[1], scale = 1.0 / (d[1] * (ratio * other - 1.0));
      const double first = x[k], second = x[k + 1];  // D^-1 of two rows, divided by its off-diagonal entry
      x[k] = (other * first - second) * scale;
      x[k + 1] = (ratio * second - first) * scale;
      ++k;
    }
    substitute_transposed(v.size, pivots, v.a, v.lda, x);
    return;
  }
  take_product_with(pivots, v.size - v.full, v.u, v.ldu, x + v.full, x);
  take_product_with(pivots, v.full - pivots, v.a + pivots * v.lda, v.lda, x + pivots, x);
  int k = pivots;
  while (k > 0) {
    const int begin = std::max(0, k - columns_at_once);
    const double* u = v.a + begin * v.lda;
    with_count(k - begin, [&](auto count) {
      constexpr int C = decltype(count)::value;
      solve_upper<C>(u + begin, v.lda, x + begin);
      take_columns<C>(begin, u, v.lda, x + begin, x);
    });
    k = begin;
  }
}

void substitute_backward_left(const FrontMatrix& front, int pivots, double* z) {
  const FrontParts v(front);
  std::fill_n(z, pivots, 0.0);
  substitute_transposed(v.size, pivots, v.a, v.lda, z);
}

}  // namespace bough::solve
