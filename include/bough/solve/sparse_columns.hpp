#pragma once
/// A sparse matrix by columns.
#include <vector>

namespace bough::solve {

/// Compressed sparse columns, rows ascending in each. A symmetric matrix has the entries of both triangles.
struct SparseColumns {
  int n = 0;                      ///< rows and columns
  std::vector<int> column_begin;  ///< n + 1
  std::vector<int> row;
  std::vector<double> value;
  int num_entries() const { return static_cast<int>(row.size()); }
};

/// Fraction of the entries beside the diagonal whose mirror image is an entry, too; 1 if there are none.
double pattern_symmetry(const SparseColumns& a);

/// An order of the rows in which no entry of the diagonal is zero: new row of every row, by a maximum transversal
/// [Duff 1981, ACM TOMS 7(3), 315], which does not look at values. Empty if there is none (the matrix is singular) or
/// if SuiteSparse was not found. Precondition: no entry is zero.
std::vector<int> rows_of_full_diagonal(const SparseColumns& a);

/// Normwise backward error max_i |b - A x|_i / (|A|_inf |x|_inf + |b|_inf); NaN if x is not finite. residual: b - A x.
double backward_error(const SparseColumns& a, const double* x, const double* b, std::vector<double>& residual);

}  // namespace bough::solve
