#pragma once
/// Scales of fronts in registers. Internal to solve.
#include <cstdint>
#include <vector>

#include "element_store.hpp"
#include "register_kernels.hpp"
#include "shared_numbers.hpp"

namespace bough::solve {

/// RegisterScales of every front; fronts whose scales are the same share them.
class RegisterScaleStore {
 public:
  /// Room for scales of all fronts, if they all should differ.
  explicit RegisterScaleStore(const RegisterPlan& plan);
  /// Takes the scales of all fronts of that plan anew. No allocation.
  /// least: what pivots have to reach, rows and columns scaled.
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
