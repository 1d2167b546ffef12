/// CHOLMOD: supernodal L L^T (or simplicial, by its own choice) of positive definite matrices; simplicial L D L^T of
/// indefinite ones, in an order without zero pivots.
#include <cholmod.h>

#include "peer.hpp"

namespace bough::bench {

namespace {

class CholmodSession final : public Session {
 public:
  CholmodSession(const Problem& p, const std::string& ordering) : lower_(lower_triangle(p.matrix)), rhs_(p.rhs) {
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    if (!p.is_definite) common_.supernodal = CHOLMOD_SIMPLICIAL;
    common_.method[0].ordering = ordering == "amd" ? CHOLMOD_AMD : ordering == "metis" ? CHOLMOD_METIS : CHOLMOD_GIVEN;
    if (ordering.starts_with("node")) given_ = order_nodes(p, ordering);
    const auto n = static_cast<std::size_t>(lower_.n);
    matrix_.nrow = matrix_.ncol = n;
    matrix_.nzmax = lower_.row.size();
    matrix_.p = lower_.column_begin.data();
    matrix_.i = lower_.row.data();
    matrix_.x = lower_.value.data();
    matrix_.stype = -1;
    matrix_.itype = CHOLMOD_INT;
    matrix_.xtype = CHOLMOD_REAL;
    matrix_.dtype = CHOLMOD_DOUBLE;
    matrix_.sorted = matrix_.packed = 1;
    b_.nrow = b_.nzmax = b_.d = n;
    b_.ncol = 1;
    b_.x = rhs_.data();
    b_.xtype = CHOLMOD_REAL;
    b_.dtype = CHOLMOD_DOUBLE;
  }
  ~CholmodSession() override {
    cholmod_free_factor(&factor_, &common_);
    for (cholmod_dense** d : {&x_, &y_, &e_}) cholmod_free_dense(d, &common_);
    cholmod_finish(&common_);
  }
  CholmodSession(const CholmodSession&) = delete;
  CholmodSession& operator=(const CholmodSession&) = delete;

  bool analyze() override {
    factor_ = given_.empty() ? cholmod_analyze(&matrix_, &common_)
                             : cholmod_analyze_p(&matrix_, given_.data(), nullptr, 0, &common_);
    return factor_ != nullptr;
  }
  bool factor() override { return cholmod_factorize(&matrix_, factor_, &common_) != 0 && common_.status == CHOLMOD_OK; }
  bool refactor() override { return factor(); }
  bool solve(std::vector<double>& x) override {
    if (cholmod_solve2(CHOLMOD_A, factor_, &b_, nullptr, &x_, nullptr, &y_, &e_, &common_) == 0) return false;
    const auto* first = static_cast<const double*>(x_->x);
    x.assign(first, first + lower_.n);
    return true;
  }

  double memory_bytes() const override { return static_cast<double>(common_.memory_inuse); }

 private:
  SparseMatrix lower_;
  std::vector<double> rhs_;
  std::vector<int> given_;
  cholmod_common common_;
  cholmod_sparse matrix_{};
  cholmod_dense b_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *x_ = nullptr, *y_ = nullptr, *e_ = nullptr;
};

}  // namespace

Peer make_cholmod_peer() {
  return {"cholmod",
          std::to_string(CHOLMOD_MAIN_VERSION) + "." + std::to_string(CHOLMOD_SUB_VERSION) + "." +
              std::to_string(CHOLMOD_SUBSUB_VERSION),
          [](const Problem& p) {
            if (!p.is_symmetric()) return std::vector<std::string>{};
            if (!p.is_definite) return std::vector<std::string>{"node amd", "node metis", "node bough"};
            return std::vector<std::string>{"amd", "metis", "node amd", "node metis", "node bough"};
          },
          [](const Problem& p, const std::string& ordering) { return std::make_unique<CholmodSession>(p, ordering); },
          true};
}

}  // namespace bough::bench
