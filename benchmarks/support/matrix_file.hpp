#pragma once
/// Problems whose matrix comes from a Matrix Market file: blocks and elements are found from the pattern.
#include <filesystem>
#include <string>

#include "problem.hpp"

namespace bough::bench {

struct MatrixFile {
  SparseMatrix matrix;        ///< all entries, also those above the diagonal of a symmetric file; no exact zeros
  bool is_symmetric = false;  ///< as the header says
};

/// Reads "coordinate real|integer general|symmetric" [Boisvert, Pozo, Remington 1996, NISTIR 5935]; entries that are
/// given twice are added. Throws std::runtime_error with file, line and what is wrong.
MatrixFile read_matrix_file(const std::filesystem::path& file);

/// The graph and the element matrices of a sparse matrix A, in the order of its unknowns; a pattern that is not
/// symmetric is completed with zeros.
///   - Blocks: unknowns whose rows and columns have entries in the same places. Unknowns with a zero on the diagonal
///     are multipliers, the others motions.
///   - Elements: a multiplier with all unknowns of its row and column; it joins the element of another one that has
///     them all. The remaining entries are covered by cliques, each grown from an entry that is not covered yet by the
///     block that covers most others, as long as it covers at least half of its entries with the clique. Finite
///     elements are found again in this way, up to a few.
/// Every entry is in one element. Problem::place says where the graph has the unknowns of the matrix.
void add_blocks(Problem& problem);

/// The problem of a file: the matrix as it is, unscaled; right-hand side A 1. Symmetric if the file says so, definite
/// if a Cholesky factorization succeeds. If fewer than half of the entries beside the diagonal have a mirror image,
/// the rows are put in an order without zeros on the diagonal (transversal.hpp).
Problem make_problem(const std::filesystem::path& file);

}  // namespace bough::bench
