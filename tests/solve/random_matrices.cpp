/// Random matrices shaped like scenes, none left out: the hierarchical solver, lanes on and off, and KLU, against
/// dense LU; and their symmetric parts, factored as such.
///
/// In scaled variables, u = 2^-53, every solution has
///   ratio       |b - A x| / (|A| |x| n u) < 30                             as LAPACK's own tests ask [Anderson et
///     al. 1999, LAWN 41]
///   difference  |x - y| / |y| <= 30 n u cond(A),  cond = | |A^-1| |A| |, maximum norm    [Skeel 1979]
/// y: LU with partial pivoting, refined. cond is estimated from below [Hager 1984], so the bar is rather low than
/// high. Dependent rows: y from A bordered by its null vectors, which are known from how the case is made; solutions
/// are compared without their share in them. KLU solves those with a diagonal on the multipliers and refines; where
/// it tells itself a backward error above 1e-14 it is no oracle, which is counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "random_cases.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double round_off = 0x1p-53;
constexpr double most_ratio = 30.0;

double size_of(const VectorXd& v) { return v.size() > 0 ? v.lpNorm<Eigen::Infinity>() : 0.0; }

/// The reference: bordered, factored, refined.
class Dense {
 public:
  Dense(const MatrixXd& A, const MatrixXd& null_right, const MatrixXd& null_left) : size_(A.rows()) {
    const auto k = null_right.cols();
    bordered_ = MatrixXd::Zero(size_ + k, size_ + k);
    bordered_.topLeftCorner(size_, size_) = A;
    bordered_.topRightCorner(size_, k) = null_left;
    bordered_.bottomLeftCorner(k, size_) = null_right.transpose();
    lu_.compute(bordered_);
  }
  VectorXd solve(const VectorXd& b) const {
    VectorXd full = VectorXd::Zero(bordered_.rows());
    full.head(size_) = b;
    VectorXd x = lu_.solve(full);
    for (int k = 0; k < 2; ++k) x += lu_.solve(full - bordered_ * x);
    return x.head(size_);
  }
  /// 1-norm of (M^-1 diag(|M| 1))^T, by Hager's ascent.
  double skeel_condition() const {
    const VectorXd w = bordered_.cwiseAbs().rowwise().sum();
    const auto n = w.size();
    VectorXd v = VectorXd::Constant(n, 1.0 / static_cast<double>(n));
    double estimate = 0.0;
    for (int sweep = 0; sweep < 5; ++sweep) {
      const VectorXd y = w.cwiseProduct(VectorXd(lu_.transpose().solve(v)));
      if (y.lpNorm<1>() <= estimate) break;
      estimate = y.lpNorm<1>();
      const VectorXd sign = y.unaryExpr([](double t) { return t < 0.0 ? -1.0 : 1.0; });
      Eigen::Index largest = 0;
      VectorXd(lu_.solve(w.cwiseProduct(sign))).cwiseAbs().maxCoeff(&largest);
      v = VectorXd::Unit(n, largest);
    }
    return estimate;
  }

 private:
  Eigen::Index size_;
  MatrixXd bordered_;
  Eigen::PartialPivLU<MatrixXd> lu_;
};

/// What was met over all cases.
struct Tally {
  int cases = 0, dependent = 0, without_klu = 0, sharp = 0, largest = 0;
  int in_lanes[num_case_families] = {}, left[num_case_families] = {};  ///< cases with lanes, and with lanes left
  double ratio = 0.0, difference = 0.0;                                ///< largest; the latter against its bar
};

MatrixXd orthonormal(const MatrixXd& Z) {
  if (Z.cols() == 0) return Z;
  return Eigen::HouseholderQR<MatrixXd>(Z).householderQ() * MatrixXd::Identity(Z.rows(), Z.cols());
}

/// What of the element matrices is taken: see make_definite.
enum class Parts { all, symmetric, definite };

void compare(int number, Parts parts, solve::Symmetry symmetry, Tally& tally) {
  Case c = make_case(number, unknowns_of_case(number));
  const bool is_symmetric = parts != Parts::all;
  if (parts == Parts::symmetric)
    for (MatrixXd& a : c.scene.elements) a = MatrixXd(0.5 * (a + a.transpose()));
  if (parts == Parts::definite) {
    c.scene = make_definite(std::move(c.scene));
    c.copies.clear();
  }
  const int n = c.scene.num_unknowns();
  const std::string what =
      "case " + std::to_string(number) + ", " + c.scene.name + ", " + std::to_string(n) + " unknowns";
  Solved on(c.scene, {.leaf_size = c.leaf_size}, {.symmetry = symmetry});
  Solved off(c.scene, {.leaf_size = c.leaf_size}, {.symmetry = symmetry, .lanes = false});
  for (Solved* s : {&on, &off}) {
    const auto status = s->factor();
    ASSERT_TRUE(status.ok()) << what << ": block " << status.block << ", magnitude " << status.magnitude;
    ASSERT_EQ(status.deficiency, c.deficiency()) << what;
  }
  const Eigen::Map<const VectorXd> row(on.solver.row_scale().data(), n), column(on.solver.column_scale().data(), n);
  const MatrixXd A = on.scaled_dense();
  const MatrixXd Z = c.null_vectors();
  const MatrixXd right = orthonormal(column.cwiseInverse().asDiagonal() * Z);
  const VectorXd random = SceneMaker(static_cast<unsigned>(number)).uniform_matrix(n, 1).col(0);
  const VectorXd b = Z.cols() > 0 ? VectorXd(A * random) : random, rhs = b.cwiseQuotient(row);
  Dense dense(A, right, orthonormal(row.cwiseInverse().asDiagonal() * Z));
  const VectorXd y = dense.solve(b);
  const double bar = 30.0 * n * round_off * dense.skeel_condition();
  const double norm = A.cwiseAbs().rowwise().sum().maxCoeff();
  const auto check = [&](const VectorXd& x, const char* who) {
    VectorXd scaled = x.cwiseQuotient(column);
    const double ratio = size_of(b - A * scaled) / (norm * size_of(scaled) * n * round_off);
    EXPECT_LT(ratio, most_ratio) << what << ", " << who;
    scaled -= right * (right.transpose() * scaled);
    const double difference = size_of(scaled - y) / size_of(y);
    EXPECT_LE(difference, bar) << what << ", " << who;
    tally.ratio = std::max(tally.ratio, ratio);
    tally.difference = std::max(tally.difference, difference / bar);
    return scaled;
  };
  const VectorXd with = check(on.solve(rhs), "lanes on"), without = check(off.solve(rhs), "lanes off");
  EXPECT_LE(size_of(with - without) / size_of(y), bar) << what << ", lanes on and off";
  if (solve::Monolithic::available() && !is_symmetric) {
    solve::Monolithic klu(c.scene.graph, on.tree);
    write_elements(c.scene, klu);
    ASSERT_TRUE(klu.factor(schedule::make_serial_walker()).ok()) << what;
    VectorXd x(n);
    const auto report = klu.solve(schedule::make_serial_walker(), rhs.data(), x.data());
    if (c.deficiency() == 0 || report.backward_error <= 1e-14) {
      check(x, "KLU");
    } else {
      ++tally.without_klu;
    }
  }
  const solve::SolverCounters counters = on.solver.counters();
  EXPECT_EQ(off.solver.counters().fronts_in_lanes, 0) << what;
  ++tally.cases;
  tally.dependent += c.deficiency() > 0 ? 1 : 0;
  tally.sharp += bar < 1e-4 ? 1 : 0;
  tally.largest = std::max(tally.largest, n);
  tally.in_lanes[c.family] += counters.fronts_in_lanes > 0 ? 1 : 0;
  tally.left[c.family] += counters.lanes_left > 0 ? 1 : 0;
}

TEST(RandomMatrices, MatchDenseLuWithinTheirConditionAndSoDoesKlu) {
  Tally tally;
  for (int number = 0; number < num_cases(); ++number) compare(number, Parts::all, solve::Symmetry::general, tally);
  std::printf(
      "  %d cases up to %d unknowns: ratio at most %.2f of 30, difference at most %.3f of its bar; %d bars < 1e-4; %d "
      "without KLU\n",
      tally.cases, tally.largest, tally.ratio, tally.difference, tally.sharp, tally.without_klu);
  for (int f = 0; f < num_case_families; ++f)
    std::printf("  family %d: %d cases in lanes, %d of them left some\n", f, tally.in_lanes[f], tally.left[f]);
  EXPECT_EQ(tally.cases, num_cases());
  EXPECT_GE(tally.sharp, 9 * tally.cases / 10);  // or the bars would hold nothing
  EXPECT_GE(tally.dependent, tally.cases / 5);
  EXPECT_LE(tally.without_klu, tally.cases / 20);
  for (const int f : {8, 9}) {  // equal arms but for one
    EXPECT_GE(tally.in_lanes[f], tally.cases / num_case_families / 4) << f;
    EXPECT_GE(tally.left[f], tally.cases / num_case_families / 4) << f;
  }
}

TEST(RandomMatrices, TheirSymmetricPartsMatchDenseLuToo) {
  constexpr int most_unknowns = 1500;  // the dense reference of the others is above, and takes the time
  Tally tally;
  for (int number = 0; number < num_cases(); ++number)
    if (unknowns_of_case(number) <= most_unknowns) compare(number, Parts::symmetric, solve::Symmetry::symmetric, tally);
  std::printf("  %d symmetric cases up to %d unknowns: ratio at most %.2f of 30, difference at most %.3f of its bar\n",
              tally.cases, tally.largest, tally.ratio, tally.difference);
  EXPECT_GE(tally.cases, num_cases() / 2);
  EXPECT_GE(tally.dependent, tally.cases / 5);
}

TEST(RandomMatrices, TheirDefinitePartsMatchDenseLuToo) {
  constexpr int most_unknowns = 800;
  Tally tally;
  for (int number = 0; number < num_cases(); ++number)
    if (unknowns_of_case(number) <= most_unknowns) compare(number, Parts::definite, solve::Symmetry::symmetric, tally);
  std::printf("  %d definite cases up to %d unknowns: ratio at most %.2f of 30, difference at most %.3f of its bar\n",
              tally.cases, tally.largest, tally.ratio, tally.difference);
  EXPECT_GE(tally.cases, num_cases() / 2);
}

}  // namespace
}  // namespace bough::test
