#include <cstddef>
#include <cstring>

#include "dense.hpp"

namespace bough::solve {

namespace {

// A vector register wide; how wide never changes a result: lanes do not mix and the sum over k is sequential.
#if defined(__AVX512F__)
constexpr int width = 8;
#elif defined(__AVX__)
constexpr int width = 4;
#else
constexpr int width = 2;
#endif
typedef double Lanes __attribute__((vector_size(width * sizeof(double))));

inline Lanes load(const double* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void store(double* p, Lanes v) { std::memcpy(p, &v, sizeof v); }

/// Tile of 2 registers x 4 columns.
inline void tile_2x4(int k, const double* a, std::ptrdiff_t lda, const double* b, std::ptrdiff_t ldb, double* c,
                     std::ptrdiff_t ldc) {
  Lanes c00 = load(c), c10 = load(c + width);
  Lanes c01 = load(c + ldc), c11 = load(c + ldc + width);
  Lanes c02 = load(c + 2 * ldc), c12 = load(c + 2 * ldc + width);
  Lanes c03 = load(c + 3 * ldc), c13 = load(c + 3 * ldc + width);
  for (int p = 0; p < k; ++p) {
    const Lanes a0 = load(a + p * lda), a1 = load(a + p * lda + width);
    const double b0 = b[p], b1 = b[p + ldb], b2 = b[p + 2 * ldb], b3 = b[p + 3 * ldb];
    c00 -= a0 * b0;
    c10 -= a1 * b0;
    c01 -= a0 * b1;
    c11 -= a1 * b1;
    c02 -= a0 * b2;
    c12 -= a1 * b2;
    c03 -= a0 * b3;
    c13 -= a1 * b3;
  }
  store(c, c00), store(c + width, c10);
  store(c + ldc, c01), store(c + ldc + width, c11);
  store(c + 2 * ldc, c02), store(c + 2 * ldc + width, c12);
  store(c + 3 * ldc, c03), store(c + 3 * ldc + width, c13);
}

inline void tile_2x1(int k, const double* a, std::ptrdiff_t lda, const double* b, double* c) {
  Lanes c0 = load(c), c1 = load(c + width);
  for (int p = 0; p < k; ++p) {
    const double bp = b[p];
    c0 -= load(a + p * lda) * bp;
    c1 -= load(a + p * lda + width) * bp;
  }
  store(c, c0), store(c + width, c1);
}

inline void rest_of_column(int m, int k, const double* a, std::ptrdiff_t lda, const double* b, double* c) {
  for (int p = 0; p < k; ++p) {
    const double bp = b[p];
    const double* ap = a + p * lda;
    for (int i = 0; i < m; ++i) c[i] -= ap[i] * bp;
  }
}

}  // namespace

void subtract_product(int m, int n, int k, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
  if (k == 0) return;  // an empty factor has no memory
  constexpr int tile_rows = 2 * width;
  const int m_tiled = m - m % tile_rows;
  const std::ptrdiff_t la = lda, lb = ldb, lc = ldc;
  for (int i = 0; i < m_tiled; i += tile_rows) {
    int j = 0;
    for (; j + 4 <= n; j += 4) tile_2x4(k, a + i, la, b + j * lb, lb, c + i + j * lc, lc);
    for (; j < n; ++j) tile_2x1(k, a + i, la, b + j * lb, c + i + j * lc);
  }
  if (m_tiled < m)
    for (int j = 0; j < n; ++j) rest_of_column(m - m_tiled, k, a + m_tiled, la, b + j * lb, c + m_tiled + j * lc);
}

}  // namespace bough::solve
