#pragma once
/// Dense kernels of one front. Column-major, leading dimension given. No allocation. Internal to solve.

namespace bough::solve {

/// c -= a b. c: m x n, a: m x k, b: k x n; the sum over k runs upward for every entry, whatever the blocking.
void subtract_product(int m, int n, int k, const double* a, int lda, const double* b, int ldb, double* c, int ldc);

/// A front being factored: the first `full` rows and columns are fully summed.
struct FrontMatrix {
  double* a = nullptr;  ///< size x size, column-major, leading dimension size
  int size = 0;
  int full = 0;
  int* rows = nullptr;      ///< global unknown of each fully summed row, permuted with it
  int* columns = nullptr;   ///< the same for columns
  int* row_from = nullptr;  ///< position of each row before any pivoting
};

/// Which pivots may be taken.
struct PivotRule {
  double threshold = 0.02;  ///< at least this share of the column's largest entry, boundary rows included
  double least = 1e-9;      ///< at least this
};

/// Eliminates as many fully summed unknowns as the rule allows, the diagonal preferred, rows exchanged within the fully summed ones only;
/// leaves L (unit, below), U and the Schur complement in place, the refused rows and columns last among the fully summed.
///   P A Q = [L11 0; L21 I] [U11 U12; 0 S]
/// Returns the number of pivots, or -1 when an entry is not finite.
int eliminate_with_threshold(FrontMatrix& front, const PivotRule& rule);

/// Goes on from `pivots` up to `most` with complete pivoting over the remaining fully summed block (precondition: no boundary), as long as
/// the largest entry reaches `least`. row_weight, column_weight: one factor for each remaining row and column by which entries are
/// compared, permuted along; or null for ones. Returns the number of pivots reached.
int eliminate_completely(FrontMatrix& front, int pivots, int most, double least, double* row_weight = nullptr,
                         double* column_weight = nullptr);

/// f = L^-1 f for the first `pivots` entries, the rest reduced: f_B -= L21 y. f already permuted.
void substitute_forward(const double* a, int size, int pivots, double* f);
/// y = U11^-1 (y - U12 x_B); x: size entries, y in the first `pivots`, x_B in the others.
void substitute_backward(const double* a, int size, int pivots, double* x);
/// Left vectors: z^T = -z_B^T L21 L11^-1 in the first `pivots` entries, z_B in the others; then add nothing else (rows are permuted).
void substitute_backward_left(const double* a, int size, int pivots, double* z);

}  // namespace bough::solve
