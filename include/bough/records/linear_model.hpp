#pragma once
/// The linearised equations of a scene between inputs u and outputs y. Plain data.
#include <string>
#include <vector>

namespace bough::records {

/// A variable of a linear model.
struct LinearVariable {
  std::string name;
  std::string unit;  ///< empty: a pure number
};

/// Entries (row, column, value) of a sparse matrix, row after row, columns ascending in each.
struct SparseEntries {
  int rows = 0, columns = 0;
  std::vector<int> row, column;
  std::vector<double> value;
};

/// A matrix, row after row.
struct DenseMatrix {
  int rows = 0, columns = 0;
  std::vector<double> value;
};

/// Deviations from the state that the equations are about:
///   E x' = A x + B u,  y = C x + D u
/// and, where x has redundant parts that constraints tie together, the same in minimal coordinates z, x = T z + U u:
///   z' = A z + B u,  y = C z + D u
struct LinearModel {
  std::string about;
  std::vector<LinearVariable> inputs, outputs, states;
  SparseEntries E, A, B, C, D;
  struct Minimal {
    std::vector<LinearVariable> states;
    DenseMatrix A, B, C, D, T;
  };
  Minimal minimal;
  std::string why_not_minimal;  ///< empty: there are minimal coordinates
};

}  // namespace bough::records
