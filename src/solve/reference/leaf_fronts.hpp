#pragma once
/// The leaves of the tree condensed to their boundaries, for the forms with global multipliers. Internal to solve.
#include <vector>

#include "dense.hpp"
#include "element_store.hpp"

namespace bough::solve {

/// Eliminates one front after the other in scalar arithmetic, as laid out by the tree. A leaf's condensed matrix
/// contains the unknowns whose pivots were rejected in it (first) and those of its boundary blocks. Leaves are
/// independent: functions for different leaves may run at the same time.
class LeafFronts {
 public:
  LeafFronts(const ElementStore& elements, const tree::Tree& tree);

  /// False if an entry is not finite. Allocates.
  bool factor(tree::SubdomainId leaf, const Scales& scales, const PivotRule& rule);
  int num_refused(tree::SubdomainId leaf) const { return top(leaf).full - top(leaf).pivots; }
  int num_kept(tree::SubdomainId leaf) const { return top(leaf).size - top(leaf).pivots; }
  /// Global unknowns of the rejected rows and columns.
  const int* refused_rows(tree::SubdomainId leaf) const { return top(leaf).rows.data() + top(leaf).pivots; }
  const int* refused_columns(tree::SubdomainId leaf) const { return top(leaf).columns.data() + top(leaf).pivots; }
  double condensed(tree::SubdomainId leaf, int i, int j) const;

  /// Condenses the loads of the interior unknowns (b: all unknowns, scaled). The result, num_kept entries, is valid
  /// until the next call.
  const double* forward(tree::SubdomainId leaf, const double* b);
  /// Sets the load of the interior to zero, as for null vectors.
  void clear_load(tree::SubdomainId leaf);
  /// Computes the interior unknowns from the kept ones (x: all unknowns, scaled).
  void backward(tree::SubdomainId leaf, double* x);
  /// The same for vectors y with y^T A = 0 in the interior.
  void backward_left(tree::SubdomainId leaf, double* y);

 private:
  struct Numbers {
    std::vector<double> a, load, work;
    std::vector<int> rows, columns, row_from;
    int size = 0, full = 0, pivots = 0;
  };
  const Numbers& top(tree::SubdomainId leaf) const {
    return fronts_[static_cast<std::size_t>(tree_.subdomains[static_cast<std::size_t>(leaf)].top())];
  }
  void assemble(tree::FrontId f, const Scales& scales);
  template <class Add>
  void for_children(tree::FrontId f, Add&& add) const;

  const ElementStore& elements_;
  const tree::Tree& tree_;
  std::vector<Numbers> fronts_;
};

}  // namespace bough::solve
