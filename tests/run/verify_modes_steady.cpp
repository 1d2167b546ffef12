/// Modes of what turns, is damped or follows, against published and computed figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "modes_scenes.hpp"
#include "two_disc_rotor.hpp"

namespace bough::verify {
namespace {

using support::scene_of;
using support::text;

/// A blade of 2 m on a hub that turns at a constant speed, seen from the hub. Section and frequencies of
/// rotating_beam_modes.csv. The faster it turns, the finer its mesh has to be; the finer the mesh, the more of the slowest
/// frequency is round-off of the fastest, 1e-8 with 96 elements at 20 rad/s.
scene::Scene blade(double hub, double speed) {
  return scene_of(R"({"frames": [{"name": "hub", "turns": [{"axis": [0, 0, 1], "angle": )" + text(speed) +
                  R"(, "rate": true}]}],
    "sections": [{"name": "bar", "stiffness": {"EA": 2.52e8, "GA2": 7.8e7, "GA3": 7.8e7, "GJ": 23655.68360786024, "EI2": 18900, "EI3": 302400},
                  "mass": {"mass_per_length": 9.72, "rotary": [0.012393, 0.000729, 0.011664]}}],
    "nodes": [{"name": "root", "position": [)" +
                  text(hub) + R"(, 0, 0]}, {"name": "tip", "position": [)" + text(hub + 2.0) + R"(, 0, 0]}],
    "beams": [{"name": "blade", "section": "bar", "start": "root", "end": "tip", "axis_2": [0, 1, 0], "elements": )" +
                  std::to_string(speed > 300.0 ? 72 : 48) + R"(, "order": 3}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "hub", "second": "root"}],
    "analysis": {"kind": "modes", "frame": "hub", "count": 8, "tolerance": 1e-12}})");
}

TEST(ModesInMotion, a_blade_on_a_turning_hub_has_the_frequencies_of_its_steady_state) {
  const support::Table exact = support::reference("rotating_beam_modes.csv");
  double worst = 0.0;
  for (std::size_t row = 0; row < exact.rows.size(); ++row) {
    const double hub = exact.times[row], speed = exact.of("Omega_rad_s")[row];
    const ModesSeen seen(blade(hub, speed));
    EXPECT_TRUE(seen.outcome.summary.doubts.empty());
    const std::vector<double> w = seen.frequencies();
    ASSERT_GE(w.size(), 8U);
    for (std::size_t k = 0; k < 8; ++k) {
      const double right = exact.of("omega" + std::to_string(k + 1) + "_rad_s")[row];
      worst = std::max(worst, std::abs(w[k] / right - 1.0));
      EXPECT_NEAR(w[k], right, 1e-8 * right) << "hub " << hub << ", speed " << speed << ", mode " << k + 1;
    }
    EXPECT_LT(seen.largest_residual(), 1e-8);
  }
  std::printf("| blade on a turning hub, 96 frequencies | within %.1e |\n", worst);
}

scene::Scene rotor(double speed, double damping, const std::string& more_analysis) {
  return scene_of(
      two_disc_rotor(text(speed), damping, R"({"kind": "modes", "about": "start", "count": 12)" + more_analysis + "}"));
}

void expect_rotor(const std::string& name, double damping) {
  const support::Table all = support::reference("rotor_two_discs.csv");
  double worst = 0.0;
  for (const double speed : {0.0, 314.159265359, 418.879020479}) {
    std::vector<std::complex<double>> exact;
    for (std::size_t row = 0; row < all.rows.size(); ++row)
      if (std::abs(all.times[row] - (damping > 0.0 ? 5.0 : 1.0)) < 1e-9 &&
          std::abs(all.of("speed")[row] - speed) < 1e-6)
        exact.emplace_back(all.of("real")[row], std::abs(all.of("imaginary")[row]));
    ASSERT_EQ(exact.size(), 8U);
    const ModesSeen seen(rotor(speed, damping, damping > 0.0 ? R"(, "damping": true)" : ""));
    EXPECT_TRUE(seen.outcome.summary.doubts.empty()) << seen.outcome.summary.doubts.front().text;
    for (const std::complex<double>& right : exact) {
      double away = 1e300;
      for (std::size_t k = 0; k < seen.count(); ++k) away = std::min(away, std::abs(seen.eigenvalue(k) - right));
      worst = std::max(worst, away / std::abs(right));
      EXPECT_LT(away, 1e-7 * std::abs(right)) << name << " at " << speed << ": " << right;
    }
    EXPECT_LT(seen.largest_residual(), 1e-7);
  }
  std::printf("| rotor %s, 24 eigenvalues | within %.1e |\n", name.c_str(), worst);
}

TEST(ModesInMotion, a_rotor_that_spins_in_its_bearings_whirls_as_published) { expect_rotor("5.9.1", 0.0); }

TEST(ModesInMotion, a_rotor_in_damped_bearings_has_the_published_pairs) { expect_rotor("5.9.5", 3e3); }

TEST(ModesInMotion, whirl_is_named_and_seen_from_the_ground) {
  const ModesSeen seen(rotor(418.879020479, 0.0, ""));
  EXPECT_TRUE(seen.says("from the ground"));
  std::vector<std::string> words;
  for (std::size_t k = 0; k < seen.count(); ++k)
    if (seen.text(k, "kind") == "vibration") words.push_back(seen.text(k, "what"));
  ASSERT_GE(words.size(), 2U);
  EXPECT_NE(words[0].find("whirls backward about (1, 0, 0)"), std::string::npos) << words[0];
  EXPECT_NE(words[1].find("whirls forward about (1, 0, 0)"), std::string::npos) << words[1];
}

TEST(ModesInMotion, a_damped_oscillator_has_its_closed_form_and_dampers_can_be_left_out) {
  const auto scene = [](double damping, const std::string& more) {
    return scene_of(R"({"bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1]}],
      "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0],
                  "forces": [{"stiffness": 50, "damping": )" +
                    text(damping) + R"(}]}],
      "analysis": {"kind": "modes")" +
                    more + "}}");
  };
  const ModesSeen light(scene(4.0, R"(, "damping": true)"));
  ASSERT_EQ(light.count(), 1U);
  EXPECT_NEAR(light.eigenvalue(0).real(), -1.0, 1e-12);
  EXPECT_NEAR(light.eigenvalue(0).imag(), std::sqrt(24.0), 1e-11);
  EXPECT_NEAR(light.number(0, "damping_ratio"), 0.2, 1e-12);
  const ModesSeen heavy(scene(40.0, R"(, "damping": true)"));
  ASSERT_EQ(heavy.count_of("decay"), 2U);
  EXPECT_NEAR(heavy.eigenvalue(0).real(), -10.0 + std::sqrt(75.0), 1e-10);
  EXPECT_NEAR(heavy.eigenvalue(1).real(), -10.0 - std::sqrt(75.0), 1e-10);
  const ModesSeen undamped(scene(4.0, ""));
  EXPECT_NEAR(undamped.frequencies().at(0), 5.0, 1e-12);
  EXPECT_TRUE(undamped.outcome.summary.notes.back().find("dampers are left out") != std::string::npos);
}

/// A mass pulled back by a controller: the lag of its actuator is a state of a signal.
TEST(ModesInMotion, a_controlled_mass_has_the_poles_of_its_loop) {
  const ModesSeen seen(scene_of(R"({"parameters": {"k": 50, "T": 0.1},
    "bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1]}],
    "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0],
                "forces": [{"effort": {"signal": "push"}}]}],
    "signals": [{"name": "place", "kind": "joint_displacement", "joint": "rail"},
                {"name": "speed", "kind": "joint_rate", "joint": "rail"},
                {"name": "push", "kind": "state", "expression": "(-k*place - 8*speed - push)/T"}],
    "analysis": {"kind": "modes"}})"));
  // 2 s^2 x = F, (T s + 1) F = -(k + 8 s) x:  2 T s^3 + 2 s^2 + 8 s + k = 0
  double sum = 0.0;
  for (std::size_t k = 0; k < seen.count(); ++k) {
    const std::complex<double> s = seen.eigenvalue(k);
    EXPECT_LT(std::abs(((0.2 * s + 2.0) * s + 8.0) * s + 50.0), 1e-8 * 50.0);
    sum += seen.text(k, "kind") == "decay" ? s.real() : 2.0 * s.real();
  }
  EXPECT_EQ(seen.count(), 2U);
  EXPECT_NEAR(sum, -10.0, 1e-8);
}

/// Oil of 1.4e9 Pa beside places of a metre: the pressure is a state, and nothing damps.
TEST(ModesInMotion, an_undamped_oscillator_whose_state_is_a_pressure_is_not_damped) {
  const ModesSeen seen(
      support::gallery("cylinder", {"/analysis={\"kind\": \"modes\", \"about\": \"start\"}", "/expected=[]"}));
  ASSERT_EQ(seen.count_of("vibration") + seen.count_of("growing vibration"), 1U);
  EXPECT_NEAR(seen.frequencies().at(0), 2.0 * 3.141592653589793 / 0.07509842836890551, 1e-9 * seen.frequencies().at(0));
  EXPECT_LT(std::abs(seen.number(seen.count() - 1, "damping_ratio")), 1e-9);
}

/// Beck's column: a load that follows its end. Without shear and rotary inertia the first two frequencies meet at P =
/// 20.0509536 EI / L^2.
TEST(ModesInMotion, a_column_under_a_load_that_follows_flutters_as_becks) {
  const auto column = [](double load) {
    return scene_of(
        R"({"sections": [{"name": "bar", "stiffness": {"EA": 1e8, "GA2": 1e8, "GA3": 1e8, "GJ": 1, "EI2": 1, "EI3": 1},
                  "mass": {"mass_per_length": 1, "rotary": [1e-8, 1e-8, 1e-8]}}],
      "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
      "beams": [{"name": "column", "section": "bar", "start": "root", "end": "tip", "axis_2": [0, 1, 0], "elements": 12, "order": 3}],
      "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
      "loads": [{"name": "thrust", "at": "tip", "force": [)" +
        text(-load) + R"(, 0, 0], "axes": "body"}],
      "analysis": {"kind": "modes", "count": 4}})");
  };
  const std::pair<double, std::pair<double, double>> exact[] = {{5.0, {4.2176752348296, 20.435622434999}},
                                                                {15.0, {6.6274066834721, 16.259829762528}}};
  for (const auto& [load, pair] : exact) {
    const std::vector<double> w = ModesSeen(column(load)).frequencies();
    ASSERT_GE(w.size(), 4U);
    EXPECT_NEAR(w[0], pair.first, 1e-5 * pair.first);
    EXPECT_NEAR(w[2], pair.second, 1e-5 * pair.second);
  }
  const ModesSeen above(column(20.2));
  EXPECT_EQ(above.count_of("growing vibration"), 2U);  // in both planes
  EXPECT_TRUE(above.outcome.summary.notes.back().find("unstable") != std::string::npos);
  EXPECT_EQ(ModesSeen(column(19.9)).count_of("growing vibration"), 0U);
}

}  // namespace
}  // namespace bough::verify
