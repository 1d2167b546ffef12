// Sensitivities against functions whose indices are known in closed form.
#include "bough/study/sensitivity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "bough/study/cases.hpp"

namespace bough::study {
namespace {

using io::SweepDesign;
using io::SweepDesignKind;
constexpr double pi = std::numbers::pi;
using Function = std::function<double(const std::vector<double>&)>;

SweepDesign design_of(SweepDesignKind kind, const std::vector<io::SweepDistribution>& variables,
                      std::uint32_t samples) {
  SweepDesign d;
  d.kind = kind;
  d.samples = samples;
  for (const io::SweepDistribution& v : variables) d.variables.push_back({"x", {"/x"}, {}, {}, v});
  return d;
}

io::SweepDistribution distribution(io::SweepDistribution::Kind kind, double a, double b) {
  io::SweepDistribution d;
  d.kind = kind;
  d.low = d.mean = a;
  d.high = d.deviation = b;
  return d;
}

std::vector<std::optional<double>> values_of(const SweepDesign& d, const Function& f) {
  std::vector<std::optional<double>> values;
  for_each_row(d, 0, [&](const std::vector<io::SweepValue>& row) {
    std::vector<double> x;
    for (const io::SweepValue& v : row) x.push_back(*v.number);
    values.push_back(f(x));
  });
  return values;
}

void expect_covers(const Index& index, double exact, double tolerance) {
  EXPECT_NEAR(index.value, exact, tolerance);
  ASSERT_TRUE(index.low && index.high);
  EXPECT_LE(*index.low, *index.high);
  EXPECT_LT(*index.low, exact + tolerance);
  EXPECT_GT(*index.high, exact - tolerance);
}

/// Ishigami and Homma 1990: sin x1 + a sin^2 x2 + b x3^4 sin x1 on (-pi, pi)^3.
TEST(Sensitivity, sobol_indices_of_ishigamis_function) {
  const double a = 7.0, b = 0.1, p4 = std::pow(pi, 4), p8 = p4 * p4;
  const auto uniform = distribution(io::SweepDistribution::Kind::uniform, -pi, pi);
  const SweepDesign d = design_of(SweepDesignKind::saltelli, {uniform, uniform, uniform}, 4096);
  const auto f = [&](const std::vector<double>& x) {
    return std::sin(x[0]) + a * std::pow(std::sin(x[1]), 2) + b * std::pow(x[2], 4) * std::sin(x[0]);
  };
  const double variance = a * a / 8 + b * p4 / 5 + b * b * p8 / 18 + 0.5;
  const double v1 = 0.5 * std::pow(1 + b * p4 / 5, 2), v2 = a * a / 8, v13 = b * b * p8 * (1.0 / 18 - 1.0 / 50);
  const auto s = sensitivity_of(d, 0, values_of(d, f));
  ASSERT_TRUE(s.has_value());
  EXPECT_EQ(s->rows, 4096u * 5u);
  const double first[] = {v1 / variance, v2 / variance, 0.0};
  const double total[] = {(v1 + v13) / variance, v2 / variance, v13 / variance};
  for (std::size_t k = 0; k < 3; ++k) {
    expect_covers(s->values[0][k], first[k], 0.01);
    expect_covers(s->values[1][k], total[k], 0.01);
  }
}

/// The tip deflection F L^3 / (3 E I) with lognormal inputs: S_i = (exp(a_i^2 s_i^2) - 1) / (exp(sum a_j^2 s_j^2) - 1).
TEST(Sensitivity, sobol_indices_of_a_cantilever_with_lognormal_inputs) {
  const double exponents[] = {1, 3, -1, -1}, sigmas[] = {0.2, 0.05, 0.1, 0.15};
  std::vector<io::SweepDistribution> inputs;
  double sum = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    inputs.push_back(distribution(io::SweepDistribution::Kind::lognormal, 0.3, sigmas[k]));
    sum += std::pow(exponents[k] * sigmas[k], 2);
  }
  const SweepDesign d = design_of(SweepDesignKind::saltelli, inputs, 4096);
  const auto s = sensitivity_of(
      d, 0, values_of(d, [](const std::vector<double>& x) { return x[0] * std::pow(x[1], 3) / (3.0 * x[2] * x[3]); }));
  ASSERT_TRUE(s.has_value());
  for (std::size_t k = 0; k < 4; ++k) {
    const double own = std::pow(exponents[k] * sigmas[k], 2);
    expect_covers(s->values[0][k], std::expm1(own) / std::expm1(sum), 0.01);
    expect_covers(s->values[1][k], std::exp(sum - own) * std::expm1(own) / std::expm1(sum), 0.01);
  }
}

TEST(Sensitivity, effects_of_a_linear_function_are_its_coefficients) {
  const auto unit = distribution(io::SweepDistribution::Kind::uniform, 0, 1);
  const SweepDesign d = design_of(SweepDesignKind::morris, {unit, unit, unit}, 20);
  const auto s =
      sensitivity_of(d, 0, values_of(d, [](const std::vector<double>& x) { return 3 * x[0] - 2 * x[1] + 1; }));
  ASSERT_TRUE(s.has_value());
  const double exact[] = {3, -2, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(s->values[0][k].value, exact[k], 1e-10);
    EXPECT_NEAR(s->values[1][k].value, std::abs(exact[k]), 1e-10);
    EXPECT_NEAR(s->values[2][k].value, 0.0, 1e-10);
  }
  // Of x0 x1 the effect of x0 is x1, whose levels are the middles of four strata.
  const auto product = sensitivity_of(d, 0, values_of(d, [](const std::vector<double>& x) { return x[0] * x[1]; }));
  EXPECT_NEAR(product->values[0][0].value, 0.5, 0.15);
  EXPECT_GT(product->values[2][0].value, 0.1);
}

TEST(Sensitivity, regression_finds_linear_functions_and_ranks_monotone_ones) {
  const auto normal = distribution(io::SweepDistribution::Kind::normal, 5, 2);
  const SweepDesign d = design_of(SweepDesignKind::latin_hypercube, {normal, normal}, 400);
  const auto linear =
      sensitivity_of(d, 0, values_of(d, [](const std::vector<double>& x) { return 3 * x[0] - 4 * x[1]; }));
  ASSERT_TRUE(linear.has_value());
  EXPECT_NEAR(*linear->explained, 1.0, 1e-12);
  EXPECT_NEAR(linear->values[0][0].value, 0.6, 0.03);  // 3 / sqrt(3^2 + 4^2), but for what correlates by chance
  EXPECT_NEAR(linear->values[0][1].value, -0.8, 0.03);
  const auto steep =
      sensitivity_of(d, 0, values_of(d, [](const std::vector<double>& x) { return std::exp(2 * x[0]); }));
  EXPECT_LT(*steep->explained, 0.8);
  EXPECT_NEAR(*steep->explained_ranks, 1.0, 1e-12);
  EXPECT_NEAR(steep->values[1][0].value, 1.0, 1e-12);
}

TEST(Sensitivity, cases_without_a_value_take_their_sample_along_and_no_other) {
  const auto unit = distribution(io::SweepDistribution::Kind::uniform, 0, 1);
  for (const SweepDesignKind kind : {SweepDesignKind::morris, SweepDesignKind::saltelli, SweepDesignKind::random}) {
    const SweepDesign d = design_of(kind, {unit, unit}, 64);
    auto values = values_of(d, [](const std::vector<double>& x) { return x[0]; });
    const std::size_t all = sensitivity_of(d, 0, values)->rows;
    values[5].reset();
    const auto s = sensitivity_of(d, 0, values);
    EXPECT_EQ(s->rows, all - (kind == SweepDesignKind::random ? 1u : kind == SweepDesignKind::morris ? 3u : 4u));
    for (auto& v : values) v = 2.0;  // what does not vary has no indices
    EXPECT_EQ(sensitivity_of(d, 0, values).has_value(), kind == SweepDesignKind::morris);  // whose effects are 0
    for (auto& v : values) v.reset();
    EXPECT_FALSE(sensitivity_of(d, 0, values).has_value());
  }
}

}  // namespace
}  // namespace bough::study
