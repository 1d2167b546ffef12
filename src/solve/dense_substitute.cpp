#include <algorithm>
#include <cstddef>

#include "dense.hpp"
#include "dense_tiles.hpp"

namespace bough::solve {

namespace {

using tiles::add_product;
using tiles::all;
using tiles::Lanes;
using tiles::load;
using tiles::store;
using tiles::take_product;
using tiles::width;

constexpr int block = 4;  ///< columns that go together, so that a vector is read once for four

/// f[0, n) -= columns of a times y, four of them.
void take_columns(int n, const double* a, std::ptrdiff_t lda, const double* y, double* f) {
  const double *a0 = a, *a1 = a + lda, *a2 = a + 2 * lda, *a3 = a + 3 * lda;
  const Lanes y0 = all(y[0]), y1 = all(y[1]), y2 = all(y[2]), y3 = all(y[3]);
  int i = 0;
  for (; i + width <= n; i += width) {
    Lanes v = load(f + i);
    v = take_product(load(a0 + i), y0, v);
    v = take_product(load(a1 + i), y1, v);
    v = take_product(load(a2 + i), y2, v);
    store(f + i, take_product(load(a3 + i), y3, v));
  }
  for (; i < n; ++i) {
    double v = take_product(a0[i], y[0], f[i]);
    v = take_product(a1[i], y[1], v);
    v = take_product(a2[i], y[2], v);
    f[i] = take_product(a3[i], y[3], v);
  }
}

/// f[0, n) -= a y, k columns.
void take_product_with(int n, int k, const double* a, std::ptrdiff_t lda, const double* y, double* f) {
  int j = 0;
  for (; j + block <= k; j += block) take_columns(n, a + j * lda, lda, y + j, f);
  for (; j < k; ++j) tiles::take_column(n, a + j * lda, y[j], f);
}

/// Eight partial sums, whatever the width of the registers.
double sum_products(int n, const double* a, const double* x) {
  constexpr int registers = 8 / width;
  Lanes sum[registers] = {};
  int i = 0;
  for (; i + 8 <= n; i += 8)
    for (int r = 0; r < registers; ++r) sum[r] = add_product(load(a + i + r * width), load(x + i + r * width), sum[r]);
  double parts[8];
  for (int r = 0; r < registers; ++r) store(parts + r * width, sum[r]);
  for (int l = 0; i < n; ++i, ++l) parts[l] = add_product(a[i], x[i], parts[l]);
  return ((parts[0] + parts[1]) + (parts[2] + parts[3])) + ((parts[4] + parts[5]) + (parts[6] + parts[7]));
}

/// x[0, k) = L11^-T (x - L21^T x_B), L unit lower, its n rows in the first k columns of a.
void substitute_transposed(int n, int k, const double* a, std::ptrdiff_t lda, double* x) {
  for (int j = k; j-- > 0;) x[j] -= sum_products(n - j - 1, a + j * lda + j + 1, x + j + 1);
}

}  // namespace

void substitute_forward(const FrontMatrix& front, int pivots, double* f) {
  const FrontParts v(front);
  for (int k = 0; k < pivots; k += block) {
    const int end = std::min(k + block, pivots);
    const double* l = v.a + k * v.lda;
    for (int p = k; p < end; ++p)
      for (int i = p + 1; i < end; ++i) f[i] = take_product(v.a[p * v.lda + i], f[p], f[i]);
    take_product_with(v.size - end, end - k, l + end, v.lda, f + k, f + end);
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
      const double first = x[k], second = x[k + 1];  // D^-1 of two rows, divided by what stands off its diagonal
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
    const int begin = std::max(0, k - block);
    for (int p = k; p-- > begin;) {
      const double* u = v.a + p * v.lda;
      x[p] /= u[p];
      for (int i = begin; i < p; ++i) x[i] = take_product(u[i], x[p], x[i]);
    }
    take_product_with(begin, k - begin, v.a + begin * v.lda, v.lda, x + begin, x);
    k = begin;
  }
}

void substitute_backward_left(const FrontMatrix& front, int pivots, double* z) {
  const FrontParts v(front);
  for (int k = pivots; k-- > 0;) z[k] = -sum_products(v.size - k - 1, v.a + k * v.lda + k + 1, z + k + 1);
}

}  // namespace bough::solve
