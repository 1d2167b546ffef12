#include <algorithm>
#include <cstddef>

#include "lane_kernels.hpp"
#include "lane_registers.hpp"

namespace bough::solve {

namespace {

using namespace packs;

/// c(C x C) -= a(C x k) b(k x C) on and below the diagonal; entries above are not changed.
template <int C>
inline void subtract_corner(int k, const double* a, std::ptrdiff_t la, const double* b, std::ptrdiff_t lb, double* c,
                            std::ptrdiff_t lc) {
  Lanes sum[C][C];
  for (int j = 0; j < C; ++j)
    for (int i = j; i < C; ++i) sum[j][i] = load(c + j * lc + i * wide);
  for (int p = 0; p < k; ++p) {
    Lanes l[C];
    for (int i = 0; i < C; ++i) l[i] = load(a + p * la + i * wide);
    for (int j = 0; j < C; ++j) {
      const Lanes u = load(b + p * wide + j * lb);
      for (int i = j; i < C; ++i) sum[j][i] = take_product(l[i], u, sum[j][i]);
    }
  }
  for (int j = 0; j < C; ++j)
    for (int i = j; i < C; ++i) store(c + j * lc + i * wide, sum[j][i]);
}

/// Updates columns [column, column + C) of the front, from the diagonal down, by the K pivots from k0 on. products: L D
/// of the rows below them.
template <int K, int C>
inline void update(const Front& f, int k0, int column, const double* products) {
  const std::ptrdiff_t ld = f.ld(), of_row = static_cast<std::ptrdiff_t>(panel_width) * wide;
  const bool is_own = column < f.e;
  const std::ptrdiff_t step = is_own ? ld : static_cast<std::ptrdiff_t>(f.n - f.e) * wide;
  double* target = is_own ? f.left + column * ld + column * wide : f.schur + (column - f.e) * (step + wide);
  const double* l = f.left + k0 * ld + column * wide;
  const double* u = products + (column - k0 - K) * of_row;
  subtract_corner<C>(K, l, ld, u, of_row, target, step);
  subtract_columns<C>(f.n - column - C, K, l + C * wide, ld, u, of_row, target + C * wide, step);
}

/// One register of lanes.
unsigned eliminate_symmetric_register(const Front& f, const double* scale, const double* inverse_scale,
                                      const PivotRule& rule, Transfers& beside) {
  alignas(64) double products[most_lane_rows * panel_width * wide];
  unsigned failed = 0;
  for (int k0 = 0; k0 < f.e;) {
    const int k1 = std::min(k0 + panel_width, f.e);
    with_size(k1 - k0, [&](auto size) {
      constexpr int pivots = decltype(size)::value;
      failed |= eliminate_panel<pivots, Symmetry::symmetric>(f, k0, scale, inverse_scale, rule, products, beside);
      const auto catch_up = [&](int j, auto c) {
        beside.step();
        update<pivots, decltype(c)::value>(f, k0, j, products);
      };
      for_columns(k1, f.e, catch_up);
      for_columns(f.e, f.n, catch_up);
    });
    k0 = k1;
  }
  return failed;
}

/// y = L^-T y for K rows, L unit.
template <int K>
inline void backward_symmetric_triangle(const double* l, std::ptrdiff_t ld, double* v) {
  Lanes x[K];
  for (int k = 0; k < K; ++k) x[k] = load(v + k * wide);
  for (int k = K - 1; k >= 0; --k)
    for (int i = 0; i < k; ++i) x[i] = take_product(load(l + i * ld + k * wide), x[k], x[i]);
  for (int k = 0; k + 1 < K; ++k) store(v + k * wide, x[k]);
}

}  // namespace

LaneSet eliminate_lanes_symmetric(double* factor, double* schur, int n, int e, const double* scale,
                                  const double* inverse_scale, const PivotRule& rule, Transfers& beside) {
  unsigned failed = 0;
  for (int l = 0; l < wide; l += width) {
    const Front f = register_of(factor, schur, n, e, l, Symmetry::symmetric);
    failed |= eliminate_symmetric_register(f, scale + l, inverse_scale + l, rule, beside) << l;
  }
  return static_cast<LaneSet>(failed);
}

void backward_lanes_symmetric(const double* factor, int n, int e, double* v) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int l = 0; l < wide; l += width)
    for (int k0 = (e + panel_width - 1) / panel_width * panel_width - panel_width; k0 >= 0; k0 -= panel_width) {
      const int k = std::min(panel_width, e - k0);
      const double* block = factor + k0 * ld + k0 * wide + l;
      double* y = v + k0 * wide + l;
      for (int i = 0; i < k; ++i) store(y + i * wide, load(y + i * wide) * load(block + i * (ld + wide)));
      accumulate_rows<false>(k, block + k * wide, ld, wide, n - k0 - k, y + k * wide, y);
      with_size(k, [&](auto size) { backward_symmetric_triangle<decltype(size)::value>(block, ld, y); });
    }
}

}  // namespace bough::solve
