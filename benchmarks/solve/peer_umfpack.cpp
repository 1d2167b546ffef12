/// UMFPACK: unsymmetric multifrontal. Every factorization makes a new numeric object, since no function reuses one.
#include <umfpack.h>

#include "peer.hpp"

namespace bough::bench {

namespace {

class UmfpackSession final : public Session {
 public:
  UmfpackSession(const Problem& p, const std::string& ordering) : a_(p.matrix), rhs_(p.rhs) {
    umfpack_di_defaults(control_);
    if (p.is_scaled) control_[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;
    control_[UMFPACK_IRSTEP] = 0;
    control_[UMFPACK_ORDERING] = ordering == "metis" ? UMFPACK_ORDERING_METIS : UMFPACK_ORDERING_AMD;
    if (ordering.starts_with("node")) given_ = order_nodes(p, ordering);
    integers_.resize(p.rhs.size());
    reals_.resize(p.rhs.size());
  }
  ~UmfpackSession() override {
    umfpack_di_free_numeric(&numeric_);
    umfpack_di_free_symbolic(&symbolic_);
  }
  UmfpackSession(const UmfpackSession&) = delete;
  UmfpackSession& operator=(const UmfpackSession&) = delete;

  bool analyze() override {
    const int n = a_.n, *begin = a_.column_begin.data(), *row = a_.row.data();
    if (given_.empty())
      return umfpack_di_symbolic(n, n, begin, row, a_.value.data(), &symbolic_, control_, nullptr) == UMFPACK_OK;
    return umfpack_di_qsymbolic(n, n, begin, row, a_.value.data(), given_.data(), &symbolic_, control_, nullptr) ==
           UMFPACK_OK;
  }
  bool factor() override {
    umfpack_di_free_numeric(&numeric_);
    return umfpack_di_numeric(a_.column_begin.data(), a_.row.data(), a_.value.data(), symbolic_, &numeric_, control_,
                              info_) == UMFPACK_OK;
  }
  bool refactor() override { return factor(); }
  bool solve(std::vector<double>& x) override {
    x.resize(rhs_.size());
    return umfpack_di_wsolve(UMFPACK_A, a_.column_begin.data(), a_.row.data(), a_.value.data(), x.data(), rhs_.data(),
                             numeric_, control_, nullptr, integers_.data(), reals_.data()) == UMFPACK_OK;
  }

  double memory_bytes() const override {
    return info_[UMFPACK_SIZE_OF_UNIT] * (info_[UMFPACK_NUMERIC_SIZE] + info_[UMFPACK_SYMBOLIC_SIZE]);
  }

 private:
  const SparseMatrix& a_;
  const std::vector<double>& rhs_;
  std::vector<int> given_, integers_;
  std::vector<double> reals_;
  double control_[UMFPACK_CONTROL], info_[UMFPACK_INFO] = {};
  void* symbolic_ = nullptr;
  void* numeric_ = nullptr;
};

}  // namespace

Peer make_umfpack_peer() {
  return {"umfpack",
          std::to_string(UMFPACK_MAIN_VERSION) + "." + std::to_string(UMFPACK_SUB_VERSION) + "." +
              std::to_string(UMFPACK_SUBSUB_VERSION),
          [](const Problem&) {
            return std::vector<std::string>{"amd", "metis", "node amd", "node metis", "node bough"};
          },
          [](const Problem& p, const std::string& ordering) { return std::make_unique<UmfpackSession>(p, ordering); },
          true};
}

}  // namespace bough::bench
