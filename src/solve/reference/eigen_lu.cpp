/// Eigen's SparseLU with the four functions of a backend.
#include <Eigen/SparseLU>

#include "sparse_matrix.hpp"

namespace bough::solve {

struct EigenLu::Impl {
  Eigen::SparseLU<SparseMatrix, Eigen::COLAMDOrdering<int>> lu;
  bool analyzed = false;
};

EigenLu::EigenLu() : impl_(std::make_unique<Impl>()) {}
EigenLu::~EigenLu() = default;
EigenLu::EigenLu(EigenLu&&) noexcept = default;
EigenLu& EigenLu::operator=(EigenLu&&) noexcept = default;

bool EigenLu::factor(const SparseMatrix& a) {
  if (!impl_->analyzed) impl_->lu.analyzePattern(a);
  impl_->analyzed = true;
  impl_->lu.factorize(a);
  return impl_->lu.info() == Eigen::Success;
}

bool EigenLu::solve(const double* b, double* x) {
  const Eigen::Index n = impl_->lu.rows();
  Eigen::Map<Eigen::VectorXd>(x, n) = impl_->lu.solve(Eigen::Map<const Eigen::VectorXd>(b, n));
  return impl_->lu.info() == Eigen::Success;
}

/// A bound from the fill: every entry of L is multiplied with a row of U of mean length.
double EigenLu::flops() const {
  const auto n = static_cast<double>(impl_->lu.rows());
  return n > 0.0 ? 2.0 * static_cast<double>(impl_->lu.nnzL()) * static_cast<double>(impl_->lu.nnzU()) / n : 0.0;
}

std::int64_t EigenLu::memory_bytes() const {
  return static_cast<std::int64_t>(impl_->lu.nnzL() + impl_->lu.nnzU()) *
         static_cast<std::int64_t>(sizeof(double) + sizeof(int));
}

}  // namespace bough::solve
