/// MUMPS, sequential: multifrontal; unsymmetric, symmetric (where it is indefinite) or positive definite.
#include <dmumps_c.h>

#include "peer.hpp"

namespace bough::bench {

namespace {

class MumpsSession final : public Session {
 public:
  MumpsSession(const Problem& p, const std::string& ordering)
      : a_(p.is_symmetric() ? lower_triangle(p.matrix) : p.matrix), rhs_(p.rhs) {
    for (int j = 0; j < a_.n; ++j)
      for (int k = a_.column_begin[at(j)]; k < a_.column_begin[at(j) + 1]; ++k) {
        row_.push_back(a_.row[at(k)] + 1);
        column_.push_back(j + 1);
      }
    id_.sym = !p.is_symmetric() ? 0 : p.is_definite ? 1 : 2;
    id_.par = 1;
    id_.comm_fortran = -987654;  // MPI_COMM_WORLD
    run(-1);
    for (int i : {1, 2, 3, 4}) set(i, i < 4 ? -1 : 0);  // silent
    if (p.is_scaled) {
      set(6, 0);  // no permutation to a large diagonal
      set(8, 0);  // no scaling
    }
    set(10, 0);    // no refinement
    set(14, 100);  // room for delayed pivots [%]
    set(7, ordering == "amd" ? 0 : ordering == "scotch" ? 3 : ordering == "pord" ? 4 : 1);
    if (ordering.starts_with("node")) {
      const std::vector<int> order = order_nodes(p, ordering);
      place_.resize(order.size());
      for (std::size_t i = 0; i < order.size(); ++i) place_[at(order[i])] = static_cast<int>(i) + 1;
      id_.perm_in = place_.data();
    }
    id_.n = a_.n;
    id_.nnz = a_.num_entries();
    id_.irn = row_.data();
    id_.jcn = column_.data();
    id_.a = a_.value.data();
  }
  ~MumpsSession() override { run(-2); }
  MumpsSession(const MumpsSession&) = delete;
  MumpsSession& operator=(const MumpsSession&) = delete;

  bool analyze() override { return run(1); }
  bool factor() override { return run(2); }
  bool refactor() override { return run(2); }
  bool solve(std::vector<double>& x) override {
    x = rhs_;
    id_.rhs = x.data();
    return run(3);
  }
  double memory_bytes() const override { return 1e6 * id_.infog[21]; }
  /// INFOG(29), in millions where it is negative. Symmetric: of L alone.
  double factor_entries() const override {
    const double entries = id_.infog[28];
    return entries < 0.0 ? -1e6 * entries : entries;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  void set(int number, int value) { id_.icntl[number - 1] = value; }
  bool run(int job) {
    id_.job = job;
    dmumps_c(&id_);
    return id_.infog[0] >= 0;
  }
  SparseMatrix a_;
  const std::vector<double>& rhs_;
  std::vector<int> row_, column_, place_;
  DMUMPS_STRUC_C id_{};
};

}  // namespace

Peer make_mumps_peer() {
  return {"mumps", MUMPS_VERSION,
          [](const Problem&) {
            return std::vector<std::string>{"scotch", "amd", "pord", "node amd", "node metis", "node bough"};
          },
          [](const Problem& p, const std::string& ordering) { return std::make_unique<MumpsSession>(p, ordering); },
          true};
}

}  // namespace bough::bench
