/// Modes over a speed or a load, followed through crossings, against published and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <set>

#include "table_seen.hpp"
#include "two_disc_rotor.hpp"

namespace bough::verify {
namespace {

using support::scene_of;
using support::text;

constexpr double pi = std::numbers::pi;

/// Rows of one branch.
std::vector<std::size_t> rows_of(const TableSeen& seen, const std::string& branch) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < seen.count(); ++k)
    if (seen.text(k, "branch") == branch) rows.push_back(k);
  return rows;
}

support::Outcome two_discs(double damping, const std::string& values) {
  return support::run_ok(scene_of(two_disc_rotor(
      R"({"expression": "speed"})", damping,
      R"({"kind": "campbell", "about": "start", "parameter": "/parameters/speed", "speed": "rad/s", "count": 12, "values": )" +
          values + (damping > 0.0 ? R"(, "damping": true})" : "}"),
      R"("parameters": {"speed": 0},)")));
}

TEST(Campbell, branches_of_a_rotor_pass_the_published_eigenvalues) {
  const support::Table all = support::reference("rotor_two_discs.csv");
  for (const double damping : {0.0, 3e3}) {
    const support::Outcome outcome = two_discs(damping, "[0, 60, 120, 180, 240, 314.159265359, 370, 418.879020479]");
    const TableSeen seen(outcome, "campbell");
    double worst = 0.0;
    for (std::size_t row = 0; row < all.rows.size(); ++row) {
      if (std::abs(all.times[row] - (damping > 0.0 ? 5.0 : 1.0)) > 1e-9) continue;
      const std::complex<double> right(all.of("real")[row], std::abs(all.of("imaginary")[row]));
      double away = 1e300;
      for (std::size_t k = 0; k < seen.count(); ++k)
        if (std::abs(seen.number(k, "value") - all.of("speed")[row]) < 1e-6)
          away = std::min(
              away,
              std::abs(std::complex<double>(seen.number(k, "real_part"), seen.number(k, "imaginary_part")) - right));
      worst = std::max(worst, away / std::abs(right));
      EXPECT_LT(away, 1e-7 * std::abs(right)) << right;
    }
    std::printf("| campbell, two discs, damping %g | eigenvalues within %.1e |\n", damping, worst);
    // A branch keeps its sense of whirl: the forward one rises, the backward one falls.
    for (std::size_t b = 1; b <= 4; ++b) {
      const std::vector<std::size_t> rows = rows_of(seen, std::to_string(b));
      ASSERT_EQ(rows.size(), 8U);
      const bool is_forward = seen.text(rows.back(), "what").find("forward") != std::string::npos;
      for (std::size_t k = 2; k < rows.size(); ++k) {
        EXPECT_EQ(seen.number(rows[k], "frequency") > seen.number(rows[k - 1], "frequency"), is_forward)
            << b << " " << k;
        EXPECT_EQ(seen.text(rows[k], "what").find("forward") != std::string::npos, is_forward);
      }
    }
  }
}

/// Examples 5.9.2, 5.9.3 (bearings softer in one direction, computed to 1e-6) and 5.9.9 (a disc behind its bearing, to
/// 1e-8), at rest and at 4000 1/min.
TEST(Campbell, rotors_on_unlike_bearings_and_with_an_overhung_disc_have_the_computed_frequencies) {
  struct Case {
    const char* name;
    RotorVariant variant;
    std::vector<double> at_rest, at_speed;
    double accuracy;
  };
  const Case cases[] = {{"5.9.2",
                         {8e5, 1e6, false},
                         {82.652948, 86.658013, 254.515613, 274.307102, 679.295887, 716.563497},
                         {82.32538, 86.86360, 239.63861, 287.24254, 583.39579, 806.49900},
                         1e-6},
                        {"5.9.3",
                         {2e5, 1e6, false},
                         {53.701171, 86.658013, 143.898370, 274.307102, 539.231711, 716.563497},
                         {53.69233, 86.52478, 140.45653, 276.85774, 494.76846, 756.06919},
                         1e-6},
                        {"5.9.9",
                         {1e7, 1e7, true},
                         {90.143011079, 630.501650599, 830.311450402},
                         {76.190049866, 103.908490317, 565.947262988, 634.000960310, 647.529378502, 1173.587993897},
                         1e-8}};
  for (const Case& one : cases) {
    const support::Outcome outcome = support::run_ok(scene_of(two_disc_rotor(
        R"({"expression": "speed"})", 0.0,
        R"({"kind": "campbell", "about": "start", "parameter": "/parameters/speed", "count": 12, "values": [0, 418.879020479]})",
        R"("parameters": {"speed": 0},)", one.variant)));
    const TableSeen seen(outcome, "campbell");
    double worst = 0.0;
    for (const bool turns : {false, true})
      for (const double right : turns ? one.at_speed : one.at_rest) {
        double away = 1e300;
        for (std::size_t k = 0; k < seen.count(); ++k)
          if ((seen.number(k, "value") > 0.0) == turns)
            away = std::min(away, std::abs(seen.number(k, "imaginary_part") - right));
        worst = std::max(worst, away / right);
        EXPECT_LT(away, one.accuracy * right) << one.name << (turns ? " turning: " : " at rest: ") << right;
      }
    std::printf("| rotor %s | within %.1e |\n", one.name, worst);
  }
}

/// A circular shaft on points: bending waves and gyroscopic moments of its sections.
TEST(Campbell, whirl_of_a_spinning_shaft_is_that_of_the_closed_form) {
  const double E = 2.1e11, G = E / 2.6, r = 0.02, A = pi * r * r, I = A * r * r / 4.0, rho = 7850.0;
  const support::Outcome outcome = support::run_ok(
      scene_of(R"({"parameters": {"speed": 0}, "sections": [{"name": "shaft", "stiffness": {"EA": )" + text(E * A) +
               R"(, "GA2": )" + text(G * A * 6.0 / 7.0) + R"(, "GA3": )" + text(G * A * 6.0 / 7.0) + R"(, "GJ": )" +
               text(2.0 * G * I) + R"(, "EI2": )" + text(E * I) + R"(, "EI3": )" + text(E * I) +
               R"(}, "mass": {"mass_per_length": )" + text(rho * A) + R"(, "rotary": [)" + text(2.0 * rho * I) + ", " +
               text(rho * I) + ", " + text(rho * I) + R"(]}}],
    "nodes": [{"name": "a"}, {"name": "b", "position": [1.2, 0, 0]}],
    "beams": [{"name": "shaft", "section": "shaft", "start": "a", "end": "b", "axis_2": [0, 1, 0], "elements": 24, "order": 3}],
    "motions": [{"name": "left", "at": "a", "x": 0, "y": 0, "z": 0}, {"name": "right", "at": "b", "y": 0, "z": 0}],
    "initial_velocities": [{"of": "shaft", "angular_velocity": [{"expression": "speed"}, 0, 0]}],
    "analysis": {"kind": "campbell", "about": "start", "parameter": "/parameters/speed", "count": 6,
                 "values": [0, 200, 500, 1000, 2000]}})"));
  const TableSeen seen(outcome, "campbell");
  const support::Table exact = support::reference("shaft_whirl.csv");
  double worst = 0.0;
  for (std::size_t row = 0; row < exact.rows.size(); ++row)
    for (const std::size_t column : {1U, 2U}) {
      const double right = exact.rows[row][column];
      double away = 1e300;
      for (std::size_t k = 0; k < seen.count(); ++k)
        if (seen.number(k, "value") == exact.times[row])
          away = std::min(away, std::abs(seen.number(k, "angular_frequency") - right));
      worst = std::max(worst, away / right);
      EXPECT_LT(away, 1e-7 * right) << exact.times[row] << " " << right;
    }
  std::printf("| whirl of a shaft, 30 frequencies | within %.1e |\n", worst);
}

/// The blade on its hub over the speed, whose branches cross.
TEST(Campbell, frequencies_of_a_blade_over_the_speed_are_those_of_its_steady_state) {
  const support::Table exact = support::reference("rotating_beam_modes.csv");
  const support::Outcome outcome = support::run_ok(scene_of(R"({"parameters": {"speed": 0},
    "frames": [{"name": "hub", "turns": [{"axis": [0, 0, 1], "angle": {"expression": "speed"}, "rate": true}]}],
    "sections": [{"name": "bar", "stiffness": {"EA": 2.52e8, "GA2": 7.8e7, "GA3": 7.8e7, "GJ": 23655.68360786024, "EI2": 18900, "EI3": 302400},
                  "mass": {"mass_per_length": 9.72, "rotary": [0.012393, 0.000729, 0.011664]}}],
    "nodes": [{"name": "root", "position": [0.5, 0, 0]}, {"name": "tip", "position": [2.5, 0, 0]}],
    "beams": [{"name": "blade", "section": "bar", "start": "root", "end": "tip", "axis_2": [0, 1, 0], "elements": 48, "order": 3}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "hub", "second": "root"}],
    "analysis": {"kind": "campbell", "frame": "hub", "parameter": "/parameters/speed", "speed": "rad/s", "count": 11,
                 "tolerance": 1e-12, "values": [0, 20, 50, 100, 200]}})"));
  const TableSeen seen(outcome, "campbell");
  double worst = 0.0;
  for (std::size_t row = 0; row < exact.rows.size(); ++row) {
    const double speed = exact.of("Omega_rad_s")[row];
    if (exact.times[row] != 0.5 || speed > 300.0) continue;
    for (int m = 1; m <= 8; ++m) {
      const double right = exact.of("omega" + std::to_string(m) + "_rad_s")[row];
      double away = 1e300;
      for (std::size_t k = 0; k < seen.count(); ++k)
        if (seen.number(k, "value") == speed && seen.text(k, "branch").back() != 'x')
          away = std::min(away, std::abs(seen.number(k, "angular_frequency") - right));
      worst = std::max(worst, away / right);
      EXPECT_LT(away, 1e-8 * right) << speed << " " << m;
    }
  }
  std::printf("| blade over the speed, 40 frequencies | within %.1e |\n", worst);
}

/// Critical speeds of the rotor: those at which a mode has the speed itself as its frequency.
TEST(Campbell, critical_speeds_are_those_at_which_the_rotor_has_a_mode_of_its_speed) {
  const support::Outcome outcome = two_discs(0.0, R"({"from": 40, "to": 400, "count": 19})");
  const TableSeen critical(outcome, "critical");
  ASSERT_GE(critical.count(), 3U);
  for (std::size_t k = 0; k < critical.count(); ++k) {
    const double speed = critical.number(k, "value");
    const TableSeen there(two_discs(0.0, "[" + text(speed) + ", " + text(speed + 1e-3) + "]"), "campbell");
    double away = 1e300;
    for (std::size_t row = 0; row < there.count(); ++row)
      if (there.number(row, "value") == speed && there.text(row, "branch").back() != 'x')
        away = std::min(away, std::abs(there.number(row, "angular_frequency") - speed));
    std::printf("| critical speed | %.6f rad/s, %.1e off |\n", speed, away / speed);
    EXPECT_LT(away, 1e-6 * speed);
  }
}

/// Two oscillators that cross without touching each other, and two that a weak spring couples.
TEST(Campbell, branches_cross_where_nothing_couples_them_and_veer_where_something_does) {
  const auto scene = [](double coupling) {
    return scene_of(R"({"parameters": {"k": 50},
      "bodies": [{"name": "one", "mass": 1, "inertia": [1, 1, 1]}, {"name": "two", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]}],
      "joints": [{"name": "a", "kind": "prismatic", "first": "ground", "second": "one", "axis": [1, 0, 0], "forces": [{"stiffness": {"expression": "k"}}]},
                 {"name": "b", "kind": "prismatic", "first": "ground", "second": "two", "axis": [1, 0, 0], "forces": [{"stiffness": 100}]}],
      "springs": [{"name": "s", "first": "one", "second": "two", "stiffness": )" +
                    text(coupling) + R"(, "rest_length": 1}],
      "analysis": {"kind": "campbell", "parameter": "/parameters/k", "count": 2, "values": {"from": 50, "to": 150, "count": 20}}})");
  };
  for (const double coupling : {1e-9, 4.0}) {
    const support::Outcome outcome = support::run_ok(scene(coupling));
    const TableSeen seen(outcome, "campbell");
    const std::vector<std::size_t> first = rows_of(seen, "1"), second = rows_of(seen, "2");
    ASSERT_EQ(first.size(), 20U);
    ASSERT_EQ(second.size(), 20U);
    bool crosses = false;
    for (std::size_t k = 0; k < 20; ++k)
      crosses = crosses || seen.number(first[k], "frequency") > seen.number(second[k], "frequency");
    EXPECT_EQ(crosses, coupling < 1.0);
  }
}

/// Beck's column: with a tangential load of 20.05 EI / L^2 it begins to flutter.
TEST(Campbell, the_onset_of_flutter_is_where_a_branch_begins_to_grow) {
  const support::Outcome outcome = support::run_ok(scene_of(R"({"parameters": {"P": 1},
    "sections": [{"name": "bar", "stiffness": {"EA": 1e6, "GA2": 1e6, "GA3": 1e6, "GJ": 1e3, "EI2": 1, "EI3": 1e3},
                  "mass": {"mass_per_length": 1, "rotary": [2e-6, 1e-6, 1e-6]}}],
    "nodes": [{"name": "foot"}, {"name": "top", "position": [1, 0, 0]}],
    "beams": [{"name": "column", "section": "bar", "start": "foot", "end": "top", "axis_2": [0, 1, 0], "elements": 8, "order": 3}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "foot"}],
    "loads": [{"name": "push", "at": "top", "axes": "body", "force": [{"expression": "-P"}, 0, 0], "law": 1}],
    "analysis": {"kind": "campbell", "parameter": "/parameters/P", "count": 2, "damping": true,
                 "values": [16, 17, 18, 19, 19.5, 19.8, 19.95, 20.02, 20.08, 20.15, 20.3, 20.6, 21]}})"));
  const TableSeen critical(outcome, "critical");
  ASSERT_GE(critical.count(), 1U);
  EXPECT_EQ(critical.text(0, "event"), "onset of flutter");
  const double w = 2.0 * pi * critical.number(0, "frequency");
  std::printf("| Beck's column | flutter at %.6f with %.6f rad/s |\n", critical.number(0, "value"), w);
  EXPECT_NEAR(critical.number(0, "value"), 20.0509536189737612, 2e-3);
  EXPECT_NEAR(w, 11.01555764092287, 2e-3);
}

TEST(Campbell, a_value_with_which_the_scene_is_at_fault_is_told) {
  EXPECT_THROW(two_discs(0.0, "[3, 2]"), std::runtime_error);
  try {
    (void)scene_of(two_disc_rotor("1", 0.0,
                                  R"({"kind": "campbell", "parameter": "/parameters/sped", "values": [1, 2]})",
                                  R"("parameters": {"speed": 0},)"));
    FAIL();
  } catch (const std::runtime_error& fault) {
    EXPECT_NE(std::string(fault.what()).find("/analysis/values/0"), std::string::npos) << fault.what();
  }
}

}  // namespace
}  // namespace bough::verify
