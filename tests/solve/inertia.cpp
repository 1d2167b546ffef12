/// Sylvester's law of inertia: signs of pivots against eigenvalues of dense matrices.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "solving.hpp"

namespace bough::test {
namespace {

using solve::Symmetry;

/// Symmetric, and with parts of the stiffness taken away, so that some eigenvalues on the constraints' kernel are
/// negative.
Scene make_indefinite(Scene scene, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int e = 0; e < scene.graph.num_elements(); ++e) {
    Eigen::MatrixXd& a = scene.elements[static_cast<std::size_t>(e)];
    a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
    if (a.trace() <= 0.0 || share(random) < 0.6) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> own(a);
    Eigen::VectorXd values = own.eigenvalues();
    values.reverse()(0) *= -0.5;
    a = own.eigenvectors() * values.asDiagonal() * own.eigenvectors().transpose();
    a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
  }
  return scene;
}

struct Counts {
  int negative = 0;  ///< eigenvalues of the whole matrix
  int unstable = 0;  ///< of K on ker G
  int rank = 0;      ///< of G
  double least = 1.0;
};

Counts dense_counts(const Solved& s) {
  const auto scales = s.solver.column_scale();
  const Eigen::Map<const Eigen::VectorXd> scale(scales.data(), static_cast<Eigen::Index>(scales.size()));
  const Eigen::MatrixXd A = scale.asDiagonal() * s.scene.dense() * scale.asDiagonal();  // congruent: the same inertia
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues();
  Counts c;
  constexpr double zero = 1e-11;  // dependent rows leave less, everything else is far above
  for (double v : values) {
    c.negative += v < -zero ? 1 : 0;
    if (std::abs(v) > zero) c.least = std::min(c.least, std::abs(v));
  }
  std::vector<int> motion, rows;
  const std::vector<int> first = s.scene.first_unknown();
  for (int b = 0; b < s.scene.graph.num_blocks(); ++b)
    for (int i = 0; i < s.scene.graph.block_size[static_cast<std::size_t>(b)]; ++i)
      (s.scene.graph.block_kind[static_cast<std::size_t>(b)] == blocks::BlockKind::motion ? motion : rows)
          .push_back(first[static_cast<std::size_t>(b)] + i);
  const Eigen::MatrixXd K = A(motion, motion);
  Eigen::MatrixXd kernel = Eigen::MatrixXd::Identity(K.rows(), K.cols());
  if (!rows.empty()) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(A(rows, motion)), Eigen::ComputeFullV);
    for (double v : svd.singularValues()) c.rank += v > 1e-10 ? 1 : 0;
    kernel = svd.matrixV().rightCols(K.cols() - c.rank);
  }
  if (kernel.cols() == 0) return c;
  const Eigen::VectorXd on_kernel =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(kernel.transpose() * K * kernel).eigenvalues();
  c.unstable = static_cast<int>((on_kernel.array() < 0.0).count());
  return c;
}

std::vector<Scene> small_scenes() {
  std::vector<Scene> scenes;
  for (unsigned seed : {1u, 2u, 3u})
    for (Scene& s : make_all_families(seed))
      if (s.num_unknowns() < 400) scenes.push_back(std::move(s));
  scenes.push_back(make_hinged_beams(5, 9, 3));
  scenes.push_back(make_hinged_beams(6, 12, 2));
  scenes.push_back(make_definite(make_chain(7, 12, 3)));
  return scenes;
}

TEST(Inertia, NegativePivotsAreNegativeEigenvaluesOnTheKernelAndIndependentRows) {
  int unstable_scenes = 0, counted = 0, dependent = 0;
  unsigned seed = 0;
  for (const Scene& given : small_scenes())
    for (const bool spoilt : {false, true}) {
      Scene scene = given;
      for (Eigen::MatrixXd& a : scene.elements) a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
      if (spoilt) scene = make_indefinite(std::move(scene), ++seed);
      for (const Symmetry symmetry : {Symmetry::general, Symmetry::symmetric})
        for (const bool lanes : {true, false}) {
          Solved s(scene, {}, {.symmetry = symmetry, .inertia = true, .lanes = lanes});
          const solve::FactorStatus status = s.factor();
          ASSERT_TRUE(status.ok()) << scene.name;
          const Counts dense = dense_counts(s);
          ASSERT_EQ(dense.negative, dense.unstable + dense.rank) << scene.name << ": Sylvester's law";
          const solve::Inertia inertia = s.solver.inertia();
          if (symmetry != Symmetry::general) {
            EXPECT_EQ(inertia.negative, dense.negative) << scene.name << " lanes " << lanes;
          } else if (inertia.negative >= 0) {
            EXPECT_EQ(inertia.negative, dense.negative) << scene.name << " lanes " << lanes;
            ++counted;
          }
          const int sign = status.deficiency > 0 ? 0 : dense.negative % 2 == 0 ? 1 : -1;
          EXPECT_EQ(inertia.determinant, sign) << scene.name;
          EXPECT_EQ(s.solver.inertia().negative, inertia.negative) << "asked twice";
          unstable_scenes += dense.unstable > 0 ? 1 : 0;
          dependent += status.deficiency > 0 ? 1 : 0;
        }
    }
  EXPECT_GT(unstable_scenes, 20);
  EXPECT_GT(dependent, 5);
  EXPECT_GT(counted, 10) << "without an exchange of rows general factors tell the inertia as well";
}

TEST(Inertia, SignOfTheDeterminantOfAnUnsymmetricMatrix) {
  int negative = 0;
  for (unsigned seed : {11u, 12u, 13u, 14u})
    for (const Scene& scene : {make_chain(seed, 5, 2), make_loop(seed, 4), make_tree_of_bodies(seed, 9)}) {
      Solved s(scene, {}, {.inertia = true});
      const solve::FactorStatus status = s.factor();
      ASSERT_TRUE(status.ok());
      if (status.deficiency > 0) continue;
      const double determinant = Eigen::FullPivLU<Eigen::MatrixXd>(s.scaled_dense()).determinant();
      EXPECT_EQ(s.solver.inertia().determinant, determinant > 0.0 ? 1 : -1) << scene.name;
      negative += determinant < 0.0 ? 1 : 0;
    }
  EXPECT_GT(negative, 0);
}

}  // namespace
}  // namespace bough::test
