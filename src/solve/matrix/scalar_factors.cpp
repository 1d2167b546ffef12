#include "scalar_factors.hpp"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bough/blocks/at.hpp"
#ifdef BOUGH_HAS_KLU
#include <klu.h>
#endif

namespace bough::solve {

std::vector<int> minimum_degree_order(const SparseColumns& a) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  const Matrix whole =
      Eigen::Map<const Matrix>(a.n, a.n, a.num_entries(), a.column_begin.data(), a.row.data(), a.value.data());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(whole.selfadjointView<Eigen::Lower>(), order);
  return {order.indices().data(), order.indices().data() + order.size()};
}

ScalarLdlt::ScalarLdlt(const SparseColumns& a, const std::vector<int>& order) : place_(at(a.n)), upper_(a.n, a.n) {
  for (int i = 0; i < a.n; ++i) place_[at(order[at(i)])] = i;
  std::vector<int> begin(at(a.n) + 1, 0), row;
  std::vector<std::pair<int, int>> column;  // row and entry of the matrix given
  for (int j = 0; j < a.n; ++j) {
    const std::size_t given = at(order[at(j)]);
    column.clear();
    for (int k = a.column_begin[given]; k < a.column_begin[given + 1]; ++k)
      if (place_[at(a.row[at(k)])] <= j) column.emplace_back(place_[at(a.row[at(k)])], k);
    std::sort(column.begin(), column.end());
    for (const auto& [i, k] : column) {
      row.push_back(i);
      from_.push_back(k);
    }
    begin[at(j) + 1] = static_cast<int>(row.size());
  }
  const std::vector<double> ones(row.size(), 1.0);
  upper_ =
      Eigen::Map<const Matrix>(a.n, a.n, static_cast<Eigen::Index>(row.size()), begin.data(), row.data(), ones.data());
  factor_.analyzePattern(upper_);
  // Entries of the columns of L by the elimination tree [Davis 2006, Direct Methods for Sparse Linear Systems, 4.1].
  std::vector<int> parent(at(a.n), -1), last(at(a.n), -1), count(at(a.n), 0);
  for (int j = 0; j < a.n; ++j) {
    last[at(j)] = j;
    for (int k = begin[at(j)]; k < begin[at(j) + 1]; ++k)
      for (int i = row[at(k)]; last[at(i)] != j; i = parent[at(i)]) {
        if (parent[at(i)] < 0) parent[at(i)] = j;
        ++count[at(i)];
        last[at(i)] = j;
      }
  }
  for (const int c : count) {
    entries_ += 1.0 + c;
    flops_ += static_cast<double>(c) * (c + 2.0);
  }
  seconds_ = scalar_seconds(a, entries_, flops_);
}

bool ScalarLdlt::factor(std::span<const double> values) {
  double* const to = upper_.valuePtr();
  for (std::size_t k = 0; k < from_.size(); ++k) to[k] = values[at(from_[k])];
  factor_.factorize(upper_);
  return factor_.info() == Eigen::Success && factor_.vectorD().allFinite();
}

void ScalarLdlt::solve(const double* b, double* x) {
  work_.resize(static_cast<Eigen::Index>(place_.size()));
  for (std::size_t i = 0; i < place_.size(); ++i) work_[place_[i]] = b[i];
  factor_.matrixL().solveInPlace(work_);
  work_.array() /= factor_.vectorD().array();
  factor_.matrixU().solveInPlace(work_);
  for (std::size_t i = 0; i < place_.size(); ++i) x[i] = work_[place_[i]];
}

double ScalarLdlt::pivot_ratio() const {
  const Eigen::VectorXd sizes = factor_.vectorD().cwiseAbs();
  return sizes.size() > 0 ? sizes.minCoeff() / sizes.maxCoeff() : 1.0;
}

#ifdef BOUGH_HAS_KLU

struct ScalarLu::Impl {
  klu_common common{};
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  double flops = 0.0, seconds = 0.0;

  void release() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
  bool is_sound() {
    return common.status == KLU_OK && klu_rcond(symbolic, numeric, &common) != 0 && common.rcond > 0.0;
  }
};

namespace {
// KLU takes pointers to non-const.
int* begin_of(const SparseColumns& a) { return const_cast<int*>(a.column_begin.data()); }
int* row_of(const SparseColumns& a) { return const_cast<int*>(a.row.data()); }
double* value_of(const SparseColumns& a) { return const_cast<double*>(a.value.data()); }
}  // namespace

bool ScalarLu::is_available() { return true; }

ScalarLu::ScalarLu(const SparseColumns& a, const std::vector<int>& order) : impl_(std::make_unique<Impl>()) {
  constexpr int given = 2;
  for (const int ordering : {0, 1, given}) {  // AMD, COLAMD
    Impl trial;
    klu_defaults(&trial.common);
    trial.common.ordering = ordering;
    std::vector<int> columns = order;
    trial.symbolic = ordering == given
                         ? klu_analyze_given(a.n, begin_of(a), row_of(a), columns.data(), columns.data(), &trial.common)
                         : klu_analyze(a.n, begin_of(a), row_of(a), &trial.common);
    if (trial.symbolic != nullptr)
      trial.numeric = klu_factor(begin_of(a), row_of(a), value_of(a), trial.symbolic, &trial.common);
    const bool is_regular = trial.numeric != nullptr && trial.is_sound();
    if (is_regular) {
      klu_flops(trial.symbolic, trial.numeric, &trial.common);
      trial.flops = trial.common.flops;
      const klu_numeric& factors = *trial.numeric;
      trial.seconds =
          scalar_seconds(a, static_cast<double>(factors.lnz) + factors.unz + trial.symbolic->nzoff, trial.flops);
    }
    if (is_regular && (impl_->numeric == nullptr || trial.seconds < impl_->seconds)) std::swap(*impl_, trial);
    trial.release();
  }
}

ScalarLu::~ScalarLu() { impl_->release(); }

bool ScalarLu::is_regular() const { return impl_->numeric != nullptr; }

bool ScalarLu::factor(const SparseColumns& a, bool with_new_pivots) {
  Impl& s = *impl_;
  if (s.symbolic == nullptr) return false;
  if (!with_new_pivots && s.numeric != nullptr &&
      klu_refactor(begin_of(a), row_of(a), value_of(a), s.symbolic, s.numeric, &s.common) != 0 && s.is_sound())
    return true;
  klu_free_numeric(&s.numeric, &s.common);
  s.numeric = klu_factor(begin_of(a), row_of(a), value_of(a), s.symbolic, &s.common);
  return s.numeric != nullptr && s.is_sound();
}

void ScalarLu::solve(const double* b, double* x) {
  const int n = impl_->symbolic->n;
  if (x != b) std::copy(b, b + n, x);
  klu_solve(impl_->symbolic, impl_->numeric, n, 1, x, &impl_->common);
}

double ScalarLu::flops() const { return impl_->flops; }
double ScalarLu::seconds() const { return impl_->seconds; }
double ScalarLu::pivot_ratio() const { return impl_->common.rcond; }
double ScalarLu::memory_bytes() const { return static_cast<double>(impl_->common.memusage); }

#else

struct ScalarLu::Impl {};
bool ScalarLu::is_available() { return false; }
ScalarLu::ScalarLu(const SparseColumns&, const std::vector<int>&) {}
ScalarLu::~ScalarLu() = default;
bool ScalarLu::is_regular() const { return false; }
bool ScalarLu::factor(const SparseColumns&, bool) { return false; }
void ScalarLu::solve(const double*, double*) {}
double ScalarLu::flops() const { return 0.0; }
double ScalarLu::seconds() const { return 0.0; }
double ScalarLu::pivot_ratio() const { return 0.0; }
double ScalarLu::memory_bytes() const { return 0.0; }

#endif

}  // namespace bough::solve
