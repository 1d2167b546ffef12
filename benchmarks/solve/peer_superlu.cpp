/// SuperLU, sequential: supernodal, with partial pivoting that prefers the diagonal if the ordering is that of A + A^T.
#include <slu_ddefs.h>

#include <algorithm>

#include "peer.hpp"

namespace bough::bench {

namespace {

class SuperLuSession final : public Session {
 public:
  SuperLuSession(const Problem& p, const std::string& ordering) : a_(p.matrix), rhs_(p.rhs), given_(p.matrix.value) {
    const std::size_t n = p.rhs.size();
    set_default_options(&options_);
    options_.Equil = p.is_scaled ? NO : YES;
    options_.IterRefine = NOREFINE;
    options_.ConditionNumber = NO;
    options_.PivotGrowth = NO;
    options_.PrintStat = NO;
    options_.ColPerm = ordering == "colamd" ? COLAMD : ordering == "mmd" ? MMD_AT_PLUS_A : MY_PERMC;
    if (ordering != "colamd") {
      options_.SymmetricMode = YES;
      options_.DiagPivotThresh = 0.01;
    }
    column_order_.resize(n);
    row_order_.resize(n);
    tree_.resize(n);
    scale_.assign(2 * n, 1.0);
    b_.resize(n);
    x_.resize(n);
    if (ordering.starts_with("node")) {
      const std::vector<int> order = order_nodes(p, ordering);
      for (std::size_t i = 0; i < n; ++i) column_order_[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
    }
    dCreate_CompCol_Matrix(&matrix_, a_.n, a_.n, a_.num_entries(), a_.value.data(), a_.row.data(),
                           a_.column_begin.data(), SLU_NC, SLU_D, SLU_GE);
    dCreate_Dense_Matrix(&rhs_matrix_, a_.n, 1, b_.data(), a_.n, SLU_DN, SLU_D, SLU_GE);
    dCreate_Dense_Matrix(&x_matrix_, a_.n, 1, x_.data(), a_.n, SLU_DN, SLU_D, SLU_GE);
    StatInit(&statistics_);
  }
  ~SuperLuSession() override {
    if (is_factored_) {
      Destroy_SuperNode_Matrix(&lower_);
      Destroy_CompCol_Matrix(&upper_);
    }
    for (SuperMatrix* m : {&matrix_, &rhs_matrix_, &x_matrix_}) Destroy_SuperMatrix_Store(m);
    StatFree(&statistics_);
  }
  SuperLuSession(const SuperLuSession&) = delete;
  SuperLuSession& operator=(const SuperLuSession&) = delete;

  bool analyze() override { return true; }  // the driver orders at the first factorization
  bool factor() override {
    is_factored_ = run(DOFACT);
    return is_factored_;
  }
  /// An equilibrated matrix has changed: the driver equilibrates its values again.
  bool refactor() override {
    std::copy(given_.begin(), given_.end(), a_.value.begin());
    return run(SamePattern_SameRowPerm);
  }
  bool solve(std::vector<double>& x) override {
    b_ = rhs_;
    if (!run(FACTORED)) return false;
    x = x_;
    return true;
  }
  double memory_bytes() const override { return memory_.total_needed; }

 private:
  /// Without columns of the right-hand side the driver factors alone.
  bool run(fact_t how) {
    options_.Fact = how;
    rhs_matrix_.ncol = x_matrix_.ncol = how == FACTORED ? 1 : 0;
    double growth = 0.0, condition = 0.0, forward = 0.0, backward = 0.0;
    mem_usage_t memory{};
    int info = 0;
    dgssvx(&options_, &matrix_, column_order_.data(), row_order_.data(), tree_.data(), &equilibrated_, scale_.data(),
           scale_.data() + a_.n, &lower_, &upper_, nullptr, 0, &rhs_matrix_, &x_matrix_, &growth, &condition, &forward,
           &backward, &global_, &memory, &statistics_, &info);
    if (how != FACTORED) memory_ = memory;
    return info == 0;
  }

  SparseMatrix a_;
  const std::vector<double>& rhs_;
  superlu_options_t options_;
  std::vector<int> column_order_, row_order_, tree_;
  std::vector<double> scale_, b_, x_;
  SuperMatrix matrix_{}, rhs_matrix_{}, x_matrix_{}, lower_{}, upper_{};
  GlobalLU_t global_{};
  mem_usage_t memory_{};
  char equilibrated_ = 'N';
  std::vector<double> given_;  ///< values of the matrix
  SuperLUStat_t statistics_{};
  bool is_factored_ = false;
};

}  // namespace

Peer make_superlu_peer() {
  return {"superlu",
          std::to_string(SUPERLU_MAJOR_VERSION) + "." + std::to_string(SUPERLU_MINOR_VERSION) + "." +
              std::to_string(SUPERLU_PATCH_VERSION),
          [](const Problem&) {
            return std::vector<std::string>{"mmd", "colamd", "node amd", "node metis", "node bough"};
          },
          [](const Problem& p, const std::string& ordering) { return std::make_unique<SuperLuSession>(p, ordering); },
          true};
}

}  // namespace bough::bench
