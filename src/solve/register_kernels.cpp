#include "register_kernels.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "dense_tiles.hpp"
#include "register_rows.hpp"

namespace bough::solve {

namespace {

using rows::Eight;
using rows::eight;
using rows::Mask;

/// Data for the elimination of up to eight pivots, all in one column of registers. Pointers begin at the first pivot's
/// row and register.
struct Panel {
  double* rows;
  int step;        ///< between rows
  int count;       ///< rows from the first pivot on
  int full;        ///< rows that belong to the eliminated part, from the first pivot on; pivots: this is the last panel
  double* factor;  ///< the first pivot's row, at its column
  int ld;          ///< between rows of the factor
  double* lower;   ///< L21, at the first pivot's column
  int ld_lower;
  double* vector;
  double* schur;
  int schur_step;
  const double *column, *inverse_column, *least;
  double threshold;
};

constexpr std::uint64_t all_but_sign = ~std::uint64_t{0} >> 1;
constexpr Mask last_lane = 1 << (eight - 1);  ///< of a row's last register: the right-hand side
constexpr Mask above(int lane) { return static_cast<Mask>(0xff << (lane + 1)); }
constexpr Mask first_lanes(int count) {
  return static_cast<Mask>(count >= eight ? 0xff : count <= 0 ? 0 : (1 << count) - 1);
}

/// Updates C rows from row i on by the K pivots, p their rows; symmetric: the rows before division, which are in
/// f.rows.
template <int R, int K, int C, bool is_symmetric>
[[gnu::always_inline]] inline void update_rows(const Panel& f, const Eight (&p)[K][R], int i) {
  Eight t[C][R];
  double* first = f.rows + i * static_cast<std::ptrdiff_t>(f.step);
#pragma GCC unroll 8
  for (int c = 0; c < C; ++c)
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) t[c][r] = rows::load(first + c * f.step + r * eight);
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k)
#pragma GCC unroll 8
    for (int c = 0; c < C; ++c) {
      const packs::Real m = is_symmetric ? packs::Real{} + f.rows[k * f.step + i + c] : rows::all_of(t[c][0], k);
      if (k + 1 < eight) rows::take_product(t[c][0], above(k), m, p[k][0]);
#pragma GCC unroll 8
      for (int r = 1; r < R; ++r) rows::take_product(t[c][r], m, p[k][r]);
    }
  const bool is_last = f.full == K;
#pragma GCC unroll 8
  for (int c = 0; c < C; ++c) {
    if constexpr (!is_symmetric) {
      const int row = i + c;
      rows::store(row < f.full ? f.factor + row * static_cast<std::ptrdiff_t>(f.ld)
                               : f.lower + (row - f.full) * static_cast<std::ptrdiff_t>(f.ld_lower),
                  first_lanes(K), t[c][0]);
    }
    if (is_last) {
      using rows::LastLane;
      double* to = f.schur + (i + c - K) * static_cast<std::ptrdiff_t>(f.schur_step);
      const int count = f.schur_step / eight;  // R or one less
#pragma GCC unroll 8
      for (int q = 0; q < R; ++q) {
        const Eight& high = t[c][q + 1 < R ? q + 1 : q];  // entries beyond the last register are not used
        if (q + 2 < R || (q + 2 == R && count == R)) {
          rows::store(to + q * eight, rows::shifted<K, LastLane::as_it_comes>(t[c][q], high));
        } else if (q + 2 == R) {
          rows::store(to + q * eight, rows::shifted<K, LastLane::of_high>(t[c][q], high));
        } else if (count == R) {
          rows::store(to + q * eight, rows::shifted<K, LastLane::of_low>(t[c][q], high));
        }
      }
    } else {
#pragma GCC unroll 8
      for (int r = 0; r < R; ++r) rows::store(first + c * f.step + r * eight, t[c][r]);
    }
  }
}

/// Eliminates K pivots, whose rows have R registers from that of the pivot on.
template <int R, int K, bool is_symmetric>
bool eliminate_panel(const Panel& given) {
  const Panel f = given;  // a local copy, since stores of rows may alias any object with an address elsewhere
  Eight p[K][R];
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k)
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) p[k][r] = rows::load(f.rows + k * f.step + r * eight);
  double pivot = rows::lane_of(p[0][0], 0);
  Eight growth[R] = {};
  const Mask last = first_lanes(f.count - (R - 1) * eight);
  Eight z = {};
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) {
    // Compared as bits: a NaN or infinity rejects the pivot without a trap.
    const auto size = std::bit_cast<std::uint64_t>(pivot) & all_but_sign;
    const auto least = std::bit_cast<std::uint64_t>(f.least[k]);
    if (size - least >= static_cast<std::uint64_t>(packs::infinite_bits) - least) return false;
    const double inverse_pivot = 1.0 / pivot;
    const packs::Real inverse = packs::Real{} + inverse_pivot;
    if (k + 1 < K) {  // the next pivot first, by the same operations as its row below, so that its division can start
      const double beside = rows::lane_of(p[k][0], k + 1), u = beside * inverse_pivot;
      pivot = is_symmetric ? tiles::take_product(u, beside, rows::lane_of(p[k + 1][0], k + 1))
                           : tiles::take_product(rows::lane_of(p[k + 1][0], k), u, rows::lane_of(p[k + 1][0], k + 1));
    }
    // Growth of rows: squares of the entries of U, scaled.
    const packs::Real weight = packs::Real{} + f.inverse_column[k];
    Eight u[R];
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) {
      u[r] = r == 0 ? rows::product(p[k][0], above(k), inverse) : rows::product(p[k][r], 0xff, inverse);
      const Mask asked = static_cast<Mask>((r == 0 ? above(k) : 0xff) & (r == R - 1 ? ~last_lane : 0xff));
      const Eight scaled = rows::product_or_zero(u[r], asked, weight);
      for (int i = 0; i < rows::parts; ++i)
        growth[r].r[i] = packs::plus_product(growth[r].r[i], scaled.r[i], scaled.r[i]);
    }
    if constexpr (is_symmetric) {
#pragma GCC unroll 8
      for (int r = 0; r < R; ++r) rows::store(f.rows + k * f.step + r * eight, u[r]);
    }
#pragma GCC unroll 8
    for (int i = k + 1; i < K; ++i) {
      const packs::Real m = is_symmetric ? rows::all_of(u[0], i) : rows::all_of(p[i][0], k);
      rows::take_product(p[i][0], above(k), m, is_symmetric ? p[k][0] : u[0]);
#pragma GCC unroll 8
      for (int r = 1; r < R; ++r) rows::take_product(p[i][r], m, is_symmetric ? p[k][r] : u[r]);
    }
    Eight with_inverse;
    for (int i = 0; i < rows::parts; ++i) with_inverse.r[i] = inverse;
    u[0] = rows::choose(static_cast<Mask>(1 << k), with_inverse, u[0]);
    double* to = f.factor + k * static_cast<std::ptrdiff_t>(f.ld);
#pragma GCC unroll 8
    for (int r = 0; r + 1 < R; ++r) rows::store(to + r * eight, u[r]);
    rows::store(to + (R - 1) * eight, last, u[R - 1]);
    rows::take_lane(z, k, u[R - 1], eight - 1);
    if constexpr (!is_symmetric) {
#pragma GCC unroll 8
      for (int r = 0; r < R; ++r) p[k][r] = u[r];
    }
  }
  if (f.vector != nullptr) rows::store(f.vector, first_lanes(K), z);
  constexpr int room = 30 / (R + 1) - K * R / (R + 1);
  constexpr int C = room >= 6 ? 6 : room >= 4 ? 4 : room >= 2 ? 2 : 1;
  int i = K;
  for (; i + C <= f.count; i += C) update_rows<R, K, C, is_symmetric>(f, p, i);
  if constexpr (C > 2)
    for (; i + 2 <= f.count; i += 2) update_rows<R, K, 2, is_symmetric>(f, p, i);
  for (; i < f.count; ++i) update_rows<R, K, 1, is_symmetric>(f, p, i);
  long long grown = 0;
  const double most = 1.0 / f.threshold;
  const packs::Real bound = packs::Real{} + most * most;
#pragma GCC unroll 8
  for (int r = 0; r < R; ++r) {
    const Eight scale = rows::load(f.column + r * eight);
    for (int j = 0; j < rows::parts; ++j) {
      const packs::Real of_scale = growth[r].r[j] * scale.r[j] * scale.r[j];
      const packs::Flag good = packs::bits_of(packs::magnitude(of_scale)) <= packs::bits_of(bound);
      for (int l = 0; l < packs::width; ++l) grown |= ~good[l];
    }
  }
  return grown == 0;
}

using Eliminate = bool (*)(const Panel&);

template <bool is_symmetric, int... I>
constexpr void fill_table(Eliminate (&table)[most_row_registers][eight], std::integer_sequence<int, I...>) {
  ((table[I / eight][I % eight] = eliminate_panel<I / eight + 1, I % eight + 1, is_symmetric>), ...);
}

struct Table {
  Eliminate of[2][most_row_registers][eight] = {};  ///< by symmetry, registers of a row and pivots, one less
  constexpr Table() {
    fill_table<false>(of[0], std::make_integer_sequence<int, most_row_registers * eight>{});
    fill_table<true>(of[1], std::make_integer_sequence<int, most_row_registers * eight>{});
  }
};
constexpr Table table;

/// N rows of R registers.
template <int N, int R, bool is_first>
inline void move_some(const RegisterMove& move, const double* from, double* to, int step) {
  const std::ptrdiff_t from_step = move.row_step;
  Mask mask[R];
#pragma GCC unroll 8
  for (int r = 0; r < R; ++r) mask[r] = move.mask[r];
#pragma GCC unroll 8
  for (int i = 0; i < N; ++i)
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) {
      Eight v = rows::load(from + i * from_step + r * eight, mask[r]);
      double* there = to + i * step + r * eight;
      if constexpr (!is_first) {
        const Eight before = rows::load(there);
        for (int j = 0; j < rows::parts; ++j) v.r[j] += before.r[j];
      }
      rows::store(there, v);
    }
}

template <int R, bool is_first>
inline void move_all(const RegisterMove& move, const double* from, double* to, int step) {
  int rows = move.rows;
  const std::ptrdiff_t from_step = move.row_step;
  for (; rows >= 6; rows -= 6, from += 6 * from_step, to += 6 * step) move_some<6, R, is_first>(move, from, to, step);
  for (; rows >= 2; rows -= 2, from += 2 * from_step, to += 2 * step) move_some<2, R, is_first>(move, from, to, step);
  if (rows > 0) move_some<1, R, is_first>(move, from, to, step);
}

}  // namespace

void move_rows(const RegisterMove& move, int step, const double* source, double* front) {
  const double* from = source + move.source;
  double* to = front + move.target;
  switch (2 * move.registers + (move.is_first ? 1 : 0)) {
    case 2:
      return move_all<1, false>(move, from, to, step);
    case 3:
      return move_all<1, true>(move, from, to, step);
    case 4:
      return move_all<2, false>(move, from, to, step);
    case 5:
      return move_all<2, true>(move, from, to, step);
    case 6:
      return move_all<3, false>(move, from, to, step);
    default:
      return move_all<3, true>(move, from, to, step);
  }
}

void add_right_hand_side(int count, const double* b, int step, double* front) {
  double* to = front + step - eight;
  for (int i = 0; i < count; ++i, to += step) {
    Eight v = rows::load(to);
    Eight value;
    for (int j = 0; j < rows::parts; ++j) value.r[j] = packs::Real{} + b[i];
    for (int j = 0; j < rows::parts; ++j) value.r[j] += v.r[j];
    rows::store(to, rows::choose(last_lane, value, v));
  }
}

bool eliminate_in_registers(int n, int e, bool is_symmetric, const RegisterScales& scales, double threshold,
                            const RegisterParts& parts) {
  const int registers = n / eight + 1, step = registers * eight, b = n - e;
  const int schur_step = (b / eight + 1) * eight;
  if (e == 0) {
    std::copy_n(parts.rows, static_cast<std::ptrdiff_t>(n) * step, parts.schur);  // rows of the same length
    return true;
  }
  for (int k0 = 0; k0 < e; k0 += eight) {
    const int pivots = std::min(eight, e - k0);
    Panel f;
    f.rows = parts.rows + static_cast<std::ptrdiff_t>(k0) * step + k0;
    f.step = step;
    f.count = n - k0;
    f.full = e - k0;
    f.factor = parts.factor + static_cast<std::ptrdiff_t>(k0) * n + k0;
    f.ld = n;
    f.lower = parts.factor + static_cast<std::ptrdiff_t>(e) * n + k0;
    f.ld_lower = e;
    f.vector = parts.vector == nullptr ? nullptr : parts.vector + k0;
    f.schur = parts.schur;
    f.schur_step = schur_step;
    f.column = scales.column + k0;
    f.least = scales.least + k0;
    f.inverse_column = scales.inverse_column + k0;
    f.threshold = threshold;
    if (!table.of[is_symmetric ? 1 : 0][registers - k0 / eight - 1][pivots - 1](f)) return false;
  }
  return true;
}

}  // namespace bough::solve
