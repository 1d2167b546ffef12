#pragma once
/// One sparse matrix from the element matrices, and the libraries that factor it. Internal to solve.
#include <Eigen/SparseCore>
#include <cstdint>
#include <memory>
#include <vector>

#include "element_store.hpp"

namespace bough::solve {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// D_r A D_c as one sparse matrix. The pattern is made once. All diagonal entries are in it, and none between different
/// multipliers of one block, which are zero (blocks::BlockKind::multiplier).
class SparseAssembly {
 public:
  explicit SparseAssembly(const ElementStore& elements);
  /// Sets the values; multipliers' diagonals lowered by `lowered` in their exact scaling. No allocation.
  void assemble(const ElementStore& elements, const Scales& scales, double lowered);
  const SparseMatrix& matrix() const { return matrix_; }
  SparseMatrix& matrix() { return matrix_; }
  /// Of values and their rows.
  std::int64_t memory_bytes() const { return matrix_.nonZeros() * std::int64_t{sizeof(double) + sizeof(int)}; }
  /// max |A - A^T|, scaled. Allocates.
  double asymmetry() const;

 private:
  template <class Visit>
  void for_entries(const ElementStore& elements, Visit&& visit) const;

  SparseMatrix matrix_;
  std::vector<int> unknowns_;  ///< of every element, elements ascending
  std::vector<int> slots_;     ///< place of every entry of every element, row by row; -1: not in the pattern
  std::vector<int> diagonal_;
  std::vector<int> multiplier_block_;  ///< by unknown; -1: a motion
};

/// Eigen's SparseLU. Backends have these four functions: factor, solve (x must not be b), flops, memory_bytes.
class EigenLu {
 public:
  EigenLu();
  ~EigenLu();
  EigenLu(EigenLu&&) noexcept;
  EigenLu& operator=(EigenLu&&) noexcept;
  bool factor(const SparseMatrix& a);  ///< false: exactly singular
  bool solve(const double* b, double* x);
  double flops() const;
  std::int64_t memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

#ifdef BOUGH_HAS_GPL
class Umfpack {
 public:
  Umfpack();
  ~Umfpack();
  Umfpack(Umfpack&&) noexcept;
  Umfpack& operator=(Umfpack&&) noexcept;
  bool factor(const SparseMatrix& a);
  bool solve(const double* b, double* x);
  double flops() const;
  std::int64_t memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// L D L^T without pivoting of the lower triangle: the matrix has to be symmetric and quasi-definite.
class Cholmod {
 public:
  Cholmod();
  ~Cholmod();
  Cholmod(Cholmod&&) noexcept;
  Cholmod& operator=(Cholmod&&) noexcept;
  bool factor(const SparseMatrix& a);
  bool solve(const double* b, double* x);
  double flops() const;
  std::int64_t memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
#endif

}  // namespace bough::solve
