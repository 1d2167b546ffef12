#pragma once
/// Problems whose matrix comes from a Matrix Market file.
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

/// The problem of a file: the matrix as it is, unscaled; right-hand side A 1. Symmetric if the file says so, definite
/// if a Cholesky factorization succeeds. The graph is the one found from the pattern (solve/matrix_blocks.hpp).
Problem make_problem(const std::filesystem::path& file);

}  // namespace bough::bench
