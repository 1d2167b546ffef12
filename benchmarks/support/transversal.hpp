#pragma once
/// Rows of a sparse matrix without structural symmetry, put in an order without zeros on the diagonal.
#include "problem.hpp"

namespace bough::bench {

/// Fraction of the entries beside the diagonal whose mirror image is an entry, too; 1 if there are none.
double find_symmetry(const SparseMatrix& a);

/// Permutes the rows so that no entry of the diagonal is zero: a maximum transversal by btf_maxtrans [Duff 1981, ACM
/// TOMS 7(3), 315], which does not look at values. Returns false, and leaves the matrix as it is, if there is no such
/// order (the matrix is singular) or if SuiteSparse was not found. Precondition: no entry is zero.
bool permute_rows(SparseMatrix& a);

}  // namespace bough::bench
