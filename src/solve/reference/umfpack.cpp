/// UMFPACK with the four functions of a backend. Compiled only in builds with BOUGH_WITH_GPL.
#include <umfpack.h>

#include "sparse_matrix.hpp"

namespace bough::solve {

struct Umfpack::Impl {
  Impl() { umfpack_di_defaults(control); }
  ~Impl() {
    umfpack_di_free_numeric(&numeric);
    umfpack_di_free_symbolic(&symbolic);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  double control[UMFPACK_CONTROL] = {}, info[UMFPACK_INFO] = {};
  void* symbolic = nullptr;
  void* numeric = nullptr;
  const SparseMatrix* matrix = nullptr;
};

Umfpack::Umfpack() : impl_(std::make_unique<Impl>()) {
  impl_->control[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;  // scaled here
  impl_->control[UMFPACK_IRSTEP] = 0;                  // refined here
}
Umfpack::~Umfpack() = default;
Umfpack::Umfpack(Umfpack&&) noexcept = default;
Umfpack& Umfpack::operator=(Umfpack&&) noexcept = default;

bool Umfpack::factor(const SparseMatrix& a) {
  Impl& s = *impl_;
  const auto n = static_cast<int>(a.rows());
  s.matrix = &a;
  if (s.symbolic == nullptr)
    umfpack_di_symbolic(n, n, a.outerIndexPtr(), a.innerIndexPtr(), a.valuePtr(), &s.symbolic, s.control, s.info);
  if (s.symbolic == nullptr) return false;
  umfpack_di_free_numeric(&s.numeric);
  return umfpack_di_numeric(a.outerIndexPtr(), a.innerIndexPtr(), a.valuePtr(), s.symbolic, &s.numeric, s.control,
                            s.info) == UMFPACK_OK;
}

bool Umfpack::solve(const double* b, double* x) {
  Impl& s = *impl_;
  double told[UMFPACK_INFO] = {};
  return umfpack_di_solve(UMFPACK_A, s.matrix->outerIndexPtr(), s.matrix->innerIndexPtr(), s.matrix->valuePtr(), x, b,
                          s.numeric, s.control, told) == UMFPACK_OK;
}

double Umfpack::flops() const { return impl_->info[UMFPACK_FLOPS]; }
std::int64_t Umfpack::memory_bytes() const {
  return static_cast<std::int64_t>(impl_->info[UMFPACK_NUMERIC_SIZE] * impl_->info[UMFPACK_SIZE_OF_UNIT]);
}

}  // namespace bough::solve
