#pragma once
/// Elements in fewer than six unknowns a node: residuals P f and tangents P K P^T, P of each node and the rows of
/// joints that are unknowns. Internal to step.
#include <array>
#include <cstdint>
#include <vector>

#include "bough/plan/plan.hpp"

namespace bough::step {

class Projection {
 public:
  explicit Projection(const plan::Plan& plan);

  /// P f of an element's residual in six unknowns a node and all rows.
  void project_vector(std::size_t element, const double* from, double* to) const;
  /// |P| f of sizes: no smaller than the size of P f.
  void project_sizes(std::size_t element, const double* from, double* to) const;
  /// P K P^T, row-major, returns its size.
  int project_matrix(std::size_t element, const double* from, double* to) const;

 private:
  /// One unknown of an element: up to three entries of the whole one make it.
  struct Unknown {
    std::array<std::int8_t, 3> place{-1, -1, -1};
    std::array<double, 3> weight{};
  };

  std::vector<Unknown> unknowns_;        ///< element after element
  std::vector<std::int64_t> begin_{0};   ///< by element
  std::vector<std::int8_t> whole_size_;  ///< by element: unknowns in six a node
};

}  // namespace bough::step
