#include "solving.hpp"

#include <cstring>

#include "support/untrapped.hpp"

namespace bough::test {

namespace {
Eigen::Map<const Eigen::VectorXd> as_vector(std::span<const double> s) {
  return {s.data(), static_cast<Eigen::Index>(s.size())};
}
}  // namespace

Eigen::VectorXd Solved::random_rhs(unsigned seed) const {
  SceneMaker m(seed);
  const auto scale = as_vector(solver.row_scale());
  return m.uniform_matrix(scene.num_unknowns(), 1).col(0).cwiseQuotient(scale);
}

double Solved::scaled_difference(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const {
  if (x.size() == 0) return 0.0;
  const auto scale = as_vector(solver.column_scale());
  const double size = y.cwiseQuotient(scale).lpNorm<Eigen::Infinity>();
  return (x - y).cwiseQuotient(scale).lpNorm<Eigen::Infinity>() / (size > 0.0 ? size : 1.0);
}

Eigen::MatrixXd Solved::scaled_dense() const {
  return as_vector(solver.row_scale()).asDiagonal() * scene.dense() * as_vector(solver.column_scale()).asDiagonal();
}

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

double condition_of(const Eigen::MatrixXd& A) {
  const Untrapped untrapped;  // the last one may be zero
  const Eigen::VectorXd values = singular_values(A);
  return values(0) / values(values.size() - 1);
}

Eigen::VectorXd exact_column_scale(const Solved& s) {
  const auto& graph = s.scene.graph;
  const auto first = s.scene.first_unknown();
  const Eigen::MatrixXd A = s.scene.dense();
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(A.rows());  // sum over the elements of |diagonal|
  for (int e = 0; e < graph.num_elements(); ++e) {
    int k = 0;
    for (auto p = graph.element_begin[static_cast<std::size_t>(e)];
         p < graph.element_begin[static_cast<std::size_t>(e) + 1]; ++p) {
      const auto b = static_cast<std::size_t>(graph.element_blocks[static_cast<std::size_t>(p)]);
      for (int i = 0; i < graph.block_size[b]; ++i, ++k)
        diagonal(first[b] + i) += std::abs(s.scene.elements[static_cast<std::size_t>(e)](k, k));
    }
  }
  Eigen::VectorXd scale(A.rows());
  for (int pass = 0; pass < 2; ++pass)
    for (int b = 0; b < graph.num_blocks(); ++b) {
      const bool motion = graph.block_kind[static_cast<std::size_t>(b)] == blocks::BlockKind::motion;
      if (motion != (pass == 0)) continue;
      for (int u = first[static_cast<std::size_t>(b)]; u < first[static_cast<std::size_t>(b) + 1]; ++u) {
        if (motion) {
          scale(u) = 1.0 / std::sqrt(diagonal(u));
          continue;
        }
        double sum = 0.0;
        for (int c = 0; c < graph.num_blocks(); ++c)
          if (graph.block_kind[static_cast<std::size_t>(c)] == blocks::BlockKind::motion)
            for (int v = first[static_cast<std::size_t>(c)]; v < first[static_cast<std::size_t>(c) + 1]; ++v)
              sum += std::pow(A(v, u) * scale(v), 2);
        scale(u) = sum > 0.0 ? 1.0 / std::sqrt(sum) : 1.0;
      }
    }
  return scale;
}

void expect_matches_dense(const Scene& scene, const tree::TreeOptions& tree_options, double backward_bar,
                          const solve::SolveOptions& options) {
  Solved s(scene, tree_options, options);
  const auto status = s.factor();
  const std::string what =
      scene.name + ", leaf " + std::to_string(tree_options.leaf_size) + ", depth " + std::to_string(tree_options.depth);
  ASSERT_TRUE(status.ok()) << what << " block " << status.block << " magnitude " << status.magnitude;
  EXPECT_EQ(status.deficiency, 0) << what;
  if (scene.num_unknowns() == 0) return;
  const Eigen::MatrixXd A = s.scaled_dense();
  const Eigen::VectorXd b = s.random_rhs(17);
  const Eigen::VectorXd x = s.solve(b);
  EXPECT_TRUE(s.report.finite) << what;
  EXPECT_LE(s.report.backward_error, backward_bar) << what;
  const Eigen::VectorXd scaled = solve_with_full_pivoting(A, as_vector(s.solver.row_scale()).cwiseProduct(b));
  const Eigen::VectorXd oracle = as_vector(s.solver.column_scale()).cwiseProduct(scaled);
  EXPECT_LE(s.scaled_difference(x, oracle), condition_of(A) * backward_bar * static_cast<double>(A.rows())) << what;
}

}  // namespace bough::test
