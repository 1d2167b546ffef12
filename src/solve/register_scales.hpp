#pragma once
/// Scales of fronts in registers. Internal to solve.
#include <cstdint>
#include <vector>

#include "element_store.hpp"
#include "register_kernels.hpp"
#include "shared_numbers.hpp"

namespace bough::solve {

/// RegisterScales of every front; fronts with equal scales share them.
class RegisterScaleStore {
 public:
  /// Reserves memory for the scales of all fronts if all differ.
  explicit RegisterScaleStore(const RegisterPlan& plan);
  /// Computes the scales of all fronts of the plan anew. No allocation. least: lower limit of pivots, rows and columns
  /// scaled.
  void set(const RegisterPlan& plan, const Scales& scales, double least);
  RegisterScales of(const RegisterFront& f, int index) const {
    const double* column = numbers_.of(index);
    return {column, column + f.step(), column + f.step() + f.eliminated};
  }
  std::int64_t memory_bytes() const { return numbers_.memory_bytes(); }

 private:
  SharedNumbers numbers_;
};

}  // namespace bough::solve
