#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "bough/step/options.hpp"

namespace bough::step {
namespace {

/// Largest |eigenvalue| of one step on x'' + omega^2 x = 0 at h omega = w, from the recursion of (x, h v, h^2 a, h^2
/// x'').
double spectral_radius_at(const AlphaCoefficients& c, double w) {
  // Power iteration on the 3-state map (x, h v, h^2 a); h^2 x'' = -w^2 x at both ends.
  const auto apply = [&](const std::array<double, 3>& s) {
    const double accel = -w * w * s[0];
    // (1 - am) a1 + am a0 = (1 - af) x1'' + af x0'', x1 = x0 + v + (1/2 - beta) a0 + beta a1
    const double known = s[0] + s[1] + (0.5 - c.beta) * s[2];
    const double a1 = ((1.0 - c.alpha_f) * (-w * w * known) + c.alpha_f * accel - c.alpha_m * s[2]) /
                      (1.0 - c.alpha_m + (1.0 - c.alpha_f) * w * w * c.beta);
    return std::array<double, 3>{known + c.beta * a1, s[1] + (1.0 - c.gamma) * s[2] + c.gamma * a1, a1};
  };
  // Characteristic polynomial of the 3x3 map by its columns, roots by Durand-Kerner.
  double m[3][3];
  for (int j = 0; j < 3; ++j) {
    std::array<double, 3> e{};
    e[static_cast<std::size_t>(j)] = 1.0;
    const auto column = apply(e);
    for (int i = 0; i < 3; ++i) m[i][j] = column[static_cast<std::size_t>(i)];
  }
  const double trace = m[0][0] + m[1][1] + m[2][2];
  const double minors = m[0][0] * m[1][1] - m[0][1] * m[1][0] + m[0][0] * m[2][2] - m[0][2] * m[2][0] +
                        m[1][1] * m[2][2] - m[1][2] * m[2][1];
  const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                     m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  std::complex<double> root[3] = {{1.0, 0.1}, {-0.4, 0.9}, {-0.5, -0.8}};
  for (int k = 0; k < 2000; ++k)
    for (int i = 0; i < 3; ++i) {
      const std::complex<double> r = root[i];
      root[i] -= (((r - trace) * r + minors) * r - det) / ((r - root[(i + 1) % 3]) * (r - root[(i + 2) % 3]));
    }
  return std::max({std::abs(root[0]), std::abs(root[1]), std::abs(root[2])});
}

TEST(AlphaCoefficients, give_the_spectral_radius_asked_for_at_infinite_frequency) {
  // The three roots meet at infinity, where a perturbation eps moves a triple root by its cube root: hence 1e-3.
  for (double rho : {0.2, 0.5, 0.8, 0.95})
    EXPECT_NEAR(spectral_radius_at(make_alpha_coefficients(rho), 1e4), rho, 2e-3) << rho;
}

TEST(AlphaCoefficients, never_amplify_at_any_frequency) {
  for (double rho : {0.0, 0.3, 0.6, 0.9, 1.0})
    for (double w = 1e-2; w < 1e3; w *= 1.7)
      EXPECT_LE(spectral_radius_at(make_alpha_coefficients(rho), w), 1.0 + 1e-9) << rho << " " << w;
}

TEST(AlphaCoefficients, meet_the_condition_of_second_order) {
  for (double rho = 0.0; rho <= 1.0; rho += 0.1) {
    const AlphaCoefficients c = make_alpha_coefficients(rho);
    EXPECT_DOUBLE_EQ(c.gamma, 0.5 - c.shift());
  }
}

TEST(StepOptions, tell_what_is_wrong_with_them) {
  StepOptions o;
  EXPECT_TRUE(problems_in(o).empty());
  o.spectral_radius = 1.5;
  o.tolerance = 0.0;
  o.max_iterations = 0;
  o.max_cuts = -1;
  EXPECT_EQ(problems_in(o).size(), 4u);
}

}  // namespace
}  // namespace bough::step
