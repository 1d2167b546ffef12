#pragma once
/// Kernels of one small front, row by row in registers, the right-hand side in the last lane of its rows. No row is
/// exchanged. Internal to solve.
///   A = L U, U unit upper with the pivots in L: rows of U are divided, so that multipliers are the entries of L as
///     they stand.
/// A pivot is to reach `least`. Of the up to eight that go together the squares of the entries of U are summed by
/// columns, scaled: a sum above 1 / threshold^2 refuses them, so that no entry of U is larger than 1 / threshold
/// (definite: RegisterKind).
#include "register_plan.hpp"

namespace bough::solve {

enum class RegisterKind {
  general,    ///< L U
  symmetric,  ///< U^T D U: nothing below the diagonal is used
  definite,  ///< the same; pivots are to be positive, and no panel may take more than 1 / threshold, scaled, off a diagonal
};

/// Scales of a front: columns (zero beyond), and of what is eliminated 1 / column and what the magnitudes of pivots
/// have to reach.
struct RegisterScales {
  const double *column, *inverse_column, *least;
};

/// Where the parts of a front stand. rows: as it is assembled, overwritten; 64-byte boundaries.
struct RegisterParts {
  double* rows;
  double* factor;
  double* vector;  ///< z = L^-1 b of what is eliminated; null: there is no right-hand side
  double* schur;   ///< rows of the boundary, 64-byte boundaries: Schur complement, then the condensed right-hand side
};

/// Adds the rows of a move, or writes them where it is the first. front: its first row, `step` doubles from the next.
void move_rows(const RegisterMove& move, int step, const double* source, double* front);
/// Adds b to the right-hand sides of `count` rows, `step` doubles from one to the next.
void add_right_hand_side(int count, const double* b, int step, double* front);

/// False: a pivot is refused, or not finite; what stands in factor and schur then has no meaning.
bool eliminate_in_registers(int n, int e, RegisterKind kind, const RegisterScales& scales, double threshold,
                            const RegisterParts& parts);

/// t: n numbers. First `e` <- L^-1 t, the rest reduced. symmetric: L^T D^-1 stands in the rows of U.
void forward_in_registers(const double* factor, int n, int e, bool is_symmetric, double* t);
/// x_E = U11^-1 (z - U12 x_B).
void backward_in_registers(const double* factor, int n, int e, const double* z, const double* boundary, double* x);
/// Left vectors: y_E^T = -y_B^T L21 L11^-1.
void backward_left_in_registers(const double* factor, int n, int e, bool is_symmetric, double* y);

}  // namespace bough::solve
