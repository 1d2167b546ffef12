#pragma once
/// Dense kernels of one front. Column-major, leading dimensions given. No allocation. Internal to solve.
#include <cstddef>

#include "bough/tree/walker.hpp"
#include "pivot_rule.hpp"

namespace bough::solve {

/// c -= a b. c: m x n, a: m x k, b: k x n. Every entry is one sum over ascending k, subtracted at once for every 96
/// terms, independent of the blocking.
void subtract_product(int m, int n, int k, const double* a, int lda, const double* b, int ldb, double* c, int ldc);

/// A front being factored: the first `full` rows and columns are fully summed. Either one square (u null, leading
/// dimension size), or in three parts, of which the memory of the last can be reused after the parent has read it:
///   [ a  u ]     a: size x full, u: full x (size - full), s: (size - full) x (size - full)
///   [ .  s ]
/// Symmetric: only the lower triangles of a and s; there is no u, and entries above the diagonals are undefined.
struct FrontMatrix {
  double* a = nullptr;
  int size = 0;
  int full = 0;
  int* rows = nullptr;      ///< global unknown of each fully summed row, permuted with it
  int* columns = nullptr;   ///< the same for columns
  int* row_from = nullptr;  ///< position of each row before any pivoting
  int lda = 0;              ///< of the three parts; 0: one square
  double* u = nullptr;
  int ldu = 0;
  double* s = nullptr;
  int lds = 0;
  /// Symmetric: 2 x full, the diagonal of D and the entries below it (nonzero: a pivot of two rows begins).
  double* d = nullptr;
};

/// The parts of a front in any storage.
struct FrontParts {
  double *a, *u, *s;
  std::ptrdiff_t lda, ldu, lds;
  int size, full;
  FrontParts(double* a, std::ptrdiff_t lda, double* u, std::ptrdiff_t ldu, double* s, std::ptrdiff_t lds, int size,
             int full)
      : a(a), u(u), s(s), lda(lda), ldu(ldu), lds(lds), size(size), full(full) {}
  explicit FrontParts(const FrontMatrix& f)
      : a(f.a), u(f.u), s(f.s), lda(f.lda), ldu(f.ldu), lds(f.lds), size(f.size), full(f.full) {
    if (f.lda != 0) return;
    lda = ldu = lds = size;
    u = a + full * lda;
    s = u + full;
  }
  /// Column j; its rows [0, full) if j is not fully summed.
  double* top(int j) const { return j < full ? a + j * lda : u + (j - full) * ldu; }
  /// Rows from `full` on of column j.
  double* bottom(int j) const { return j < full ? a + j * lda + full : s + (j - full) * lds; }
};

/// Eliminates as many fully summed unknowns as the rule allows. The diagonal is preferred, and rows are exchanged only
/// within the fully summed ones. Afterwards L (unit, below), U and the Schur complement are in place, with the rejected
/// rows and columns last among the fully summed ones.
///   P A Q = [L11 0; L21 I] [U11 U12; 0 S]
/// A large update of the remaining columns is distributed to the walker's threads; bits do not depend on this. Returns
/// the number of pivots, or -1 if an entry is not finite.
int eliminate_with_threshold(FrontMatrix& front, const PivotRule& rule, const tree::Walker* walker = nullptr);

/// The same for a symmetric front (lower triangle; d given): P A P^T = L D L^T, D of blocks of one and two rows. A
/// pivot of two rows, p and the largest entry of its column among the present candidates, is accepted if |D^-1| times
/// the largest entries of its columns stays below 1 / threshold [Duff, Reid 1983].
int eliminate_symmetric(FrontMatrix& front, const PivotRule& rule, const tree::Walker* walker = nullptr);

/// Continues from `pivots` up to `most` with complete pivoting over the remaining fully summed block (precondition: no
/// boundary), as long as the largest entry reaches `least`. row_weight, column_weight: one factor for each remaining
/// row and column by which entries are compared, permuted along; or null for ones. Returns the number of pivots
/// reached.
int eliminate_completely(FrontMatrix& front, int pivots, int most, double least, double* row_weight = nullptr,
                         double* column_weight = nullptr);

/// Largest norms of a negligible row or column without its part in the pivots.
struct Negligible {
  double remaining = 0.0;  ///< its entries in the other fully summed columns or rows without a pivot
  double boundary = 0.0;   ///< and in those of the boundary
};

/// Of the rows and columns from `pivots` on that are fully summed, moves negligible ones to their end, in pairs, if
/// is_candidate holds for the unknown of the row and of the column. A row and a column with the same place keep it
/// together. Returns the number of pairs.
int move_negligible_last(FrontMatrix& front, int pivots, const Negligible& negligible, const bool* is_candidate);

/// f = L^-1 f for the first `pivots` entries, and f_B -= L21 y for the others. f must be permuted already.
void substitute_forward(const FrontMatrix& front, int pivots, double* f);
/// y = U11^-1 (y - U12 x_B), symmetric: L11^-T (D^-1 y - L21^T x_B); x: size entries, y in the first `pivots`, x_B in
/// the others.
void substitute_backward(const FrontMatrix& front, int pivots, double* x);
/// Left vectors: z^T = -z_B^T L21 L11^-1 in the first `pivots` entries, z_B in the others. Rows are permuted, so
/// nothing may be added afterwards.
void substitute_backward_left(const FrontMatrix& front, int pivots, double* z);

/// The same for a square.
inline FrontMatrix make_square(const double* a, int size, int full) {
  FrontMatrix f;
  f.a = const_cast<double*>(a);  // substitutions do not write it
  f.size = size;
  f.full = full;
  return f;
}
inline void substitute_forward(const double* a, int size, int pivots, double* f) {
  substitute_forward(make_square(a, size, pivots), pivots, f);
}
inline void substitute_backward(const double* a, int size, int pivots, double* x) {
  substitute_backward(make_square(a, size, pivots), pivots, x);
}
inline void substitute_backward_left(const double* a, int size, int pivots, double* z) {
  substitute_backward_left(make_square(a, size, pivots), pivots, z);
}

}  // namespace bough::solve
