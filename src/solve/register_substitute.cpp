/// Substitutions with one small front.
#include <algorithm>
#include <utility>

#include "dense_tiles.hpp"
#include "register_kernels.hpp"

namespace bough::solve {

namespace {

constexpr int eight = row_register;

template <class F>
inline void with_pivots(int count, F&& f) {
  const auto pick = [&]<int... K>(std::integer_sequence<int, K...>) {
    static_cast<void>(((K + 1 == count ? (f(std::integral_constant<int, K + 1>{}), true) : false) || ...));
  };
  pick(std::make_integer_sequence<int, eight>{});
}

}  // namespace

void forward_in_registers(const double* factor, int n, int e, bool is_symmetric, double* t) {
  using tiles::take_product;
  if (is_symmetric) {
    for (int k = 0; k < e; ++k) {
      const double* row = factor + static_cast<std::ptrdiff_t>(k) * n;
      const double y = t[k];
      for (int j = k + 1; j < n; ++j) t[j] = take_product(row[j], y, t[j]);
      t[k] = y * row[k];
    }
    return;
  }
  const double* lower = factor + static_cast<std::ptrdiff_t>(e) * n;
  for (int k0 = 0; k0 < e; k0 += eight)
    with_pivots(std::min(eight, e - k0), [&](auto count) {
      constexpr int K = decltype(count)::value;
      double z[K];
#pragma GCC unroll 8
      for (int i = 0; i < K; ++i) {
        const double* row = factor + static_cast<std::ptrdiff_t>(k0 + i) * n + k0;
        double sum = t[k0 + i];
#pragma GCC unroll 8
        for (int k = 0; k < i; ++k) sum = take_product(row[k], z[k], sum);
        z[i] = sum * row[i];
      }
      std::copy(z, z + K, t + k0);
      for (int i = k0 + K; i < n; ++i) {
        const double* row = i < e ? factor + static_cast<std::ptrdiff_t>(i) * n + k0
                                  : lower + static_cast<std::ptrdiff_t>(i - e) * e + k0;
        double sum = t[i];
#pragma GCC unroll 8
        for (int k = 0; k < K; ++k) sum = take_product(row[k], z[k], sum);
        t[i] = sum;
      }
    });
}

namespace {

/// x[0, K) = U11^-1 (z - U12 x_behind), K rows of U from their first pivot on: `count` unknowns behind them.
template <int K>
inline void backward_panel(const double* rows, std::ptrdiff_t ld, int count, const double* z, const double* behind,
                           double* x) {
  using tiles::take_product;
  double sum[K];
  const double* row[K];
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) {
    sum[k] = z[k];
    row[k] = rows + k * ld;
  }
  for (int j = 0; j < count; ++j) {
    const double xj = behind[j];
#pragma GCC unroll 8
    for (int k = 0; k < K; ++k) sum[k] = take_product(row[k][K + j], xj, sum[k]);
  }
#pragma GCC unroll 8
  for (int i = 0; i < K; ++i) {
    const int k = K - 1 - i;
#pragma GCC unroll 8
    for (int j = 0; j < k; ++j) sum[j] = take_product(row[j][k], sum[k], sum[j]);
  }
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) x[k] = sum[k];
}

}  // namespace

void backward_in_registers(const double* factor, int n, int e, const double* z, const double* boundary, double* x) {
  if (e <= eight) {
    with_pivots(e, [&](auto count) {
      constexpr int K = decltype(count)::value;
      backward_panel<K>(factor, n, n - K, z, boundary, x);
    });
    return;
  }
  double all[largest_in_registers];
  for (int i = e; i < n; ++i) all[i] = boundary[i - e];
  for (int k0 = (e - 1) / eight * eight; k0 >= 0; k0 -= eight)
    with_pivots(std::min(eight, e - k0), [&](auto count) {
      constexpr int K = decltype(count)::value;
      backward_panel<K>(factor + k0 * (n + 1), n, n - k0 - K, z + k0, all + k0 + K, all + k0);
    });
  for (int k = 0; k < e; ++k) x[k] = all[k];
}

void backward_left_in_registers(const double* factor, int n, int e, bool is_symmetric, double* y) {
  if (is_symmetric) {  // L11^-T: unit upper, the rows of U
    std::fill_n(y, e, 0.0);
    for (int k = e; k-- > 0;)
      for (int j = k + 1; j < n; ++j) y[k] -= factor[static_cast<std::ptrdiff_t>(k) * n + j] * y[j];
    return;
  }
  const double* lower = factor + static_cast<std::ptrdiff_t>(e) * n;
  for (int k = e; k-- > 0;) {
    double sum = 0.0;
    for (int i = k + 1; i < e; ++i) sum -= factor[static_cast<std::ptrdiff_t>(i) * n + k] * y[i];
    for (int i = e; i < n; ++i) sum -= lower[static_cast<std::ptrdiff_t>(i - e) * e + k] * y[i];
    y[k] = sum * factor[static_cast<std::ptrdiff_t>(k) * n + k];
  }
}

}  // namespace bough::solve
