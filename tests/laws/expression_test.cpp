#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "bough/laws/make_law.hpp"
#include "check_law.hpp"

namespace bough::laws {
namespace {

using Times = std::vector<double>;
using Complex = std::complex<double>;
using std::numbers::pi;

struct Analytic {
  std::string text;
  std::function<Complex(Complex)> f;
};

/// Formulas beside the same functions of a complex time: every smooth operation once and some together.
std::vector<Analytic> make_analytic() {
  const Complex one(1.0);
  return {{"t", [](Complex t) { return t; }},
          {"2*t^3 - t/4 + 1", [](Complex t) { return 2.0 * t * t * t - t / 4.0 + 1.0; }},
          {"-t^2", [](Complex t) { return -t * t; }},
          {"t^-2", [](Complex t) { return 1.0 / (t * t); }},
          {"t^2.5", [](Complex t) { return std::pow(t, 2.5); }},
          {"pow(t, t)", [](Complex t) { return std::exp(t * std::log(t)); }},
          {"2^t", [](Complex t) { return std::exp(t * std::log(2.0)); }},
          {"e^(-t)", [](Complex t) { return std::exp(-t); }},
          {"(1 + t)/(2 - sin(t))", [](Complex t) { return (1.0 + t) / (2.0 - std::sin(t)); }},
          {"sin(3*t)", [](Complex t) { return std::sin(3.0 * t); }},
          {"cos(t^2)", [](Complex t) { return std::cos(t * t); }},
          {"tan(t/3)", [](Complex t) { return std::tan(t / 3.0); }},
          {"asin(t/5)", [](Complex t) { return std::asin(t / 5.0); }},
          {"acos(t/5)", [](Complex t) { return std::acos(t / 5.0); }},
          {"atan(2*t)", [](Complex t) { return std::atan(2.0 * t); }},
          {"sinh(t)", [](Complex t) { return std::sinh(t); }},
          {"cosh(t)", [](Complex t) { return std::cosh(t); }},
          {"tanh(t)", [](Complex t) { return std::tanh(t); }},
          {"exp(sin(t))*t", [](Complex t) { return std::exp(std::sin(t)) * t; }},
          {"log(1 + t*t)", [one](Complex t) { return std::log(one + t * t); }},
          {"sqrt(2 + cos(pi*t))", [](Complex t) { return std::sqrt(2.0 + std::cos(pi * t)); }}};
}

TEST(Expression, rate_is_that_of_the_complex_step) {
  // f'(t) = Im f(t + i h) / h: no cancellation, so both agree to round-off of sizes below 100.
  const double h = 1e-30;
  for (const Analytic& sample : make_analytic()) {
    const Law law = make_expression(sample.text);
    for (double t = 0.3; t < 3.0; t += 0.23) {
      const LawValue x = law.at(t);
      const double scale = 1.0 + std::abs(x.value) + std::abs(x.rate);
      EXPECT_NEAR(x.value, sample.f(t).real(), 1e-14 * scale) << sample.text;
      EXPECT_NEAR(x.rate, sample.f(Complex(t, h)).imag() / h, 4e-14 * scale) << sample.text;
    }
  }
}

TEST(Expression, acceleration_is_the_difference_of_complex_step_rates) {
  const double h = 1e-3;
  for (const Analytic& sample : make_analytic()) {
    const Law law = make_expression(sample.text);
    const auto rate = [&](double t) { return sample.f(Complex(t, 1e-30)).imag() / 1e-30; };
    for (double t = 0.35; t < 3.0; t += 0.23) {
      const double difference =
          (8.0 * (rate(t + h) - rate(t - h)) - (rate(t + 2.0 * h) - rate(t - 2.0 * h))) / (12.0 * h);
      // h^4 f^(6) / 30 with f^(6) up to 1e5 times the scale (t^-2 at 0.35), and 1e-16 / h.
      EXPECT_NEAR(law.at(t).acceleration, difference, 3e-8 * (1.0 + std::abs(difference))) << sample.text;
    }
  }
}

TEST(Expression, operators_bind_as_in_writing) {
  const auto value = [](const char* text) { return make_expression(text).at(2.0).value; };
  EXPECT_EQ(value("1 + 2*3^2"), 19.0);
  EXPECT_EQ(value("-2^2"), -4.0);
  EXPECT_EQ(value("2^3^2"), 512.0);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("8/4/2"), 1.0);
  EXPECT_EQ(value("7-4-2"), 1.0);
  EXPECT_EQ(value("--t"), 2.0);
  EXPECT_EQ(value("3*-t"), -6.0);
  EXPECT_EQ(value(" ( t + 1 ) * .5e1 "), 15.0);
  EXPECT_EQ(value("2e0*e^0"), 2.0);
  EXPECT_EQ(value("min(5, t, 3) + max(t, 7, 1)"), 9.0);
  EXPECT_EQ(value("step(t-2) + step(1.999-t) + sign(-t)"), 0.0);
}

TEST(Expression, formula_without_time_is_constant) {
  EXPECT_TRUE(make_expression("2*sin(pi/6) + max(1, 2)").is_constant());
  EXPECT_NEAR(make_expression("2*sin(pi/6) + max(1, 2)").at(9.0).value, 3.0, 1e-15);
  EXPECT_FALSE(make_expression("t").is_constant());
}

TEST(Expression, powers_have_finite_derivatives_at_zero) {
  expect_equal(make_expression("t^0").at(0.0), {1.0, 0.0, 0.0}, 0.0);
  expect_equal(make_expression("t^1").at(0.0), {0.0, 1.0, 0.0}, 0.0);
  expect_equal(make_expression("t^2").at(0.0), {0.0, 0.0, 2.0}, 0.0);
  expect_equal(make_expression("(-t)^3").at(2.0), {-8.0, -12.0, -12.0}, 0.0);
  expect_equal(make_expression("tanh(1e4*t)").at(1.0), {1.0, 0.0, 0.0}, 0.0);
}

TEST(Expression, switches_take_the_branch_of_the_side) {
  const Law corner = make_expression("abs(t - 1)");
  EXPECT_EQ(corner.at(1.0, Side::left).rate, -1.0);
  EXPECT_EQ(corner.at(1.0, Side::right).rate, 1.0);
  const Law jump = make_expression("step(1 - t)*t");
  EXPECT_EQ(jump.at(1.0, Side::left).value, 1.0);
  EXPECT_EQ(jump.at(1.0, Side::right).value, 0.0);
  const Law lower = make_expression("min(t^2, t)");
  EXPECT_EQ(lower.at(1.0, Side::left).rate, 2.0);
  EXPECT_EQ(lower.at(1.0, Side::right).rate, 1.0);
  EXPECT_EQ(lower.at(1.0, Side::left).acceleration, 2.0);
  const Law upper = make_expression("max(t^2, t)");
  EXPECT_EQ(upper.at(0.0, Side::left).rate, 0.0);
  EXPECT_EQ(upper.at(0.0, Side::right).rate, 1.0);
}

TEST(Expression, breaks_are_the_roots_of_the_switches) {
  const auto breaks = [](const char* text, double a, double b) { return make_expression(text).breakpoints(a, b); };
  EXPECT_EQ(breaks("sin(t)*exp(t)", 0.0, 100.0), Times{});
  EXPECT_EQ(breaks("step(t - 1)", 0.0, 3.0), Times{1.0});
  EXPECT_EQ(breaks("step(t - 1)", 1.0, 3.0), Times{1.0});
  EXPECT_EQ(breaks("step(t - 1)", 0.0, 1.0), Times{1.0});
  EXPECT_EQ(breaks("step(t - 1)", 1.1, 3.0), Times{});
  EXPECT_EQ(breaks("step(0.1*t)", 0.0, 1.0), Times{0.0});
  EXPECT_EQ(breaks("abs(t) + abs(t)", -1.0, 1.0), Times{0.0});
  EXPECT_EQ(breaks("min(t^2, t)", -3.0, 3.0), (Times{0.0, 1.0}));
  EXPECT_EQ(breaks("abs(abs(t) - 1)", -3.0, 3.0), (Times{-1.0, 0.0, 1.0}));
  EXPECT_EQ(breaks("abs(step(t - 1) - 0.5)", 0.0, 3.0), Times{1.0});
  EXPECT_EQ(breaks("min(t, 1, 2 - t)", -5.0, 5.0), Times{1.0});
}

TEST(Expression, switch_that_only_touches_zero_is_no_break) {
  EXPECT_TRUE(make_expression("abs(t^2)").breakpoints(-1.0, 1.0).empty());
  EXPECT_TRUE(make_expression("step((t - 0.3)^4)").breakpoints(-1.0, 1.0).empty());
  EXPECT_TRUE(make_expression("abs(1 + sin(t))").breakpoints(0.0, 4.0).empty());
}

TEST(Expression, switch_at_round_off_over_a_stretch_is_no_break) {
  EXPECT_TRUE(make_expression("abs(sin(t) + 1 - 1 - sin(t))").breakpoints(0.0, 10.0).empty());
  EXPECT_EQ(make_expression("abs(t*t*t)").breakpoints(-1.0, 2.0).size(), 1U);  // root of third order
}

TEST(Expression, all_breaks_of_a_square_wave_are_found_and_its_sides_differ) {
  const Law law = make_expression("sign(sin(50*t))");
  const Times breaks = law.breakpoints(0.01, 20.0);
  ASSERT_EQ(breaks.size(), static_cast<std::size_t>(20.0 * 50.0 / pi));
  for (std::size_t i = 0; i < breaks.size(); ++i) {
    EXPECT_NEAR(breaks[i], pi / 50.0 * static_cast<double>(i + 1), 1e-14);
    EXPECT_EQ(law.at(breaks[i], Side::left).value, -law.at(breaks[i], Side::right).value);
  }
}

TEST(Expression, breaks_agree_with_a_fine_scan) {
  // Independent of the interval arithmetic: changes of the rate's branch between 2e5 samples.
  for (const char* text :
       {"abs(sin(3*t) - 0.2*t)", "abs(cos(t^2) + exp(-t) - 0.3)", "abs(t^3 - 2*t + 0.5)", "abs(tanh(t) - log(t + 4)/2)",
        "abs(sqrt(t + 4) - 2*atan(t)^2)", "abs(cosh(t/2) - 1.5 - sinh(t)/9)", "abs(asin(t/4) + acos(t/4)*cos(5*t))",
        "abs(2^t - (t + 4)^1.5/5)"}) {
    const Law law = make_expression(text);
    const Times breaks = law.breakpoints(-3.0, 3.0);
    std::size_t found = 0;
    const std::size_t n = 200000;
    const auto time = [](std::size_t i) {
      return -3.0 + 6.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    };
    double slope = law.at(time(0)).rate;
    for (std::size_t i = 1; i < n; ++i) {
      const double next = law.at(time(i)).rate;
      if (std::abs(next - slope) > 0.05) {  // a kink; smooth changes per sample are below 1e-2
        ASSERT_LT(found, breaks.size()) << text;
        EXPECT_GE(breaks[found], time(i - 1)) << text;
        EXPECT_LE(breaks[found], time(i)) << text;
        ++found;
      }
      slope = next;
    }
    EXPECT_EQ(found, breaks.size()) << text;
    EXPECT_GT(found, 0U) << text;
  }
}

struct BadFormula {
  std::string text;
  std::size_t position;
  std::string part;  ///< of the message
};

TEST(Expression, errors_name_position_and_cause) {
  const std::vector<BadFormula> cases{{"", 0, "empty"},
                                      {"   ", 3, "empty"},
                                      {"2 +", 3, "found the end"},
                                      {"2 t", 2, "expected an operator"},
                                      {"sin(t", 5, "not closed"},
                                      {"t)", 1, "without a '('"},
                                      {"3 + sine(t)", 4, "did you mean 'sin'"},
                                      {"sqr(t)", 0, "did you mean 'sqrt'"},
                                      {"Pi*t", 0, "did you mean 'pi'"},
                                      {"velocity*t", 0, "unknown name 'velocity'"},
                                      {"t + x", 4, "unknown name 'x'"},
                                      {"sin t", 4, "expected '('"},
                                      {"sin(t, 2)", 5, "one argument"},
                                      {"pow(t)", 5, "two arguments"},
                                      {"pow(t, 1, 2)", 8, "two arguments"},
                                      {"max(t)", 5, "or more"},
                                      {"t ** 2", 3, "found '*'"},
                                      {"1e999", 0, "out of range"},
                                      {"t + .", 4, "expected a number"},
                                      {"t $ 2", 2, "found '$'"}};
  for (const BadFormula& bad : cases) {
    try {
      make_expression(bad.text);
      ADD_FAILURE() << "accepted: " << bad.text;
    } catch (const LawError& error) {
      EXPECT_EQ(error.text, bad.text);
      EXPECT_EQ(error.position, bad.position) << bad.text;
      EXPECT_NE(std::string(error.what()).find(bad.part), std::string::npos) << bad.text << ": " << error.what();
    }
  }
}

TEST(Expression, nesting_is_limited_and_length_is_not) {
  const auto nested = [](std::size_t n) { return std::string(n, '(') + "t" + std::string(n, ')'); };
  EXPECT_EQ(make_expression(nested(60)).at(3.0).value, 3.0);
  EXPECT_THROW(make_expression(nested(70)), LawError);
  EXPECT_THROW(make_expression(nested(1000000)), LawError);
  std::string tower = "t";
  for (int i = 0; i < 100; ++i) tower += "^t";
  EXPECT_THROW(make_expression(tower), LawError);
  std::string chain = "t";
  for (int i = 0; i < 9999; ++i) chain += "+t";
  EXPECT_EQ(make_expression(chain).at(1.0).value, 10000.0);
  // The fullest stack that 64 levels can ask for.
  std::string full;
  for (int i = 0; i < 20; ++i) full += "t + t*t^(";
  full += "1" + std::string(20, ')');
  EXPECT_TRUE(std::isfinite(make_expression(full).at(0.5, Side::left).value));
}

/// min or max of n straight lines with as many slopes: an envelope with corners.
std::string envelope(const std::string& name, int n) {
  std::string text = name + "(";
  for (int i = 0; i < n; ++i)
    text += (i > 0 ? "," : "") + std::to_string(i) + "*t-" + std::to_string(i * i) + "/" + std::to_string(n);
  return text + ")";
}

TEST(Expression, min_and_max_of_many_arguments_are_those_of_all) {
  for (const int n : {2, 3, 5, 17, 64, 200}) {
    const Law highest = make_expression(envelope("max", n)), lowest = make_expression(envelope("min", n));
    for (const double t : {0.1, 0.5, 1.0, 1.7}) {
      double most = -1e300, least = 1e300;
      for (int i = 0; i < n; ++i) {
        const double value = i * t - static_cast<double>(i * i) / n;
        most = std::max(most, value);
        least = std::min(least, value);
      }
      EXPECT_EQ(highest.at(t, Side::right).value, most) << n << " " << t;
      EXPECT_EQ(lowest.at(t, Side::right).value, least) << n << " " << t;
    }
  }
}

TEST(Breakpoints, of_min_and_max_of_n_arguments_cost_n_log_n) {
  const auto work = [](const std::string& text) { return make_expression(text).breakpoints(0.0, 2.0, 64'000).work; };
  for (const std::string name : {"min", "max"}) {
    const double few = work(envelope(name, 256)), many = work(envelope(name, 4096));
    EXPECT_LT(many / few, 16.0 * 12.0 / 8.0 * 1.3) << name;  // 16 times as many, log2 12 instead of 8
  }
}

TEST(Breakpoints, the_search_in_a_long_formula_is_given_up_after_a_stated_work) {
  std::string text = "min(t";
  for (int i = 0; i < 100'000; ++i) text += ",t";  // differences that intervals cannot tell from zero
  const Breaks breaks = make_expression(text + ")").breakpoints(0.0, 2.0, 64'000);
  EXPECT_TRUE(breaks.is_cut);
  EXPECT_LT(breaks.work, 1e8);
}

TEST(Breakpoints, the_search_ends_where_there_are_more_than_asked_for) {
  for (const char* text :
       {"abs(sin(1e7*t))", "step(sin(1e9*t))", "sign(sin(t/(t - 0.5)))", "min(sin(1e8*t), cos(1e8*t))"}) {
    const Breaks breaks = make_expression(text).breakpoints(0.0, 1.0, 1000);
    EXPECT_TRUE(breaks.is_cut) << text;
    EXPECT_LE(breaks.times.size(), 1000U) << text;
    EXPECT_LT(breaks.work, 1e7) << text;  // there are millions of breaks
  }
  EXPECT_FALSE(make_expression("abs(sin(100*t))").breakpoints(0.0, 1.0, 1000).is_cut);
  const Law law = make_table({0.0, 1.0, 2.0, 3.0}, {0.0, 1.0, 0.0, 1.0}, Interpolation::linear);
  EXPECT_TRUE(law.breakpoints(0.0, 9.0, 3).is_cut);
  EXPECT_FALSE(law.breakpoints(0.0, 9.0, 4).is_cut);
}

TEST(Breakpoints, piece_by_piece_are_those_of_the_whole) {
  const Law parts[] = {
      make_expression("abs(sin(7*t)) + step(cos(3*t))"),
      make_table({0.0, 1.0, 2.0, 3.0}, {0.0, 1.0, 0.0, 1.0}, Interpolation::linear),
      make_piecewise({{0.0, make_constant(1.0)}, {1.0, make_expression("abs(t - 2.5)")}, {4.0, Law{}}})};
  for (const Law& law : parts) {
    Times all = law.breakpoints(0.0, 8.0), pieces;
    for (int k = 0; k < 64; ++k) {
      const Times piece = law.breakpoints(k / 8.0, (k + 1) / 8.0);
      pieces.insert(pieces.end(), piece.begin(), piece.end());
    }
    pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
    EXPECT_EQ(pieces, all);
  }
}

}  // namespace
}  // namespace bough::laws
