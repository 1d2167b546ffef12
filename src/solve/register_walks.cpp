/// Visits of leaves whose fronts are in registers.
#include <algorithm>

#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }
constexpr int largest_factor = (largest_in_registers * largest_in_registers / row_register + 1) * row_register;
constexpr std::int64_t lines_of(std::int64_t numbers) { return (numbers + row_register - 1) / row_register; }
constexpr int ahead = 2;  ///< number of fronts by which their input is prefetched ahead
void fetch(const double* numbers, std::int64_t count) {
  for (std::int64_t i = 0; i < count; i += row_register) __builtin_prefetch(numbers + i, 0, 3);
}
constexpr int largest_step = (largest_in_registers / row_register + 1) * row_register;

}  // namespace

/// False: a pivot was rejected. The whole leaf is then factored with pivoting, from its element matrices.
bool Hierarchical::State::factor_registers(int group, const double* b) {
  const RegisterGroup& own = registers.groups[at(group)];
  alignas(64) double rows[largest_in_registers * largest_step];
  double* place = register_schur.data() + own.schur;
  alignas(64) double aside[2][largest_factor];
  Transfers transfers;  // if factors exceed the caches, they are written past them while the next front is assembled
  for (int k = own.front_begin; k < own.front_end; ++k) {
    const RegisterFront& f = registers.fronts[at(k)];
    const int step = f.step();
    if (k + ahead < own.front_end) {
      const RegisterFront& next = registers.fronts[at(k + ahead)];
      fetch(elements.values() + next.values, next.num_values);
    }
    for (int i = f.gap_begin; i < f.gap_end; ++i) std::fill_n(rows + registers.gaps[at(i)], row_register, 0.0);
    for (int i = f.move_begin; i < f.move_end; ++i) {
      const RegisterMove& move = registers.moves[at(i)];
      transfers.step();
      move_rows(move, step,
                move.child < 0
                    ? elements.values() + f.values
                    : place + registers.fronts[at(registers.children[at(f.child_begin + move.child)].front)].schur,
                rows);
    }
    double* vector = nullptr;
    if (b != nullptr) {
      for (int r = f.own_begin; r < f.own_end; ++r) {
        const UnknownRun& run = registers.unknown_runs[at(r)];
        add_right_hand_side(run.length, b + run.unknown, step, rows + run.row * step);
      }
      vector = register_vectors.data() + f.vector;
    }
    mark(tree::Stage::assemble);
    double* const factor = register_factors.data() + f.factor;
    double* const written = exceeds_caches ? aside[k % 2] : factor;
    const bool stands = eliminate_in_registers(f.size(), f.eliminated, is_symmetric(), register_scales.of(f, k),
                                               options.pivot_threshold, {rows, written, vector, place + f.schur});
    if (exceeds_caches) {
      transfers.finish();
      transfers.write(written, lines_of(f.factor_size(is_symmetric())), factor);
      transfers.spread(f.move_end - f.move_begin);
    }
    mark(tree::Stage::eliminate);
    if (!stands) return false;
    if (f.is_exported) export_schur(f, place + f.schur, b != nullptr);
  }
  transfers.finish();
  if (exceeds_caches) Transfers::end_writes();
  return true;
}

/// A front's right-hand side: the condensed parts of the children, then its own, in the same order as in a visit that
/// factors.
void Hierarchical::State::gather_register_rhs(const RegisterFront& f, const double* b, double* t) const {
  std::fill_n(t, f.size(), 0.0);
  for (int c = f.child_begin; c < f.child_end; ++c) {
    const RegisterChild& child = registers.children[at(c)];
    const RegisterFront& from = registers.fronts[at(child.front)];
    const double* g = register_schur.data() + registers.groups[at(f.group)].schur + from.schur + from.schur_step() - 1;
    for (auto r = child.run_begin; r < child.run_end; ++r) {
      const LaneRun& run = registers.runs[at(r)];
      for (int i = 0; i < run.length; ++i) t[run.to + i] += g[(run.from + i) * from.schur_step()];
    }
  }
  for (int r = f.own_begin; r < f.own_end; ++r) {
    const UnknownRun& run = registers.unknown_runs[at(r)];
    for (int i = 0; i < run.length; ++i) t[run.row + i] = b[run.unknown + i] + t[run.row + i];
  }
}

/// To a parent on the scalar path, scaled.
void Hierarchical::State::export_schur(const RegisterFront& f, const double* schur, bool with_vector) {
  FrontData& d = data(f.front);
  d.size = f.size();
  d.full = d.pivots = f.eliminated;
  d.delayed_in = d.delayed_to = d.dependent = 0;
  d.failed = d.allocated = false;
  d.vector = vector_pool.data() + vector_begin[at(f.front)];
  // No pivot is delayed, so the factor is not read, and its address is arbitrary.
  d.set_parts(FrontShape(d.size, d.full, is_symmetric()), d.vector, schur_place(f.front));
  const int step = f.schur_step();
  for_boundary(f.front, [&](int i, std::size_t row) {
    const double* from = schur + i * step;
    const double scale = scales.row[row];
    // Symmetric: rows contain the upper triangle, and columns need the lower one.
    if (is_symmetric()) {
      for_boundary(f.front, [&](int k, std::size_t column) {
        if (k >= i) d.s[static_cast<std::int64_t>(i) * d.lds + k] = scale * from[k] * scales.column[column];
      });
    } else {
      for_boundary(f.front, [&](int k, std::size_t column) {
        d.s[static_cast<std::int64_t>(k) * d.lds + i] = scale * from[k] * scales.column[column];
      });
    }
    if (with_vector) d.vector[d.full + i] = scale * from[step - 1];
  });
}

void Hierarchical::State::forward_registers(int group) {
  const RegisterGroup& own = registers.groups[at(group)];
  for (int k = own.front_begin; k < own.front_end; ++k) {
    const RegisterFront& f = registers.fronts[at(k)];
    double t[largest_in_registers];
    gather_register_rhs(f, visit_rhs, t);
    forward_in_registers(register_factors.data() + f.factor, f.size(), f.eliminated, is_symmetric(), t);
    std::copy_n(t, f.eliminated, register_vectors.data() + f.vector);
    const double* g = t + f.eliminated;
    const std::int64_t last_column = own.schur + f.schur + f.schur_step() - 1;
    for (int i = 0; i < f.boundary; ++i) register_schur[at(last_column + i * f.schur_step())] = g[i];
    if (!f.is_exported) continue;
    FrontData& d = data(f.front);
    for_boundary(f.front, [&](int i, std::size_t u) { d.vector[d.full + i] = scales.row[u] * g[i]; });
  }
}

void Hierarchical::State::backward_registers(int group) {
  const RegisterGroup& own = registers.groups[at(group)];
  for (int k = own.front_end; k-- > own.front_begin;) {
    const RegisterFront& f = registers.fronts[at(k)];
    if (k - ahead >= own.front_begin) {
      const RegisterFront& next = registers.fronts[at(k - ahead)];
      fetch(register_factors.data() + next.factor, static_cast<std::int64_t>(next.eliminated) * next.size());
    }
    // Usually both are one run, which is read and written in place.
    double of_boundary[largest_in_registers], of_own[largest_in_registers];
    const double* boundary = of_boundary;
    double* to = of_own;
    const UnknownRun* unknown_runs = registers.unknown_runs.data();
    if (f.boundary_end == f.boundary_begin + 1) {
      boundary = x + unknown_runs[f.boundary_begin].unknown;
    } else {
      for (int r = f.boundary_begin; r < f.boundary_end; ++r)
        std::copy_n(x + unknown_runs[r].unknown, unknown_runs[r].length,
                    of_boundary + unknown_runs[r].row - f.eliminated);
    }
    if (f.own_end == f.own_begin + 1) to = x + unknown_runs[f.own_begin].unknown;
    backward_in_registers(register_factors.data() + f.factor, f.size(), f.eliminated,
                          register_vectors.data() + f.vector, boundary, to);
    if (to != of_own) continue;
    for (int r = f.own_begin; r < f.own_end; ++r)
      std::copy_n(of_own + unknown_runs[r].row, unknown_runs[r].length, x + unknown_runs[r].unknown);
  }
}

/// Left vectors, for null spaces: reads boundaries from `left`, unscaled, and writes the eliminated unknowns there.
void Hierarchical::State::backward_left_registers(int group, std::vector<double>& left) const {
  const RegisterGroup& own = registers.groups[at(group)];
  for (int k = own.front_end; k-- > own.front_begin;) {
    const RegisterFront& f = registers.fronts[at(k)];
    double y[largest_in_registers];
    for (int r = f.boundary_begin; r < f.boundary_end; ++r) {
      const UnknownRun& run = registers.unknown_runs[at(r)];
      std::copy_n(left.data() + run.unknown, run.length, y + run.row);
    }
    backward_left_in_registers(register_factors.data() + f.factor, f.size(), f.eliminated, is_symmetric(), y);
    for (int r = f.own_begin; r < f.own_end; ++r) {
      const UnknownRun& run = registers.unknown_runs[at(r)];
      std::copy_n(y + run.row, run.length, left.data() + run.unknown);
    }
  }
}

}  // namespace bough::solve
