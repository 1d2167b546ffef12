#include "bough/step/krylov.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace bough::step {

namespace {

constexpr double no_value = 1e-13;      ///< part of the largest value below which there is none but round-off
constexpr double nothing_left = 1e-12;  ///< part of A v outside of the space that may be round-off

double product_of(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

void subtract_part(double factor, const std::vector<double>& x, std::vector<double>& from) {
  for (std::size_t i = 0; i < x.size(); ++i) from[i] -= factor * x[i];
}

}  // namespace

void Krylov::lock(const Vector& x) { locked_.push_back(x); }

/// x^T B x; B x stays in weighed_. A failure counts as zero.
double Krylov::square(const Vector& x) { return weigh_(x, weighed_) ? std::max(0.0, product_of(x, weighed_)) : 0.0; }

bool Krylov::normalise(Vector& x) {
  for (int repeated = 0; repeated < 2; ++repeated) {
    const double before = std::sqrt(square(x));
    for (const Vector& other : locked_) subtract_part(product_of(other, weighed_), other, x);
    const double length = std::sqrt(square(x));
    if (!(length > nothing_left * before) || !std::isfinite(length)) return false;
    for (double& value : x) value /= length;
  }
  return true;
}

double Krylov::stretch() const { return std::sqrt(product_of(columns_.front(), columns_.front())); }

bool Krylov::begin(const Vector& x) {
  basis_.clear();
  columns_.clear();
  largest_ = 0.0;
  is_invariant_ = false;
  // What lies along locked vectors would grow most, and its round-off with it: it is removed before. The second
  // application brings into the range of A what round-off of the first has left outside.
  Vector first = x, next;
  for (int repeated = 0; repeated < 2; ++repeated) {
    if (!normalise(first) || !apply_(first, next)) return false;
    first.swap(next);
  }
  if (!normalise(first)) return false;
  basis_.push_back(std::move(first));
  return true;
}

bool Krylov::extend(int size) {
  Vector next;
  while (static_cast<int>(columns_.size()) < size && !is_invariant_) {
    if (!apply_(basis_.back(), next)) return false;
    Vector column(basis_.size() + 1, 0.0);
    for (int repeated = 0; repeated < 2; ++repeated) {
      const double before = std::sqrt(square(next));
      if (repeated == 0) largest_ = std::max(largest_, before);
      for (const Vector& other : locked_) subtract_part(product_of(other, weighed_), other, next);
      for (std::size_t i = 0; i < basis_.size(); ++i) {
        const double along = product_of(basis_[i], weighed_);
        column[i] += along;
        subtract_part(along, basis_[i], next);
      }
    }
    const double rest = column.back() = std::sqrt(square(next));
    columns_.push_back(std::move(column));
    if (!std::isfinite(rest)) return false;
    is_invariant_ = !(rest > nothing_left * largest_);
    if (is_invariant_) break;
    for (double& value : next) value /= rest;
    basis_.push_back(next);
  }
  return true;
}

std::vector<Krylov::Ritz> Krylov::eigenvalues(bool symmetric) const {
  const auto m = static_cast<Eigen::Index>(columns_.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index j = 0; j < m; ++j)
    for (Eigen::Index i = 0; i <= std::min(j + 1, m - 1); ++i)
      H(i, j) = columns_[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
  if (symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (H + H.transpose()));
    values = solver.eigenvalues().cast<std::complex<double>>();
    vectors = solver.eigenvectors().cast<std::complex<double>>();
  } else {
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(H);
    if (solver.info() != Eigen::Success) return {};
    values = solver.eigenvalues();
    vectors = solver.eigenvectors();
  }
  std::vector<Ritz> all(static_cast<std::size_t>(m));
  const double last = m > 0 && !is_invariant_ ? columns_.back().back() : 0.0;
  for (Eigen::Index k = 0; k < m; ++k) {
    const Eigen::VectorXcd unit = vectors.col(k).normalized();
    all[static_cast<std::size_t>(k)] = {values[k], {unit.data(), unit.data() + m}, last * std::abs(unit[m - 1])};
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Ritz& a, const Ritz& b) { return std::abs(a.value) > std::abs(b.value); });
  const double least = all.empty() ? 0.0 : no_value * std::abs(all.front().value);
  std::erase_if(all, [least](const Ritz& ritz) { return !(std::abs(ritz.value) > least); });
  return all;
}

std::vector<std::complex<double>> Krylov::vector_of(const Ritz& ritz) const {
  std::vector<std::complex<double>> x(basis_.front().size());
  for (std::size_t k = 0; k < ritz.combination.size(); ++k)
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += ritz.combination[k] * basis_[k][i];
  return x;
}

}  // namespace bough::step
