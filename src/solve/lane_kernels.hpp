#pragma once
/// Dense kernels over eight fronts in lockstep: entry k of lane l at [8 k + l], columns one after the other. No row is
/// exchanged; lanes with too much growth are reported. Lanes never mix, so the numbers of a lane do not depend on its
/// neighbours or on the width of the registers. Internal to solve.
#include <cstdint>

#include "bough/solve/element_view.hpp"
#include "bough/solve/options.hpp"
#include "moves.hpp"
#include "pivot_rule.hpp"

namespace bough::solve {

class Transfers;

/// Bit l: lane l.
using LaneSet = std::uint8_t;

/// Eliminates the first e of n unknowns. factor: e columns of n entries, then n - e columns of e entries; schur: the
/// other columns' rows below. After: L (unit) below the diagonal, the inverse pivots on it, U above and in the
/// further columns, the Schur complement. row_scale: n packs, inverse_column_scale: e packs. Returns the lanes with a
/// pivot that violates the rule; they contain an identity from there on. beside: steps elimination_steps(n, e) times.
LaneSet eliminate_lanes(double* factor, double* schur, int n, int e, const double* row_scale,
                        const double* inverse_column_scale, const PivotRule& rule, Transfers& beside);

/// The same for symmetric fronts, L D L^T. factor: e columns of n entries, schur as above; entries above the diagonals
/// are not read. After: L (unit) below the diagonal, the inverse of D on it, the Schur complement on and below its
/// diagonal; entries above are undefined.
LaneSet eliminate_lanes_symmetric(double* factor, double* schur, int n, int e, const double* scale,
                                  const double* inverse_scale, const PivotRule& rule, Transfers& beside);
int elimination_steps(int n, int e);
constexpr int most_lane_rows = 2 * lanes_wide * lanes_wide;  ///< no front in lanes has more rows

/// Identity in the eliminated part and 0 elsewhere, for the lanes of the set.
void neutralise_lanes(double* factor, double* schur, int n, int e, LaneSet lanes, Symmetry symmetry);

/// v: n packs. Forward: v_E = L11^-1 v_E, v_B -= L21 v_E. Backward: v_E = U11^-1 (v_E - U12 v_B). Left: v_E^T =
/// -v_B^T L21 L11^-1.
void forward_lanes(const double* factor, int n, int e, double* v);
void backward_lanes(const double* factor, int n, int e, double* v);
/// v_E = L11^-T (D^-1 v_E - L21^T v_B); forward and left are those of L.
void backward_lanes_symmetric(const double* factor, int n, int e, double* v);
void backward_left_lanes(const double* factor, int n, int e, double* v);

/// The block of a move in packs. One of the steps of the source is 1.
void move_block(const Source& source, const Move& move, const Target& target);

/// y_i += sum_j element_ij x_j for a block as above.
void multiply_block_lanes(const double* element, int stride, int p, int q, const double* x, double* y);

/// Largest of |a_ij - a_ji| scale_i scale_j over all lanes of an element with blocks in a front whose row scales are
/// given; infinity or NaN if there is a NaN.
double largest_asymmetry_lanes(const double* element, int size, std::span<const Run> blocks, const double* row_scale);

/// Largest of |v_i| scale_i over `count` packs and all lanes; infinity or NaN if there is a NaN.
double largest_scaled(const double* v, const double* scale, int count);

/// Prefetches `count` packs to the second cache. It is not inline, since g++ regards a function that only prefetches as
/// pure and removes its calls.
void prefetch_packs(const double* packs, int count);

/// to += from, `count` packs; with `from_lane` lane l of `to` takes lane from_lane[l], or zero if that is negative.
void add_packs(const double* from, int count, double* to);
void add_packs(const double* from, int count, double* to, const std::int8_t* from_lane);

}  // namespace bough::solve
