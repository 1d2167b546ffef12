// Every kind of joint in motion against a formula of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::Table;

constexpr double pi = 3.14159265358979323846, g = 9.81;

Table history(const scene::Scene& scene) {
  const Outcome outcome = support::run(scene);
  EXPECT_TRUE(outcome.ok()) << outcome.summary.cause;
  return outcome.history;
}

/// A block (mass 2, its centre off the joint) on a joint to the ground along `axis`, with gravity along -z.
scene::Scene block_on(const std::string& kind, const std::string& axis, const std::string& more = "",
                      const std::string& spin = "[0, 0, 0]", const std::string& center = "[0.1, 0.2, 0.05]") {
  return support::scene_of(R"({"gravity": [0, 0, -9.81],
    "bodies": [{"name": "block", "mass": 2, "inertia": [0.3, 0.3, 0.3], "position": [1, 2, 3], "center_of_mass": )" +
                           center + R"(}],
    "joints": [{"name": "joint", "kind": ")" +
                           kind + R"(", "first": "ground", "second": "block", "position": [1, 2, 3], "axis": )" + axis +
                           more + R"(}],
    "initial_velocities": [{"of": "block", "angular_velocity": )" +
                           spin + R"(}],
    "sensors": [{"name": "x", "kind": "position", "at": "block"}, {"name": "v", "kind": "velocity", "at": "block"},
                {"name": "f", "kind": "joint_reaction", "joint": "joint"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01, "tolerance": 1e-11}})");
}

// Motions of constant acceleration are exact for the integrator: x is a parabola in t.

TEST(Joints, prismatic_slides_down_an_incline_and_carries_the_moment) {
  // Axis (3, 0, -4)/5: a = g 4/5 along it; the reaction is m g cos across the incline and holds the offset weight in
  // moment.
  scene::Scene scene = block_on("prismatic", "[3, 0, -4]");
  scene.sensors.push_back(support::joint_sensor("s", scene::SensorKind::joint_displacement, "joint"));
  scene.sensors.push_back(support::joint_sensor("rate", scene::SensorKind::joint_rate, "joint"));
  const Table run = history(scene);
  for (double t : run.times) {
    EXPECT_NEAR(run.at("s", t), 0.5 * 0.8 * g * t * t, 1e-11);
    EXPECT_NEAR(run.at("rate", t), 0.8 * g * t, 1e-10);
  }
  EXPECT_NEAR(run.last("x.x"), 1.0 + 0.6 * 0.4 * g, 1e-10);
  EXPECT_NEAR(run.last("x.z"), 3.0 - 0.8 * 0.4 * g, 1e-10);
  // Force of the ground on the block: - m g + m a = (m a 3/5, 0, m g - m a 4/5); moment about the joint: c x force.
  const double fx = 2.0 * 0.8 * g * 0.6, fz = 2.0 * g - 2.0 * 0.8 * g * 0.8;
  EXPECT_NEAR(run.last("f.fx"), fx, 1e-8);
  EXPECT_NEAR(run.last("f.fz"), fz, 1e-8);
  EXPECT_NEAR(run.last("f.mx"), 0.2 * fz, 1e-8);
  EXPECT_NEAR(run.last("f.my"), 0.05 * fx - 0.1 * fz, 1e-8);
  EXPECT_NEAR(run.last("f.mz"), -0.2 * fx, 1e-8);
}

TEST(Joints, cylindrical_slides_and_spins_independently) {
  scene::Scene scene = block_on("cylindrical", "[3, 0, -4]", "", "[6, 0, -8]", "[0, 0, 0]");  // 10 rad/s about the axis
  scene.sensors.push_back(support::joint_sensor("s", scene::SensorKind::joint_displacement, "joint"));
  scene.sensors.push_back(support::joint_sensor("angle", scene::SensorKind::joint_angle, "joint"));
  const Table run = history(scene);
  for (double t : run.times) {
    EXPECT_NEAR(run.at("s", t), 0.5 * 0.8 * g * t * t, 1e-10);
    EXPECT_NEAR(run.at("angle", t), 10.0 * t, 1e-10);
  }
}

TEST(Joints, screw_falls_slower_by_the_inertia_it_turns) {
  // z'' = -g m / (m + J / p^2) with p metres a radian; z = p theta.
  scene::Scene scene = block_on("screw", "[0, 0, 1]", R"(, "pitch": 0.5)", "[0, 0, 0]", "[0, 0, 0]");
  scene.sensors.push_back(support::joint_sensor("s", scene::SensorKind::joint_displacement, "joint"));
  scene.sensors.push_back(support::joint_sensor("angle", scene::SensorKind::joint_angle, "joint"));
  scene.analysis.end_time = 4.0;
  const Table run = history(scene);
  const double p = 0.5 / (2.0 * pi), a = -g * 2.0 / (2.0 + 0.3 / (p * p));
  for (double t : run.times) {
    EXPECT_NEAR(run.at("s", t), 0.5 * a * t * t, 1e-9);
    EXPECT_NEAR(run.at("angle", t), 0.5 * a * t * t / p, 1e-8);
  }
  EXPECT_GT(std::abs(run.last("angle")), 2.0 * pi) << "more than a turn";
}

TEST(Joints, planar_is_a_frictionless_table_on_a_slope) {
  // Gravity within the plane: g - n (n . g), n = (0, 3, 4)/5. It slides and spins: of second order, as turning axes
  // carry the velocity.
  const double ay = g * 0.8 * 0.6, az = -g + g * 0.8 * 0.8;
  Table runs[2];
  double error[2] = {0.0, 0.0}, extrapolated = 0.0;
  for (int k = 0; k < 2; ++k) {
    scene::Scene scene = block_on("planar", "[0, 3, 4]", "", "[0, 6, 8]", "[0, 0, 0]");
    scene.initial_velocities.front().velocity = {{2, 4, -3}};  // within the plane
    scene.sensors.push_back(support::joint_sensor("angle", scene::SensorKind::joint_angle, "joint"));
    scene.analysis.step_size = k == 0 ? 2e-3 : 1e-3;
    runs[k] = history(scene);
  }
  for (double t : runs[0].times) {
    const double exact[3] = {1.0 + 2.0 * t, 2.0 + 4.0 * t + 0.5 * ay * t * t, 3.0 - 3.0 * t + 0.5 * az * t * t};
    for (int i = 0; i < 3; ++i) {
      const std::string column = std::string("x.") + "xyz"[i];
      const double coarse = runs[0].at(column, t), fine = runs[1].at(column, t);
      error[0] = std::max(error[0], std::abs(coarse - exact[i]));
      error[1] = std::max(error[1], std::abs(fine - exact[i]));
      extrapolated = std::max(extrapolated, std::abs(support::extrapolate(coarse, fine) - exact[i]));
    }
    EXPECT_NEAR(runs[1].at("angle", t), 10.0 * t, 1e-10);
  }
  std::printf("planar joint: errors %.1e %.1e m (order %.2f), extrapolated %.1e m\n", error[0], error[1],
              support::order_of(error[0], error[1]), extrapolated);
  EXPECT_NEAR(support::order_of(error[0], error[1]), 2.0, 0.2);
  EXPECT_LT(extrapolated, 1e-6 * 6.0);
  EXPECT_NEAR(runs[1].last("f.fy"), 2.0 * g * 0.8 * 0.6, 1e-3);
  EXPECT_NEAR(runs[1].last("f.fz"), 2.0 * g * 0.8 * 0.8, 1e-3);
}

/// A point mass on a ball joint has a spin about the line to it that nothing feels; it is kept at zero and changes
/// nothing.
void expect_conical_pendulum(const std::string& joint) {
  // L = 1, half angle acos(0.8): the speed of the cone is omega = sqrt(g / (L cos)).
  const double omega = std::sqrt(g / 0.8);
  double error[2];
  for (int k = 0; k < 2; ++k) {
    scene::Scene scene = support::scene_of(R"({"gravity": [0, 0, -9.81],
      "bodies": [{"name": "bob", "kind": "point_mass", "mass": 3, "position": [0.6, 0, -0.8]}],
      "joints": [{"name": "ball", "first": "ground", "second": "bob", )" +
                                           joint + R"(}],
      "sensors": [{"name": "x", "kind": "position", "at": "bob"}, {"name": "f", "kind": "joint_reaction", "joint": "ball"}],
      "analysis": {"kind": "dynamic", "end_time": 3, "tolerance": 1e-11}})");
    scene::InitialVelocity v;
    v.of = "bob";
    v.velocity = {{0, 0.6 * omega, 0}};
    scene.initial_velocities.push_back(v);
    scene.analysis.step_size = k == 0 ? 2e-3 : 1e-3;
    const Table run = history(scene);
    error[k] = 0.0;
    for (double t : run.times) {
      error[k] = std::max(error[k], std::abs(run.at("x.x", t) - 0.6 * std::cos(omega * t)));
      error[k] = std::max(error[k], std::abs(run.at("x.y", t) - 0.6 * std::sin(omega * t)));
      EXPECT_NEAR(run.at("x.z", t), -0.8, 1e-4);
      EXPECT_NEAR(run.at("f.fz", t), 3.0 * g, 1e-2);
    }
  }
  std::printf("conical pendulum: errors %.1e %.1e (order %.2f)\n", error[0], error[1],
              support::order_of(error[0], error[1]));
  EXPECT_NEAR(support::order_of(error[0], error[1]), 2.0, 0.2);
  EXPECT_LT(error[1], 1e-4);
}

TEST(Joints, a_conical_pendulum_on_a_universal_joint_keeps_its_height) {
  expect_conical_pendulum(R"("kind": "universal", "position": [0, 0, 0], "axis": [1, 0, 0], "second_axis": [0, 1, 0])");
}

TEST(Joints, a_point_mass_on_a_ball_joint_at_a_distance_runs_as_on_a_universal_joint) {
  expect_conical_pendulum(R"("kind": "spherical", "position": [0, 0, 0])");
}

TEST(Joints, a_point_mass_on_a_rod_runs_as_on_a_universal_joint) { expect_conical_pendulum(R"("kind": "distance")"); }

TEST(Joints, a_rod_that_shortens_lifts_its_load) {
  // The rod of length L = 2 - 0.3 t^2 hangs from (0.2, 0, 1): z = 1 - L, tension m (g + 0.6), work m (g (2 - L) +
  // v^2/2).
  for (const char* without : {"[]", R"(["line", "translation"])"}) {
    const Outcome outcome = support::run(support::scene_of(R"({"gravity": [0, 0, -9.81],
      "bodies": [{"name": "load", "kind": "point_mass", "mass": 3, "position": [0.2, 0, -1]}],
      "joints": [{"name": "rod", "kind": "distance", "first": {"to": "ground", "position": [0.2, 0, 1]}, "second": "load",
                  "drives": [{"law": {"expression": "2 - 0.3*t^2"}}]}],
      "sensors": [{"name": "x", "kind": "position", "at": "load"}, {"name": "f", "kind": "joint_reaction", "joint": "rod"},
                  {"name": "length", "kind": "joint_displacement", "joint": "rod"},
                  {"name": "rate", "kind": "joint_rate", "joint": "rod"}, {"name": "energy", "kind": "total_energy"}],
      "analysis": {"kind": "dynamic", "end_time": 2, "step_size": 0.01, "tolerance": 1e-12}, "without": )" +
                                                           std::string(without) + "}"));
    ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
    const Table& run = outcome.history;
    for (double t : run.times) {
      EXPECT_NEAR(run.at("x.z", t), -1.0 + 0.3 * t * t, 1e-10);
      EXPECT_NEAR(run.at("x.x", t), 0.2, 1e-10);
      EXPECT_NEAR(run.at("length", t), 2.0 - 0.3 * t * t, 1e-10);
      EXPECT_NEAR(run.at("rate", t), -0.6 * t, 1e-8);
      EXPECT_NEAR(run.at("f.fz", t), 3.0 * (g + 0.6), 1e-7);
    }
    EXPECT_NEAR(run.last("energy") - run.at("energy", 0.0), 3.0 * (g * 1.2 + 0.5 * 1.2 * 1.2), 1e-7);
    EXPECT_LT(outcome.summary.checks.energy_balance, 1e-6);
  }
}

TEST(Joints, two_bodies_on_a_rod_whirl_about_their_centre) {
  // The rod of 1.4 m takes hold beside the centres of both bodies and turns at 2 rad/s about an axis normal to it,
  // without gravity. Bodies of 1 and 2 kg are 1 and 0.5 m from the common centre of mass, which moves on at constant
  // speed; both turn with the rod, so its force is m r w^2 = 4 N. A uniform screw motion is exact for the integrator.
  const Outcome outcome = support::run(support::scene_of(R"({
    "bodies": [{"name": "a", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0.6, 0.8, 0]},
               {"name": "b", "mass": 2, "inertia": [0.3, 0.2, 0.4], "position": [-0.3, -0.4, 0]}],
    "joints": [{"name": "rod", "kind": "distance", "first": {"to": "a", "position": [-0.06, -0.08, 0]},
                "second": {"to": "b", "position": [0, 0, 0]}}],
    "initial_velocities": [{"of": "a", "velocity": [-1.6, 1.2, 0.5], "angular_velocity": [0, 0, 2]},
                           {"of": "b", "velocity": [0.8, -0.6, 0.5], "angular_velocity": [0, 0, 2]}],
    "sensors": [{"name": "a", "kind": "position", "at": "a"}, {"name": "b", "kind": "position", "at": "b"},
                {"name": "f", "kind": "joint_reaction", "joint": "rod"},
                {"name": "length", "kind": "joint_displacement", "joint": "rod"}],
    "analysis": {"kind": "dynamic", "end_time": 3, "step_size": 4e-3, "tolerance": 1e-11}})"));
  ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
  const Table& run = outcome.history;
  for (double t : run.times) {
    const double c = std::cos(2.0 * t), s = std::sin(2.0 * t), x = 0.6 * c - 0.8 * s, y = 0.6 * s + 0.8 * c;
    EXPECT_NEAR(run.at("a.x", t), x, 1e-10);
    EXPECT_NEAR(run.at("a.y", t), y, 1e-10);
    EXPECT_NEAR(run.at("b.x", t), -0.5 * x, 1e-10);
    EXPECT_NEAR(run.at("b.y", t), -0.5 * y, 1e-10);
    EXPECT_NEAR(run.at("a.z", t), 0.5 * t, 1e-10);
    EXPECT_NEAR(run.at("b.z", t), 0.5 * t, 1e-10);
    EXPECT_NEAR(run.at("length", t), 1.4, 1e-12);
    EXPECT_NEAR(run.at("f.fx", t), 4.0 * x, 1e-7);
    EXPECT_NEAR(run.at("f.fy", t), 4.0 * y, 1e-7);
  }
  EXPECT_LT(outcome.summary.checks.energy_balance, 1e-9);
}

TEST(Joints, two_universal_joints_transmit_a_constant_speed_one_alone_does_not) {
  // Shafts along x, at 0.4 rad in the x-y plane, along x again; the middle shaft's two yokes lie in one plane. The
  // first joint's axis on the driving shaft is z (out of the shafts' plane), so tan(middle) = tan(driving) /
  // cos(beta) counted from there.
  const double beta = 0.4, c = std::cos(beta), s = std::sin(beta);
  scene::Scene scene =
      support::scene_of(R"({
    "bodies": [{"name": "driving", "mass": 1, "inertia": [0.1, 0.2, 0.2], "position": [-1, 0, 0]},
               {"name": "middle", "mass": 1, "inertia": [0.1, 0.2, 0.2], "position": [0, 0, 0], "rotation": {"axis": [0, 0, 1], "angle": 0.4}},
               {"name": "driven", "mass": 1, "inertia": [0.1, 0.2, 0.2], "position": [)" +
                        support::text(c) + ", " + support::text(s) + R"(, 0]}],
    "joints": [
      {"name": "in", "kind": "revolute", "first": "ground", "second": "driving", "position": [-1, 0, 0], "axis": [1, 0, 0],
       "drives": [{"law": {"expression": "4*t + t^2"}}]},
      {"name": "first", "kind": "universal", "first": "driving", "second": "middle", "position": [0, 0, 0], "axis": [0, 0, 1],
       "second_axis": [)" +
                        support::text(-s) + ", " + support::text(c) + R"(, 0]},
      {"name": "second", "kind": "universal", "first": "middle", "second": "driven", "position": [)" +
                        support::text(c) + ", " + support::text(s) + R"(, 0], "axis": [)" + support::text(-s) + ", " +
                        support::text(c) + R"(, 0], "second_axis": [0, 0, 1]},
      {"name": "out", "kind": "cylindrical", "first": "ground", "second": "driven", "position": [)" +
                        support::text(c) + ", " + support::text(s) +
                        R"(, 0], "axis": [1, 0, 0]}],
    "sensors": [{"name": "in", "kind": "joint_angle", "joint": "in"}, {"name": "out", "kind": "joint_angle", "joint": "out"},
                {"name": "middle", "kind": "velocity", "at": "middle", "axes": "body"}],
    "analysis": {"kind": "dynamic", "end_time": 3, "step_size": 5e-3, "tolerance": 1e-11}})");
  const Table run = history(scene);
  double ripple = 0.0;
  for (double t : run.times) {
    EXPECT_NEAR(run.at("out", t), run.at("in", t), 1e-9);
    const double angle = 4.0 * t + t * t, rate = 4.0 + 2.0 * t;
    // Of the middle shaft: cos(beta) where the driving fork's axis is normal to the shafts' plane, as at the start, 1
    // / cos(beta) a quarter turn on.
    const double exact = rate * c / (1.0 - s * s * std::pow(std::sin(angle), 2));
    ripple = std::max(ripple, std::abs(run.at("middle.wx", t) - exact));
  }
  std::printf("universal joints: largest error of the middle shaft's rate %.1e rad/s\n", ripple);
  EXPECT_LT(ripple, 1e-3);
  EXPECT_NEAR(run.last("in"), 21.0, 1e-12);
}

TEST(Joints, a_point_is_seen_in_the_axes_of_another_part) {
  // Two arms turn about z by angles a and b; the origin of the first is half a metre from the axis. A point at 2 of the
  // second is at 2 (cos(b - a), sin(b - a)) - (0.5, 0) in the axes of the first.
  scene::Scene scene = support::scene_of(R"({
    "bodies": [{"name": "first", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0.5, 0, 0]},
               {"name": "second", "mass": 1, "inertia": [0.1, 0.1, 0.1]}],
    "joints": [
      {"name": "a", "kind": "revolute", "first": "ground", "second": "first", "position": [0, 0, 0], "axis": [0, 0, 1],
       "drives": [{"law": {"expression": "3*t"}}]},
      {"name": "b", "kind": "revolute", "first": "ground", "second": "second", "position": [0, 0, 0], "axis": [0, 0, 1],
       "drives": [{"law": {"expression": "t^2"}}]}],
    "sensors": [{"name": "seen", "kind": "relative_position", "at": {"to": "second", "position": [2, 0, 0]}, "frame": "first"},
                {"name": "still", "kind": "relative_position", "at": {"to": "ground", "position": [2, 0, 0]}, "frame": "first"}],
    "analysis": {"kind": "dynamic", "end_time": 2, "step_size": 0.01, "tolerance": 1e-12}})");
  const Table run = history(scene);
  for (double t : run.times) {
    const double turn = t * t - 3.0 * t;
    EXPECT_NEAR(run.at("seen.x", t), 2.0 * std::cos(turn) - 0.5, 1e-11);
    EXPECT_NEAR(run.at("seen.y", t), 2.0 * std::sin(turn), 1e-11);
    EXPECT_NEAR(run.at("still.x", t), 2.0 * std::cos(3.0 * t) - 0.5, 1e-11);
    EXPECT_NEAR(run.at("still.y", t), -2.0 * std::sin(3.0 * t), 1e-11);
    EXPECT_NEAR(run.at("seen.z", t), 0.0, 1e-14);
  }
}

TEST(Joints, a_constant_velocity_joint_transmits_speed_and_torque_at_an_angle) {
  // Shafts along x and at 0.6 rad in the x-y plane; the second is held in the ground's y and z at a point of its axis,
  // and loaded by a torque about it. Both turn at one rate, so the torques of both shafts are equal but for inertia.
  // The joint's moment is normal to every axis that it bends about, which lies in the plane of symmetry of the shafts:
  // it is along the bisector, and m = torque / cos(0.3).
  const double beta = 0.6, c = std::cos(beta), s = std::sin(beta), torque = -2.5, J = 0.1;
  const std::string shaft = R"({"axis": [0, 1, 0], "angle": 1.5707963267948966})";  // axis 3 of the joint's frames
  scene::Scene scene = support::scene_of(R"({
    "bodies": [{"name": "driving", "mass": 1, "inertia": [0.1, 0.2, 0.2]},
               {"name": "driven", "mass": 1, "inertia": [0.1, 0.2, 0.2], "rotation": {"axis": [0, 0, 1], "angle": 0.6}}],
    "joints": [
      {"name": "in", "kind": "revolute", "first": "ground", "second": "driving", "position": [0, 0, 0], "axis": [1, 0, 0],
       "drives": [{"law": {"expression": "4*t + t^2"}}]},
      {"name": "bend", "kind": "constant_velocity",
       "first": {"to": "driving", "rotation": )" +
                                         shaft + R"(}, "second": {"to": "driven", "rotation": )" + shaft + R"(}}],
    "motions": [{"at": {"to": "driven", "position": [1, 0, 0]}, "y": 0, "z": 0}],
    "loads": [{"at": "driven", "axes": "body", "moment": [-2.5, 0, 0], "law": 1}],
    "sensors": [{"name": "in", "kind": "joint_angle", "joint": "in"}, {"name": "bend", "kind": "joint_reaction", "joint": "bend"},
                {"name": "out", "kind": "velocity", "at": "driven"}],
    "analysis": {"kind": "dynamic", "end_time": 3, "step_size": 5e-3, "tolerance": 1e-11}})");
  const Outcome outcome = support::run(scene);
  ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
  const Table& run = outcome.history;
  double rate_error = 0.0, moment_error = 0.0;
  for (double t : run.times) {
    const double rate = 4.0 + 2.0 * t;
    rate_error = std::max({rate_error, std::abs(run.at("out.wx", t) - rate * c),
                           std::abs(run.at("out.wy", t) - rate * s), std::abs(run.at("out.wz", t))});
    if (t == 0.0) continue;  // accelerations of the start are those of the step before it
    const double transmitted = J * 2.0 - torque, m = transmitted / std::cos(0.5 * beta);
    moment_error =
        std::max({moment_error, std::abs(run.at("bend.mx", t) - m * std::cos(0.5 * beta)),
                  std::abs(run.at("bend.my", t) - m * std::sin(0.5 * beta)), std::abs(run.at("bend.mz", t))});
  }
  std::printf("constant velocity: errors of the driven shaft's rate %.1e rad/s, of the moment %.1e N m\n", rate_error,
              moment_error);
  EXPECT_LT(rate_error, 1e-8);
  EXPECT_LT(moment_error, 1e-6);
  EXPECT_NEAR(run.last("in"), 21.0, 1e-12);
  EXPECT_LT(outcome.summary.checks.energy_balance, 1e-6);
}

TEST(Joints, fixed_makes_one_body_of_two) {
  // The composite of two boxes, given as one body, tumbles the same.
  const double ma = 2, mb = 1;
  const double offset[3] = {0.5, 0.2, -0.3};
  double J[3][3] = {{0.3, 0, 0}, {0, 0.5, 0}, {0, 0, 0.4}};
  const double Jb[3] = {0.05, 0.1, 0.12}, mu = ma * mb / (ma + mb);
  const double square = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
  std::string inertia = "[";
  for (int i = 0; i < 3; ++i) {
    inertia += i == 0 ? "[" : ", [";
    for (int k = 0; k < 3; ++k) {
      J[i][k] += (i == k ? Jb[i] + mu * square : 0.0) - mu * offset[i] * offset[k];
      inertia += (k == 0 ? "" : ", ") + support::text(J[i][k]);
    }
    inertia += "]";
  }
  inertia += "]";
  const std::string rest =
      R"("sensors": [{"name": "v", "kind": "velocity", "at": "a", "axes": "body"}, {"name": "x", "kind": "position", "at": "a"}],
    "initial_velocities": [{"of": "a", "velocity": [1, 2, 3], "angular_velocity": [2, 1, 3]}],
    "analysis": {"kind": "dynamic", "end_time": 2, "step_size": 1e-3, "tolerance": 1e-11}})";
  const std::string center = "[" + support::text(offset[0] / 3) + ", " + support::text(offset[1] / 3) + ", " +
                             support::text(offset[2] / 3) + "]";
  const Table one = history(support::scene_of(R"({"bodies": [{"name": "a", "mass": 3, "inertia": )" + inertia +
                                              R"(, "center_of_mass": )" + center + "}], " + rest));
  scene::Scene both = support::scene_of(R"({"bodies": [{"name": "a", "mass": 2, "inertia": [0.3, 0.5, 0.4]},
      {"name": "b", "mass": 1, "inertia": [0.05, 0.1, 0.12], "position": [0.5, 0.2, -0.3]}],
    "joints": [{"name": "weld", "kind": "fixed", "first": "a", "second": "b", "position": [0.2, 0.1, 0]}], )" +
                                        rest);
  scene::InitialVelocity v;
  v.of = "b";
  v.velocity = {{1 + 1 * -0.3 - 3 * 0.2, 2 + 3 * 0.5 - 2 * -0.3, 3 + 2 * 0.2 - 1 * 0.5}};  // v + w x r
  v.angular_velocity = {{2, 1, 3}};
  both.initial_velocities.push_back(v);
  const auto largest_difference = [&one](const Table& two) {
    double most = 0.0;
    for (std::size_t r = 0; r < one.rows.size(); ++r)
      for (std::size_t k = 0; k < one.columns.size(); ++k)
        most = std::max(most, std::abs(one.rows[r][k] - two.rows[r][k]));
    return most;
  };
  const double welded = largest_difference(history(both));
  both.without = {"welded"};  // a joint, whose rows are constraints
  const double joined = largest_difference(history(both));
  std::printf("fixed joint: difference to the composite body, as one node %.1e, as a joint %.1e\n", welded, joined);
  EXPECT_LT(welded, 1e-12);
  EXPECT_LT(joined, 1e-9) << "round-off and the tolerance of Newton's method";
}

TEST(Joints, a_driven_joint_counts_turns) {
  // 80 turns one way, steps of half a radian.
  scene::Scene scene = block_on("revolute", "[1, 2, 2]", R"(, "drives": [{"law": -50, "rate": true}])");
  scene.sensors.push_back(support::joint_sensor("angle", scene::SensorKind::joint_angle, "joint"));
  scene.analysis.end_time = 10.0;
  const Table run = history(scene);
  for (double t : run.times) EXPECT_NEAR(run.at("angle", t), -50.0 * t, 1e-9);
}

TEST(Joints, a_torsion_spring_remembers_its_turns) {
  // Spring 2 N m/rad, J = 0.5 kg m^2 about the axis: omega = 2 rad/s; from 50 rad/s the amplitude is 25 rad, four
  // turns.
  double error[2], fine = 0.0;
  double angle[2];
  for (int k = 0; k < 2; ++k) {
    scene::Scene scene = support::scene_of(R"({
      "bodies": [{"name": "wheel", "mass": 1, "inertia": [0.3, 0.3, 0.5]}],
      "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "wheel", "position": [0, 0, 0], "axis": [0, 0, 1],
                  "forces": [{"stiffness": 2}]}],
      "initial_velocities": [{"of": "wheel", "angular_velocity": [0, 0, 50]}],
      "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"}, {"name": "energy", "kind": "total_energy"}],
      "analysis": {"kind": "dynamic", "end_time": 4, "tolerance": 1e-11}})");
    scene.analysis.step_size = k == 0 ? 4e-3 : 2e-3;
    const Table run = history(scene);
    error[k] = 0.0;
    for (double t : run.times) error[k] = std::max(error[k], std::abs(run.at("angle", t) - 25.0 * std::sin(2.0 * t)));
    angle[k] = run.last("angle");
    EXPECT_GT(run.largest("angle"), 24.9);
  }
  fine = support::extrapolate(angle[0], angle[1]);
  EXPECT_NEAR(support::order_of(error[0], error[1]), 2.0, 0.2);
  EXPECT_NEAR(fine, 25.0 * std::sin(8.0), 1e-6 * 25.0);
}

}  // namespace
}  // namespace bough::run
