/// Eigen's SparseLU and SimplicialLDLT. Both get the matrix permuted beforehand where an order is given.
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include "peer.hpp"

namespace bough::bench {

namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

Matrix make_matrix(const SparseMatrix& a) {
  return Eigen::Map<const Matrix>(a.n, a.n, a.num_entries(), a.column_begin.data(), a.row.data(), a.value.data());
}

/// Stores the permuted problem and permutes right-hand side and solution.
class Permuted {
 public:
  Permuted(const Problem& p, const std::string& ordering) : rhs_(p.rhs) {
    if (ordering.starts_with("node")) order_ = order_nodes(p, ordering);
    b_.resize(p.matrix.n);
    x_.resize(p.matrix.n);
  }
  SparseMatrix apply(const SparseMatrix& a) const { return order_.empty() ? a : permute(a, order_); }
  template <class Solver>
  bool solve(const Solver& solver, std::vector<double>& x) {
    const std::size_t n = rhs_.size();
    for (std::size_t i = 0; i < n; ++i) b_[index(i)] = rhs_[place(i)];
    x_ = solver.solve(b_);
    x.resize(n);
    for (std::size_t i = 0; i < n; ++i) x[place(i)] = x_[index(i)];
    return solver.info() == Eigen::Success;
  }

 private:
  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }
  std::size_t place(std::size_t i) const { return order_.empty() ? i : static_cast<std::size_t>(order_[i]); }
  const std::vector<double>& rhs_;
  std::vector<int> order_;
  Eigen::VectorXd b_, x_;
};

template <class Solver>
class EigenSession final : public Session {
 public:
  EigenSession(const Problem& p, const std::string& ordering, bool lower_only)
      : permuted_(p, ordering),
        matrix_(make_matrix(lower_only ? lower_triangle(permuted_.apply(p.matrix)) : permuted_.apply(p.matrix))) {}
  bool analyze() override {
    solver_.analyzePattern(matrix_);
    return true;
  }
  bool factor() override {
    solver_.factorize(matrix_);
    return solver_.info() == Eigen::Success;
  }
  bool refactor() override { return factor(); }
  bool solve(std::vector<double>& x) override { return permuted_.solve(solver_, x); }
  double factor_entries() const override {
    if constexpr (requires { solver_.nnzL(); })
      return static_cast<double>(solver_.nnzL() + solver_.nnzU()) - static_cast<double>(matrix_.rows());
    else
      return static_cast<double>(solver_.matrixL().nestedExpression().nonZeros() + matrix_.rows());
  }

 private:
  Permuted permuted_;
  Matrix matrix_;
  Solver solver_;
};

std::string version() {
  return std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
         std::to_string(EIGEN_MINOR_VERSION);
}

}  // namespace

Peer make_eigen_lu_peer() {
  return {"eigen_lu", version(),
          [](const Problem&) {
            return std::vector<std::string>{"colamd", "node amd", "node metis", "node bough"};
          },
          [](const Problem& p, const std::string& ordering) -> std::unique_ptr<Session> {
            if (ordering == "colamd")
              return std::make_unique<EigenSession<Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>>>>(p, ordering,
                                                                                                         false);
            return std::make_unique<EigenSession<Eigen::SparseLU<Matrix, Eigen::NaturalOrdering<int>>>>(p, ordering,
                                                                                                        false);
          }};
}

/// LDL^T without pivoting: in an order of scalar unknowns the zero diagonal of a multiplier may become a pivot before
/// anything was added to it.
Peer make_eigen_ldlt_peer() {
  return {
      "eigen_ldlt", version(),
      [](const Problem& p) {
        if (!p.is_symmetric()) return std::vector<std::string>{};
        if (!p.is_definite) return std::vector<std::string>{"node amd", "node metis", "node bough"};
        return std::vector<std::string>{"amd", "node amd", "node metis", "node bough"};
      },
      [](const Problem& p, const std::string& ordering) -> std::unique_ptr<Session> {
        if (ordering == "amd")
          return std::make_unique<EigenSession<Eigen::SimplicialLDLT<Matrix, Eigen::Lower>>>(p, ordering, true);
        return std::make_unique<EigenSession<Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::NaturalOrdering<int>>>>(
            p, ordering, true);
      }};
}

}  // namespace bough::bench
