/// KLU.
#include <klu.h>

#include "peer.hpp"

namespace bough::bench {

namespace {

class KluSession final : public Session {
 public:
  KluSession(const Problem& p, const std::string& ordering) : a_(p.matrix), rhs_(p.rhs) {
    klu_defaults(&common_);
    if (p.is_scaled) common_.scale = 0;
    common_.ordering = ordering == "colamd" ? 1 : 0;
    if (ordering.starts_with("node")) given_ = order_nodes(p, ordering);
  }
  ~KluSession() override {
    klu_free_numeric(&numeric_, &common_);
    klu_free_symbolic(&symbolic_, &common_);
  }
  KluSession(const KluSession&) = delete;
  KluSession& operator=(const KluSession&) = delete;

  bool analyze() override {
    symbolic_ = given_.empty() ? klu_analyze(a_.n, begin(), row(), &common_)
                               : klu_analyze_given(a_.n, begin(), row(), given_.data(), given_.data(), &common_);
    return symbolic_ != nullptr;
  }
  bool factor() override {
    numeric_ = klu_factor(begin(), row(), value(), symbolic_, &common_);
    return numeric_ != nullptr && common_.status == KLU_OK;
  }
  bool refactor() override { return klu_refactor(begin(), row(), value(), symbolic_, numeric_, &common_) != 0; }
  bool solve(std::vector<double>& x) override {
    x = rhs_;
    return klu_solve(symbolic_, numeric_, a_.n, 1, x.data(), &common_) != 0;
  }
  double factor_entries() const override {
    return static_cast<double>(numeric_->lnz) + numeric_->unz + symbolic_->nzoff - a_.n;
  }

  double memory_bytes() const override { return static_cast<double>(common_.memusage); }

 private:
  int* begin() const { return const_cast<int*>(a_.column_begin.data()); }  // KLU takes pointers to non-const
  int* row() const { return const_cast<int*>(a_.row.data()); }
  double* value() const { return const_cast<double*>(a_.value.data()); }
  const SparseMatrix& a_;
  const std::vector<double>& rhs_;
  std::vector<int> given_;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace

Peer make_klu_peer() {
  return {"klu",
          std::to_string(KLU_MAIN_VERSION) + "." + std::to_string(KLU_SUB_VERSION) + "." +
              std::to_string(KLU_SUBSUB_VERSION),
          [](const Problem&) {
            return std::vector<std::string>{"amd", "colamd", "node amd", "node metis", "node bough"};
          },
          [](const Problem& p, const std::string& ordering) { return std::make_unique<KluSession>(p, ordering); }};
}

}  // namespace bough::bench
