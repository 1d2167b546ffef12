// Figures of quantities over time, against closed forms and published counts.
#include "bough/run/measures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "support/scenes.hpp"

namespace bough::run {
namespace {

constexpr double pi = std::numbers::pi;

/// A function at times that are not equally far apart.
struct Sampled {
  std::vector<double> times, values;
  template <class F>
  Sampled(double end, int n, const F& f) {
    for (int k = 0; k <= n; ++k) {
      const double s = static_cast<double>(k) / n;
      times.push_back(end * (k == n ? 1.0 : s + 0.1 / n * std::sin(7.0 * k)));
      if (k == 0) times.back() = 0.0;
      values.push_back(f(times.back()));
    }
  }
  operator Series() const { return {times, values}; }
};

std::map<double, double> counts(const std::vector<double>& values) {
  std::map<double, double> by_range;
  for (const LoadCycle& c : rainflow_of(values)) by_range[c.range] += c.count;
  return by_range;
}

TEST(Measures, rainflow_counts_the_series_of_the_standard) {
  // ASTM E 1049-85 (2017), figure 6.
  const std::map<double, double> expected = {{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1.0}, {9, 0.5}};
  EXPECT_EQ(counts({-2, 1, -3, 5, -1, 3, -4, 4, -2}), expected);
  // Points on the way and repeated ones are no turning points.
  EXPECT_EQ(counts({-2, -2, 0, 1, 1, -1, -3, 5, 2, -1, -1, 3, -4, 0, 4, -2, -2}), expected);
  EXPECT_TRUE(rainflow_of({}).empty());
  EXPECT_TRUE(rainflow_of(std::vector<double>{3, 3, 3}).empty());
  EXPECT_EQ(counts({0, 2}), (std::map<double, double>{{2, 0.5}}));
}

/// Every turn of the history ends in exactly one count: the counts add up to half the number of turns.
TEST(Measures, rainflow_counts_every_range_of_turning_points_once) {
  std::mt19937 random(3);
  for (int n = 2; n < 200; n += 7) {
    std::vector<double> values;
    for (int k = 0; k < n; ++k)
      values.push_back((k % 2 == 0 ? 1.0 : -1.0) * (1.0 + 1e-9 * static_cast<double>(random())));
    double number = 0.0;
    for (const LoadCycle& c : rainflow_of(values)) number += c.count;
    EXPECT_EQ(number, 0.5 * (n - 1));
  }
}

TEST(Measures, equal_cycles_are_their_own_equivalent) {
  std::vector<double> values;
  for (int k = 0; k <= 20; ++k) values.push_back(k % 2 == 0 ? -1.5 : 1.5);
  const auto cycles = rainflow_of(values);
  for (const double m : {1.0, 3.0, 12.0}) {
    EXPECT_NEAR(equivalent_range(cycles, m, 10.0), 3.0, 1e-14);
    EXPECT_NEAR(equivalent_range(cycles, m, 20.0), 3.0 * std::pow(0.5, 1.0 / m), 1e-14);
  }
  for (double& x : values) x *= 1e200;
  EXPECT_NEAR(equivalent_range(rainflow_of(values), 12.0, 10.0) / 3e200, 1.0, 1e-14);
}

TEST(Measures, means_are_weighted_with_time) {
  const Sampled sine(2.0 * pi, 4000, [](double t) { return 3.0 + 2.0 * std::sin(t); });
  EXPECT_NEAR(mean_of(sine), 3.0, 2e-6);
  EXPECT_NEAR(rms_of(sine), std::sqrt(9.0 + 2.0), 2e-6);
  const std::vector<double> times = {0, 1, 1, 4}, values = {0, 0, 2, 2};  // a jump
  EXPECT_DOUBLE_EQ(mean_of({times, values}), 1.5);
  EXPECT_DOUBLE_EQ(rms_of({times, values}), std::sqrt(3.0));
  EXPECT_NEAR(percentile_of({times, values}, 25.0), 0.0, 1e-15);
}

TEST(Measures, percentiles_of_a_sine_are_those_of_the_arcsine_law) {
  const Sampled sine(2.0 * pi, 20000, [](double t) { return std::sin(t); });
  for (const double p : {1.0, 10.0, 50.0, 75.0, 99.0})
    EXPECT_NEAR(percentile_of(sine, p), std::sin(pi * (0.01 * p - 0.5)), 1e-5) << p;
  EXPECT_DOUBLE_EQ(percentile_of(sine, 100.0), *std::max_element(sine.values.begin(), sine.values.end()));
}

TEST(Measures, settling_time_of_a_decay_is_that_of_its_envelope) {
  const Sampled decay(10.0, 20000, [](double t) { return 1.0 - std::exp(-t); });
  EXPECT_NEAR(settling_time_of(decay, 1.0, 0.02).value(), std::log(50.0), 1e-6);
  EXPECT_FALSE(settling_time_of(decay, 5.0, 0.02).has_value());
  EXPECT_EQ(settling_time_of(decay, 0.5, 0.6).value(), 0.0);
}

TEST(Measures, dominant_frequency_is_found_between_lines_of_the_spectrum) {
  for (const double f : {1.0, 3.1, 12.34}) {
    const Sampled mixed(10.0, 3000, [f](double t) {
      return 5.0 + std::sin(2.0 * pi * f * t + 0.3) + 0.4 * std::sin(2.0 * pi * 2.7 * f * t) + 0.1 * t;
    });
    EXPECT_NEAR(dominant_frequency_of(mixed).value(), f, 0.02 / 10.0) << f;
  }
  EXPECT_FALSE(dominant_frequency_of(Sampled(1.0, 100, [](double) { return 2.0; })).has_value());
}

const char* const oscillator = R"("bodies": [{"name": "a", "kind": "point_mass", "mass": 1, "position": [2, 0, 0]}],
  "frames": [{"name": "wall"}],
  "springs": [{"name": "k", "first": "wall", "second": "a", "stiffness": 39.47841760435743, "rest_length": 1}],
  "motions": [{"at": "a", "y": 0, "z": 0}],
  "sensors": [{"name": "a", "kind": "position", "at": "a"}, {"name": "v", "kind": "velocity", "at": "a"}],
  "analysis": {"kind": "dynamic", "end_time": 4, "step_size": 0.002, "spectral_radius": 0.99}, "output": {"stride": 50},
  "parameters": {"half": 0.5, "w": 6.283185307179586})";

/// x = 1 + cos(2 pi t).
TEST(Measures, a_run_measures_all_accepted_steps_whatever_the_stride) {
  const scene::Scene scene = support::scene_of(std::string("{") + oscillator + R"x(, "measures": [
      {"name": "top", "quantity": "a.x", "figure": "max"},
      {"name": "early", "quantity": "a.x", "time": 1.2345},
      {"name": "end", "quantity": "v.vx"},
      {"name": "mean", "quantity": "a.x", "figure": "mean"},
      {"name": "period", "quantity": "a.x", "figure": "period", "level": 1},
      {"name": "energy", "expression": "half*v^2 + half*w^2*(x - 1)^2", "of": {"x": "a.x", "v": "v.vx"}, "figure": "max"},
      {"name": "frequency", "quantity": "a.x", "figure": "dominant_frequency"},
      {"name": "cycles", "quantity": "a.x", "figure": "cycles", "range": 1.9},
      {"name": "load", "quantity": "a.x", "figure": "equivalent_range", "exponent": 4},
      {"name": "late", "quantity": "a.x", "time": 5},
      {"name": "none", "expression": "log(x - 3)", "of": {"x": "a.x"}, "figure": "max"}]})x");
  const support::Outcome run = support::run(scene);
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  std::map<std::string, std::optional<double>> by_name;
  for (const records::MeasureResult& m : run.summary.measures) by_name[m.name] = m.value;
  ASSERT_EQ(by_name.size(), 11u);
  EXPECT_NEAR(by_name["top"].value(), 2.0, 1e-4);
  EXPECT_NEAR(by_name["early"].value(), 1.0 + std::cos(2.0 * pi * 1.2345), 2e-3);
  EXPECT_NEAR(by_name["end"].value(), 0.0, 0.01);
  EXPECT_NEAR(by_name["mean"].value(), 1.0, 1e-3);
  EXPECT_NEAR(by_name["period"].value(), 1.0, 1e-4);
  EXPECT_NEAR(by_name["energy"].value(), 0.5 * 4.0 * pi * pi, 1e-3 * 2.0 * pi * pi);
  EXPECT_NEAR(by_name["frequency"].value(), 1.0, 0.01);
  EXPECT_EQ(by_name["cycles"].value(), 4.0);
  EXPECT_NEAR(by_name["load"].value(), 2.0, 1e-3);  // one a second
  EXPECT_FALSE(by_name["late"].has_value());
  EXPECT_FALSE(by_name["none"].has_value());
}

TEST(Measures, a_measure_may_be_taken_from_a_part_of_the_run) {
  const support::Outcome run = support::run(support::scene_of(std::string("{") + oscillator + R"x(, "measures": [
      {"name": "mean", "quantity": "a.x", "figure": "mean", "from": 0.25, "to": 0.75},
      {"name": "top", "quantity": "a.x", "figure": "max", "from": 0.3001, "to": 0.6999},
      {"name": "last", "quantity": "a.x", "to": 1.1003},
      {"name": "cycles", "quantity": "a.x", "figure": "cycles", "range": 1.9, "from": 2},
      {"name": "speed", "expression": "abs(v)", "of": {"v": "v.vx"}, "figure": "max", "from": 0.9, "to": 1.1}]})x"));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  const auto value = [&run](std::size_t k) { return run.summary.measures.at(k).value.value(); };
  EXPECT_NEAR(value(0), 1.0 - 2.0 / pi, 1e-3);
  EXPECT_NEAR(value(1), 1.0 + std::cos(2.0 * pi * 0.3001), 1e-3);
  EXPECT_NEAR(value(2), 1.0 + std::cos(2.0 * pi * 1.1003), 1e-3);
  EXPECT_EQ(value(3), 2.0);
  EXPECT_NEAR(value(4), 2.0 * pi * std::sin(0.2 * pi), 5e-3);
}

TEST(Measures, a_measure_may_have_a_value_that_it_has_to_be) {
  const support::Outcome run = support::run(support::scene_of(std::string("{") + oscillator + R"x(, "measures": [
      {"name": "mean", "quantity": "a.x", "figure": "mean", "value": 1, "tolerance": 1e-3, "source": "by hand"},
      {"name": "rms", "quantity": "v.vx", "figure": "rms", "value": 4, "relative_tolerance": 0.01},
      {"name": "top", "quantity": "a.x", "figure": "max", "value": 2, "relative_tolerance": 1e-3},
      {"name": "none", "expression": "log(x - 3)", "of": {"x": "a.x"}, "figure": "max", "value": 0, "tolerance": 9},
      {"name": "late", "quantity": "a.x", "time": 5, "value": 0, "tolerance": 9},
      {"name": "only measured", "quantity": "a.x"}],
      "expected": [{"quantity": "a.x", "figure": "max", "value": 2, "tolerance": 1e-3}]})x"));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  EXPECT_EQ(run.summary.measures.size(), 6u);
  std::string verdicts;
  for (const records::ExpectedResult& e : run.summary.expected) verdicts += e.name + " " + e.verdict() + "; ";
  EXPECT_EQ(verdicts, run.summary.expected.at(0).name +
                          " holds; mean holds; rms fails; top holds; none fails; late not reached; ");
  EXPECT_EQ(run.summary.expected.at(1).source, "by hand");
  EXPECT_NEAR(run.summary.expected.at(2).value, 2.0 * std::numbers::pi / std::numbers::sqrt2, 0.01);
  EXPECT_DOUBLE_EQ(run.summary.expected.at(2).tolerance, 0.04);
}

TEST(Measures, measures_change_no_bit_of_the_run) {
  const support::Outcome plain = support::run(support::gallery("slider_crank", {"/analysis/end_time=0.1"}));
  const support::Outcome measured = support::run(support::gallery(
      "slider_crank", {"/analysis/end_time=0.1", R"(/measures=[{"name": "m", "quantity": ")" +
                                                     plain.history.columns[0] + R"(", "figure": "rms"}])"}));
  EXPECT_EQ(plain.history.rows, measured.history.rows);
  EXPECT_EQ(measured.summary.measures.size(), 1u);
}

TEST(Measures, a_measure_may_be_one_of_earlier_measures) {
  const scene::Scene scene = support::scene_of(std::string("{") + oscillator + R"x(, "measures": [
      {"name": "top", "quantity": "a.x", "figure": "max"},
      {"name": "speed", "expression": "abs(v)", "of": {"v": "v.vx"}, "figure": "max"},
      {"name": "ratio", "expression": "v/(w*(x - 1))", "of": {"x": "top", "v": "speed"}, "value": 1, "tolerance": 1e-2},
      {"name": "above", "expression": "step(x - 1.5)", "of": {"x": "top"}},
      {"name": "below", "expression": "1 - a", "of": {"a": "above"}},
      {"name": "late", "quantity": "a.x", "time": 5},
      {"name": "none", "expression": "x + y", "of": {"x": "top", "y": "late"}},
      {"name": "infinite", "expression": "1/x", "of": {"x": "below"}}]})x");
  const support::Outcome run = support::run(scene);
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  std::map<std::string, std::optional<double>> by_name;
  for (const records::MeasureResult& m : run.summary.measures) by_name[m.name] = m.value;
  ASSERT_EQ(by_name.size(), 8u);
  EXPECT_DOUBLE_EQ(by_name["ratio"].value(), *by_name["speed"] / (2.0 * pi * (*by_name["top"] - 1.0)));
  EXPECT_EQ(by_name["above"].value(), 1.0);
  EXPECT_EQ(by_name["below"].value(), 0.0);
  EXPECT_FALSE(by_name["none"].has_value());
  EXPECT_FALSE(by_name["infinite"].has_value());
  ASSERT_EQ(run.summary.expected.size(), 1u);
  EXPECT_EQ(run.summary.expected[0].verdict(), "holds");
  EXPECT_EQ(units_of_measures(scene, run.summary.header),
            (std::vector<std::string>{"m", "m/s", "", "", "", "m", "m", ""}));
  std::vector<bool> indicators;
  for (const scene::Measure& m : scene.measures) indicators.push_back(is_indicator(m));
  EXPECT_EQ(indicators, (std::vector<bool>{false, false, false, true, false, false, false, false}));
}

// A signal of unknown unit is no pure number, by which a length would stay a length.
TEST(Measures, of_signals_of_unknown_unit_have_none) {
  const scene::Scene scene = support::scene_of(R"x({"analysis": {"kind": "dynamic", "end_time": 1e-3},
    "bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}],
    "signals": [{"name": "gain", "kind": "input"}, {"name": "height", "kind": "position", "at": "a", "axis": "z"}],
    "sensors": [{"name": "a", "kind": "position", "at": "a"}, {"name": "gain", "kind": "signal", "signal": "gain"},
      {"name": "height", "kind": "signal", "signal": "height"}],
    "measures": [{"name": "product", "expression": "g*x", "of": {"g": "gain", "x": "a.x"}},
      {"name": "square", "expression": "h*x", "of": {"h": "height", "x": "a.x"}},
      {"name": "most", "quantity": "height", "figure": "max"}]})x");
  const support::Outcome run = support::run(scene);
  EXPECT_EQ(units_of_measures(scene, run.summary.header), (std::vector<std::string>{"", "m^2", "m"}));
}

TEST(Measures, what_is_wrong_with_a_measure_is_told) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"name": "m", "quantity": "b.x"})", "no sensor"},
      {R"({"name": "m", "quantity": "a"})", "components"},
      {R"({"name": "m"})", "exactly one of the keys"},
      {R"({"name": "m", "expression": "1"})", "\"of\""},
      {R"({"name": "m", "expression": "x + y", "of": {"x": "a.x"}})", "y"},
      {R"({"name": "m", "expression": "x", "of": {"x": "a.w"}})", "components"},
      {R"({"name": "m", "expression": "m", "of": {"m": "m"}})", "no sensor"},
      {R"({"name": "n", "quantity": "a.x"}, {"name": "m", "expression": "n", "of": {"n": "n"}, "figure": "max"})",
       "leave out"},
      {R"({"name": "n", "quantity": "a.x"}, {"name": "m", "expression": "n + x", "of": {"n": "n", "x": "a.x"}})",
       "of the others"},
      {R"({"name": "m", "quantity": "a.x", "figure": "settling_time"})", "band"},
      {R"({"name": "m", "quantity": "a.x", "figure": "maximum"})", "has to be"},
      {R"({"name": "m", "quantity": "a.x", "figure": "max", "time": 1})", "whole run"},
      {R"({"name": "m", "quantity": "a.x", "value": 1})", "needs a tolerance"},
      {R"({"name": "m", "quantity": "a.x", "value": 0, "relative_tolerance": 1})", "part of the value, which is 0"},
      {R"({"name": "m", "quantity": "a.x", "from": 3, "to": 2})", "is empty"},
      {R"({"name": "m", "quantity": "a.x", "figure": "mean", "to": 5})", "the run ends before, at 4"},
      {R"({"name": "n", "quantity": "a.x"}, {"name": "m", "expression": "n", "of": {"n": "n"}, "from": 1})",
       "no part of the run"},
      {R"({"name": "m", "quantity": "a.x", "tolerance": 1})", "goes with a \"value\""}};
  for (const auto& [measure, word] : cases) {
    try {
      (void)support::scene_of(std::string("{") + oscillator + ", \"measures\": [" + measure + "]}");
      ADD_FAILURE() << measure;
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << measure << ": " << e.what();
    }
  }
}

}  // namespace
}  // namespace bough::run
