/// Frequencies of a Timoshenko cantilever from the assembled tangent and mass, and from its own free vibration.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

scene::Scene timoshenko(int elements, int order) {
  const double h = 0.1, E = 210e9, G = E / 2.6, rho = 7850.0, A = h * h, I = h * h * h * h / 12.0;
  scene::Section section =
      scene::make_section("s", E * A, 5.0 / 6.0 * G * A, 5.0 / 6.0 * G * A, 0.1406 * G * h * h * h * h, E * I, E * I);
  scene::set_mass(section, rho * A, 2.0 * rho * I, rho * I, rho * I);
  scene::Scene s = scene::make_cantilever(section, 1.0, elements, order);
  s.analysis.kind = scene::AnalysisKind::dynamics;
  s.analysis.end_time = 1.0;
  return s;
}

/// Sum of the element matrices over the nodes' unknowns (multipliers left out), clamped unknowns of the root struck
/// out.
Eigen::MatrixXd assemble(Direct& run, const elements::Slopes& slopes) {
  EXPECT_FALSE(run.system.set_time(0.0).has_value());
  EXPECT_FALSE(run.system.evaluate(run.state, slopes, true).has_value());
  const blocks::BlockGraph& g = run.plan.graph;
  const int n = 6 * static_cast<int>(run.plan.nodes.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int e = 0; e < g.num_elements(); ++e) {
    std::vector<int> place;
    for (auto k = g.element_begin[static_cast<std::size_t>(e)]; k < g.element_begin[static_cast<std::size_t>(e) + 1];
         ++k) {
      const int b = g.element_blocks[static_cast<std::size_t>(k)];
      for (int i = 0; i < g.block_size[static_cast<std::size_t>(b)]; ++i) place.push_back(6 * b < n ? 6 * b + i : -1);
    }
    const solve::ElementView a = run.system.linear().solver().element(e);
    const int size = static_cast<int>(place.size());
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j)
        if (place[static_cast<std::size_t>(i)] >= 0 && place[static_cast<std::size_t>(j)] >= 0)
          A(place[static_cast<std::size_t>(i)], place[static_cast<std::size_t>(j)]) += a[i * size + j];
  }
  return A.bottomRightCorner(n - 6, n - 6);  // the root is the first node
}

/// First two frequencies of bending [rad/s]; each comes twice, once for each plane.
std::pair<double, double> frequencies(int elements, int order) {
  scene::Scene s = timoshenko(elements, order);
  s.without = {"planar", "held"};  // all nodes in the matrix, the first one the root
  Direct run(s);
  EXPECT_EQ(run.plan.nodes[0].name, "root");
  const Eigen::MatrixXd K = assemble(run, {0.0, 0.0, false});
  const Eigen::MatrixXd M = assemble(run, {0.0, 0.0, true});
  EXPECT_LT((K - K.transpose()).norm(), 1e-12 * K.norm());
  EXPECT_LT((M - M.transpose()).norm(), 1e-12 * M.norm());
  const Eigen::VectorXd w2 =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_NEAR(w2[0], w2[1], 1e-7 * w2[0]);
  return {std::sqrt(w2[0]), std::sqrt(w2[2])};
}

TEST(VerifyStatics, timoshenko_frequencies_of_the_assembled_stiffness_and_mass) {
  const double exact[2] = {520.8406417227, 3121.5777653984};
  const int coarsest[] = {16, 4, 2};
  for (int order = 1; order <= 3; ++order) {
    const int n = coarsest[order - 1];
    const auto a = frequencies(n, order), b = frequencies(2 * n, order), c = frequencies(4 * n, order);
    const double pa[2] = {a.first, a.second}, pb[2] = {b.first, b.second}, pc[2] = {c.first, c.second};
    for (int m = 0; m < 2; ++m) {
      const double p = observed_order(std::abs(pa[m] - pb[m]), std::abs(pb[m] - pc[m]));
      const double extrapolated = pc[m] + (pc[m] - pb[m]) / (std::pow(2.0, 2.0 * order) - 1.0);
      std::printf("  order %d mode %d: %.8f, observed %.3f, finest %.2e, extrapolated %.2e\n", order, m + 1, pc[m], p,
                  pc[m] / exact[m] - 1.0, extrapolated / exact[m] - 1.0);
      EXPECT_GT(p, 2.0 * order - 0.2) << order << " " << m;  // more where leading terms of stiffness and mass cancel
      EXPECT_LT(std::min(std::abs(pc[m] - exact[m]), std::abs(extrapolated - exact[m])), 1e-6 * exact[1])
          << order << " " << m;
    }
  }
}

}  // namespace
}  // namespace bough::verify
