#pragma once
/// Sparse matrices and vectors as Matrix Market files (Boisvert, Pozo, Remington 1996, NISTIR 5935).
#include <filesystem>
#include <string>
#include <vector>

#include "bough/records/linear_model.hpp"

namespace bough::io {

/// Compressed sparse columns, rows ascending in each. Symmetric: the lower triangle with the diagonal stands for the
/// whole.
struct SparseMatrix {
  int size = 0;
  bool is_symmetric = false;
  std::vector<std::size_t> column_begin;  ///< size + 1
  std::vector<int> row;
  std::vector<double> value;
};

/// Text of a matrix: "coordinate real general" or "symmetric", comments (one line each, without '%'), entries column
/// by column with indices from 1. Numbers read back to the same doubles.
std::string matrix_market_text(const SparseMatrix& matrix, const std::vector<std::string>& comments);
/// The same of any matrix, row by row.
std::string matrix_market_text(const records::SparseEntries& matrix, const std::vector<std::string>& comments);
/// Text of a dense matrix with this number of columns, given column by column: "array real general".
std::string matrix_market_text(const std::vector<double>& values, const std::vector<std::string>& comments,
                               std::size_t num_columns = 1);

}  // namespace bough::io
