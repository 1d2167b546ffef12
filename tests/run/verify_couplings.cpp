// Couplings of the catalogue in whole scenes: closed forms, laws, and the same result whatever the plan leaves out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::run_ok;
using support::scene_of;
using support::Table;
using support::text;

/// A ball of 0.1 m and 2 kg over the ground, thrown with `velocity`; without gravity unless it is given.
std::string ball(double height, const std::string& velocity, double dissipation, double time, double step,
                 const std::string& gravity = "[0, 0, 0]", const std::string& rest = "") {
  return R"({"gravity": )" + gravity + R"(, "bodies": [{"name": "ball", "mass": 2, "inertia": [0.01, 0.01, 0.01],
    "position": [0.3, 0, )" +
         text(height) + R"(]}],
    "contacts": [{"name": "floor", "first": "ground", "second": "ball", "normal": [0, 0, 2], "radius": 0.1,
      "stiffness": 1e6, "dissipation": )" +
         text(dissipation) + R"(}],
    "initial_velocities": [{"of": "ball", "velocity": )" +
         velocity + R"(}],
    "sensors": [{"name": "ball", "kind": "position", "at": "ball"}, {"name": "speed", "kind": "velocity", "at": "ball"},
      {"name": "floor", "kind": "force", "of": "floor"}, {"name": "energy", "kind": "total_energy"}],
    "analysis": {"kind": "dynamic", "end_time": )" +
         text(time) + R"(, "step_size": )" + text(step) + "}" + rest + "}";
}
double lowest(const Table& h, const char* column) {
  const std::vector<double> values = h.of(column);
  return *std::min_element(values.begin(), values.end());
}

// (2/5) k d^(5/2) = m v^2 / 2 at the greatest depth d, F = k d^(3/2), and an impact lasts 2.9432651 d / v (Hertz).
TEST(Contact, of_an_elastic_sphere_is_that_of_hertz) {
  constexpr double m = 2.0, k = 1e6, v = 1.5, radius = 0.1, gap = 0.01;
  const double depth = std::pow(1.25 * m * v * v / k, 0.4), lasts = 2.9432651 * depth / v;
  const double end = gap / v + lasts + 0.01;
  const auto h = run_ok(scene_of(ball(radius + gap, "[0, 0, -1.5]", 0.0, end, lasts / 400))).history;
  EXPECT_NEAR(radius - lowest(h, "ball.z"), depth, 1e-4 * depth);
  EXPECT_NEAR(h.largest("floor.fz"), k * std::pow(depth, 1.5), 2e-4 * k * std::pow(depth, 1.5));
  EXPECT_NEAR(h.last("speed.vz"), v, 2e-4 * v);
  EXPECT_NEAR(h.last("ball.z"), radius + v * (end - gap / v - lasts), 2e-4 * depth);
  EXPECT_NEAR(h.last("energy"), 0.5 * m * v * v, 2e-4 * m * v * v);
}

// 1 - e = a v for slow impacts, to the order (a v)^2.
TEST(Contact, leaves_the_restitution_that_its_dissipation_says) {
  for (const double a : {0.02, 0.1}) {
    const double v = 0.5, depth = std::pow(1.25 * 2.0 * v * v / 1e6, 0.4);
    const auto h = run_ok(scene_of(ball(0.1 + 1e-3, "[0, 0, -0.5]", a, 1e-3 / v + 5.0 * depth / v, depth / v / 200)));
    const double lost = 1.0 - h.history.last("speed.vz") / v;
    EXPECT_NEAR(lost, a * v, 1.2 * a * v * a * v);
    EXPECT_GT(lost, 0.0);
  }
}

// k d^(3/2) = m g.
TEST(Contact, bears_a_weight_in_statics) {
  scene::Scene s = scene_of(R"({"gravity": [0, 0, -9.81],
    "bodies": [{"name": "ball", "mass": 2, "inertia": [0.01, 0.01, 0.01], "position": [0, 0, 0.0995]}],
    "contacts": [{"name": "floor", "first": "ground", "second": "ball", "normal": [0, 0, 1], "radius": 0.1,
                  "stiffness": 1e6}],
    "joints": [{"name": "guide", "kind": "prismatic", "first": "ground", "second": "ball", "position": [0, 0, 0.0995],
                "axis": [0, 0, 1]}],
    "sensors": [{"name": "ball", "kind": "position", "at": "ball"}, {"name": "floor", "kind": "force", "of": "floor"}],
    "analysis": {"kind": "static"}})");
  const auto h = run_ok(s).history;
  EXPECT_NEAR(h.last("ball.z"), 0.1 - std::pow(2.0 * 9.81 / 1e6, 2.0 / 3.0), 1e-9);
  EXPECT_NEAR(h.last("floor.fz"), 2.0 * 9.81, 1e-6);
}

void expect_same(const std::string& text, const char* decision) {
  SCOPED_TRACE(decision);
  const auto with = run_ok(scene_of(text)).history;
  const auto without =
      run_ok(scene_of(text, {std::string("/without=[\"planar\", \"translation\", \"line\"]")})).history;
  for (const char* column : {"ball.x", "ball.y", "ball.z", "speed.vx", "speed.vz", "floor.fx", "floor.fz"})
    for (std::size_t row = 0; row < with.times.size(); ++row)
      ASSERT_NEAR(with.of(column)[row], without.of(column)[row], 1e-8 * (1.0 + with.largest(column)))
          << column << " in row " << row;
}

TEST(Contact, is_alike_on_a_line_in_a_plane_where_nothing_turns_and_in_space) {
  const std::string weight = "[0, 0, -9.81]";
  expect_same(ball(0.12, "[0, 0, 0]", 0.1, 0.3, 2e-4, weight), "line");
  expect_same(ball(0.12, "[0.7, 0, 0]", 0.1, 0.3, 2e-4, weight), "translation");
  expect_same(ball(0.12, "[0.7, 0.4, 0]", 0.1, 0.3, 2e-4, weight), "translation");
  // On a board that swings: the contact turns with it.
  expect_same(R"({"gravity": [0, 0, -9.81], "bodies": [
      {"name": "board", "mass": 5, "inertia": [0.4, 0.4, 0.4], "position": [0, 0, 0]},
      {"name": "ball", "mass": 2, "inertia": [0.01, 0.01, 0.01], "position": [0.3, 0, 0.12]}],
    "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "board", "position": [0, 0, 0],
                "axis": [0, 1, 0]}],
    "torsion_springs": [{"name": "spring", "first": "ground", "second": "board", "axis": [0, -3, 0], "stiffness": 200,
                         "hardening": 3000, "damping": 2}],
    "contacts": [{"name": "floor", "first": "board", "second": "ball", "normal": [0, 0, 1], "radius": 0.1,
                  "stiffness": 1e5, "dissipation": 0.1}],
    "sensors": [{"name": "ball", "kind": "position", "at": "ball"}, {"name": "speed", "kind": "velocity", "at": "ball"},
      {"name": "floor", "kind": "force", "of": "floor"}, {"name": "energy", "kind": "total_energy"}],
    "analysis": {"kind": "dynamic", "end_time": 0.3, "step_size": 5e-4}})",
              "planar");
}

// The ball and the board, free in space, exchange momentum and angular momentum: their sums are kept, but for the error
// of the steps, which is of second order.
TEST(Contact, keeps_momentum_and_angular_momentum) {
  const auto run_in = [](const char* step) {
    return run_ok(scene_of(std::string(R"({"bodies": [
      {"name": "board", "mass": 5, "inertia": [0.4, 0.3, 0.5], "position": [0, 0, 0]},
      {"name": "ball", "mass": 2, "inertia": [0.01, 0.01, 0.01], "position": [0.3, 0.2, 0.12]}],
    "contacts": [{"name": "floor", "first": "board", "second": "ball", "normal": [0, 0, 1], "radius": 0.1,
                  "stiffness": 1e5}],
    "initial_velocities": [{"of": "ball", "velocity": [0.1, 0.2, -1]},
                           {"of": "board", "angular_velocity": [0.2, 0.1, 0.3]}],
    "sensors": [{"name": "board", "kind": "rotation", "at": "board"}],
    "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": )") +
                           step + "}}"));
  };
  const support::Outcome coarse = run_in("2e-4"), fine = run_in("1e-4");
  EXPECT_GT(std::abs(fine.history.last("board.ry")), 0.03);
  const records::Checks &a = coarse.summary.checks, &b = fine.summary.checks;
  EXPECT_LT(b.momentum_balance, 1e-6 * b.momentum_scale);
  EXPECT_LT(b.angular_momentum_balance, 1e-5 * b.angular_momentum_scale);
  EXPECT_GT(a.momentum_balance, 3.0 * b.momentum_balance);
  EXPECT_GT(a.angular_momentum_balance, 3.0 * b.angular_momentum_balance);
}

// M = k a + k3 a^3, in statics, whichever way the axis and the frames are drawn.
TEST(TorsionSpring, hardens_as_its_law_says) {
  for (const char* turned : {"0", "0.9", "-2.5"}) {
    const auto h = run_ok(scene_of(std::string(R"({"bodies": [{"name": "arm", "mass": 1, "inertia": [0.1, 0.1, 0.1],
        "position": [1, 2, 3], "rotation": {"axis": [1, 1, 0], "angle": )") +
                                   turned + R"(}}],
      "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "arm", "position": [1, 2, 3],
                  "axis": [0, 1, 1]}],
      "torsion_springs": [{"name": "spring", "first": "ground", "second": "arm", "axis": [0, 2, 2], "stiffness": 3,
                           "hardening": 4}],
      "loads": [{"at": "arm", "moment": [0, 3.5, 3.5]}],
      "sensors": [{"name": "hinge", "kind": "joint_angle", "joint": "hinge"},
                  {"name": "spring", "kind": "force", "of": "spring"}],
      "analysis": {"kind": "static"}})"))
                       .history;
    const double angle = h.last("hinge"), moment = 3.5 * std::sqrt(2.0);
    EXPECT_NEAR(3.0 * angle + 4.0 * angle * angle * angle, moment, 1e-8);
    EXPECT_NEAR(h.last("spring.my"), -3.5, 1e-8);
  }
}

// theta'' = -(k/J) theta without gravity: a period of 2 pi sqrt(J / k).
TEST(TorsionSpring, swings_at_its_frequency) {
  const double period = 2.0 * 3.14159265358979323846 * std::sqrt(0.1 / 40.0);
  const auto h = run_ok(scene_of(R"({"bodies": [{"name": "arm", "mass": 1, "inertia": [0.1, 0.2, 0.3]}],
      "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "arm", "position": [0, 0, 0],
                  "axis": [1, 0, 0]}],
      "torsion_springs": [{"name": "spring", "first": "arm", "second": "ground", "axis": [1, 0, 0], "stiffness": 40}],
      "initial_velocities": [{"of": "arm", "angular_velocity": [0.2, 0, 0]}],
      "sensors": [{"name": "hinge", "kind": "joint_angle", "joint": "hinge"}],
      "analysis": {"kind": "dynamic", "end_time": )" +
                                 text(2.25 * period) + R"(, "step_size": )" + text(period / 400) + "}}"))
                     .history;
  EXPECT_NEAR(h.last("hinge"), 0.2 * std::sqrt(0.1 / 40.0), 1e-4 * 0.2 * std::sqrt(0.1 / 40.0) * 10);
}

// What a scene says wrongly is told by the declaration, all at once.
TEST(Couplings, are_refused_by_what_they_declare) {
  const auto told_of = [](const std::string& contact, const std::string& spring) {
    try {
      static_cast<void>(scene_of(R"({"bodies": [{"name": "ball", "mass": 2, "inertia": [1, 1, 1]}],
        "contacts": [{"name": "floor", "first": "ground", "second": "ball", )" +
                                 contact + R"(}], "torsion_springs": [{"name": "spring", "second": "ball", )" + spring +
                                 R"(}], "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1}})"));
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string keys =
      told_of(R"("normal": [0, 0, 1], "radius": -1, "stifness": 2)", R"("first": "ball", "axis": [1, 0, 0])");
  for (const char* part : {"/contacts/0/radius", "stifness", "\"stiffness\"", "first and second are the same thing"})
    EXPECT_NE(keys.find(part), std::string::npos) << part << " in " << keys;
  const std::string directions =
      told_of(R"("normal": [0, 0, 0], "stiffness": 2)", R"("first": "ground", "axis": [0, 1e-200, 0])");
  for (const char* part : {"/contacts/0/normal", "/torsion_springs/0/axis"})
    EXPECT_NE(directions.find(part), std::string::npos) << part << " in " << directions;
}

}  // namespace
}  // namespace bough::run
