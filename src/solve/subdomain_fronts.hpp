#pragma once
/// Fronts of the sub-domains in scalar arithmetic, for the forms that condense sub-domains to more than their Schur
/// complements. Internal to solve.
#include <functional>
#include <utility>
#include <vector>

#include "dense.hpp"
#include "element_store.hpp"

namespace bough::solve {

/// Eliminates one front after the other, as laid out by the tree. A sub-domain's condensed matrix contains the unknowns
/// whose pivots were rejected in it (first) and those of its boundary blocks; a parent assembles it as it stands then.
/// Sub-domains that are not above each other are independent: functions for them may run at the same time.
class SubdomainFronts {
 public:
  /// has_copies: whether sub-domains may have displacements of their own at their boundaries (backward).
  SubdomainFronts(const ElementStore& elements, const tree::Tree& tree, bool has_copies = false);

  /// Elements are changed by this before they are assembled: scaled matrices, row by row.
  void change_elements(std::function<void(int element, std::vector<double>& a)> change) { change_ = std::move(change); }

  /// False if an entry is not finite. Allocates. Precondition: the children of s are factored, if they are assembled.
  bool factor(tree::SubdomainId s, const Scales& scales, const PivotRule& rule);
  int num_refused(tree::SubdomainId s) const { return top(s).full - top(s).pivots; }
  int num_kept(tree::SubdomainId s) const { return top(s).size - top(s).pivots; }
  /// Global unknowns of the rejected rows and columns.
  const int* refused_rows(tree::SubdomainId s) const { return top(s).rows.data() + top(s).pivots; }
  const int* refused_columns(tree::SubdomainId s) const { return top(s).columns.data() + top(s).pivots; }
  double condensed(tree::SubdomainId s, int i, int j) const;
  double& condensed(tree::SubdomainId s, int i, int j);
  /// Of a sub-domain without a boundary: eliminates the rejected unknowns with complete pivoting, all but so many, as
  /// long as pivots reach `least`.
  void eliminate_completely(tree::SubdomainId s, int all_but, double least);

  /// Condenses the loads of the interior unknowns (b: all unknowns, scaled). The result, num_kept entries, is what the
  /// parent adds, and valid until the next call.
  double* forward(tree::SubdomainId s, const double* b);
  /// Sets the load of the interior to zero, as for null vectors.
  void clear_load(tree::SubdomainId s);
  /// Computes the interior unknowns from the kept ones (x: all unknowns, scaled). own: the values at the boundary,
  /// instead of those in x.
  void backward(tree::SubdomainId s, double* x, const double* own = nullptr);
  /// The same for vectors y with y^T A = 0 in the interior.
  void backward_left(tree::SubdomainId s, double* y);
  std::size_t num_doubles() const;

 private:
  struct Numbers {
    std::vector<double> a, load, work;
    std::vector<int> rows, columns, row_from;
    std::vector<int> own_place;  ///< by boundary unknown: its place in the boundary of the sub-domain, or -1
    int size = 0, full = 0, pivots = 0;
  };
  const Numbers& top(tree::SubdomainId s) const {
    return fronts_[static_cast<std::size_t>(tree_.subdomains[static_cast<std::size_t>(s)].top())];
  }
  Numbers& top(tree::SubdomainId s) { return const_cast<Numbers&>(std::as_const(*this).top(s)); }
  void find_own_places();
  void assemble(tree::FrontId f, const Scales& scales);
  template <class Add>
  void for_children(tree::FrontId f, Add&& add) const;

  const ElementStore& elements_;
  const tree::Tree& tree_;
  std::vector<Numbers> fronts_;
  std::function<void(int, std::vector<double>&)> change_;
};

}  // namespace bough::solve
