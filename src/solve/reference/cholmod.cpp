/// CHOLMOD with the four functions of a backend. Compiled only in builds with BOUGH_WITH_GPL.
#include <cholmod.h>

#include <algorithm>

#include "sparse_matrix.hpp"

namespace bough::solve {

struct Cholmod::Impl {
  Impl() {
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SIMPLICIAL;  // the supernodal code is L L^T only
    common.final_ll = 0;
    common.print = 0;
  }
  ~Impl() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  cholmod_sparse lower(const SparseMatrix& a) const {
    cholmod_sparse s{};
    s.nrow = s.ncol = static_cast<std::size_t>(a.rows());
    s.nzmax = static_cast<std::size_t>(a.nonZeros());
    s.p = const_cast<int*>(a.outerIndexPtr());  // CHOLMOD does not write them
    s.i = const_cast<int*>(a.innerIndexPtr());
    s.x = const_cast<double*>(a.valuePtr());
    s.stype = -1;
    s.itype = CHOLMOD_INT;
    s.xtype = CHOLMOD_REAL;
    s.dtype = CHOLMOD_DOUBLE;
    s.sorted = s.packed = 1;
    return s;
  }
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
};

Cholmod::Cholmod() : impl_(std::make_unique<Impl>()) {}
Cholmod::~Cholmod() = default;
Cholmod::Cholmod(Cholmod&&) noexcept = default;
Cholmod& Cholmod::operator=(Cholmod&&) noexcept = default;

bool Cholmod::factor(const SparseMatrix& a) {
  Impl& s = *impl_;
  cholmod_sparse lower = s.lower(a);
  if (s.factor == nullptr) s.factor = cholmod_analyze(&lower, &s.common);
  if (s.factor == nullptr) return false;
  cholmod_factorize(&lower, s.factor, &s.common);
  return s.common.status == CHOLMOD_OK && s.factor->minor == s.factor->n;
}

bool Cholmod::solve(const double* b, double* x) {
  Impl& s = *impl_;
  cholmod_dense right{};
  right.nrow = right.nzmax = right.d = s.factor->n;
  right.ncol = 1;
  right.x = const_cast<double*>(b);  // CHOLMOD does not write it
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, s.factor, &right, &s.common);
  if (solution == nullptr) return false;
  std::copy_n(static_cast<const double*>(solution->x), right.nrow, x);
  cholmod_free_dense(&solution, &s.common);
  return true;
}

double Cholmod::flops() const { return impl_->common.fl; }
std::int64_t Cholmod::memory_bytes() const {
  return impl_->factor == nullptr ? 0
                                  : static_cast<std::int64_t>(impl_->factor->nzmax * (sizeof(double) + sizeof(int)));
}

}  // namespace bough::solve
