#pragma once
/// Kernels of one small front, row by row in registers, the right-hand side in the last lane of its rows. No row is
/// exchanged. Internal to solve.
/// A = L U, U unit upper with the pivots in L: rows of U are divided, so that multipliers are unchanged entries of L.
/// A pivot must reach `least`. For each panel of up to eight pivots the squares of the entries of U are summed by
/// columns, scaled: a sum above 1 / threshold^2 rejects them, so that no entry of U is larger than 1 / threshold.
/// Symmetric: U^T D U, entries below the diagonal are not used.
#include "register_plan.hpp"

namespace bough::solve {

/// Scales of a front: columns (zero in unused lanes), and for eliminated unknowns 1 / column and the lower limit of the
/// magnitude of the pivot.
struct RegisterScales {
  const double *column, *inverse_column, *least;
};

/// Memory of the parts of a front. rows: the assembled front, overwritten; 64-byte boundaries.
struct RegisterParts {
  double* rows;
  double* factor;
  double* vector;  ///< z = L^-1 b of the eliminated unknowns; null: no right-hand side
  double* schur;   ///< rows of the boundary, 64-byte boundaries: Schur complement, then the condensed right-hand side
};

/// Adds the rows of a move, or writes them if it is the first at its target. front: its first row, `step` doubles from
/// the next.
void move_rows(const RegisterMove& move, int step, const double* source, double* front);
/// Adds b to the right-hand sides of `count` rows, `step` doubles from one to the next.
void add_right_hand_side(int count, const double* b, int step, double* front);

/// False: a pivot is rejected or not finite; factor and schur are then undefined.
bool eliminate_in_registers(int n, int e, bool is_symmetric, const RegisterScales& scales, double threshold,
                            const RegisterParts& parts);

/// t: n numbers. The first `e` become L^-1 t, and their part is subtracted from the others. symmetric: the rows of U
/// contain L^T D^-1.
void forward_in_registers(const double* factor, int n, int e, bool is_symmetric, double* t);
/// x_E = U11^-1 (z - U12 x_B).
void backward_in_registers(const double* factor, int n, int e, const double* z, const double* boundary, double* x);
/// Left vectors: y_E^T = -y_B^T L21 L11^-1.
void backward_left_in_registers(const double* factor, int n, int e, bool is_symmetric, double* y);

}  // namespace bough::solve
