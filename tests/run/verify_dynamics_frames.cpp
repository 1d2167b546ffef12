// Frames of prescribed motion: a scene described in one against the same scene carried by it, steady frames in
// statics, loads, sensors and splits of accelerations in frames, balances.
#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::gallery;
using support::Outcome;

Outcome run_of(const scene::Scene& scene) {
  Outcome r = support::run(scene);
  EXPECT_TRUE(r.ok()) << r.summary.cause;
  return r;
}

/// Largest difference of a column over its largest magnitude, and that of its extrapolations from h and h / 2, both
/// of second order.
struct Agreement {
  double coarse = 0.0, fine = 0.0, extrapolated = 0.0;
};

/// make_scene(overrides): the scene, whose analysis is described in the frame that the overrides name.
template <class MakeScene>
Agreement agreement_of(const MakeScene& make_scene, const std::string& stem, const std::string& column,
                       const std::string& ground, double end, double h) {
  const auto at = [&](const std::string& frame, double step, int stride) {
    return run_of(make_scene(std::vector<std::string>{
                      "/analysis/frame=" + frame, "/analysis/end_time=" + support::text(end),
                      "/analysis/step_size=" + support::text(step), "/analysis/tolerance=1e-12",
                      "/output/stride=" + std::to_string(stride)}))
        .history.of(column);
  };
  const std::vector<double> a1 = at("ground", h, 4), b1 = at(ground, h, 4);
  const std::vector<double> a2 = at("ground", 0.5 * h, 8), b2 = at(ground, 0.5 * h, 8);
  Agreement r;
  double scale = 0.0;
  for (std::size_t i = 0; i < a2.size(); ++i) {
    scale = std::max(scale, std::abs(a2[i]));
    r.coarse = std::max(r.coarse, std::abs(a1[i] - b1[i]));
    r.fine = std::max(r.fine, std::abs(a2[i] - b2[i]));
    r.extrapolated =
        std::max(r.extrapolated, std::abs(support::extrapolate(a1[i], a2[i]) - support::extrapolate(b1[i], b2[i])));
  }
  r.coarse /= scale;
  r.fine /= scale;
  r.extrapolated /= scale;
  std::printf("  %-28s %-16s h %.1e  h/2 %.1e  extrapolated %.1e\n", stem.c_str(), column.c_str(), r.coarse, r.fine,
              r.extrapolated);
  return r;
}

Agreement agreement(const std::string& stem, const std::string& column, const std::string& ground, double end,
                    double h) {
  return agreement_of([&](const std::vector<std::string>& overrides) { return gallery(stem, overrides); }, stem, column,
                      ground, end, h);
}

/// Second order: halving the step takes the difference to a quarter, and extrapolation takes away what is of second
/// order.
void expect_same_motion(const Agreement& a, double size) {
  EXPECT_GT(a.coarse, 0.0) << "two descriptions, two discretizations";
  EXPECT_LT(a.coarse, size);
  EXPECT_GT(a.coarse / a.fine, 3.5);
  EXPECT_LT(a.coarse / a.fine, 4.5);
  EXPECT_LT(a.extrapolated, 0.1 * a.fine);
}

TEST(MovingFrame, carries_a_gyroscope_as_it_is_described_in_it) {
  for (const char* column : {"tilt", "tilt rate", "gimbal.my", "rotor.wz"})
    expect_same_motion(agreement("gyroscope_on_turntable", column, "table", 0.5, 2e-3), 1e-2);
}

TEST(MovingFrame, carries_a_rotor_with_a_flexible_shaft_as_it_is_described_in_it) {
  for (const char* column : {"disc.y", "on the road.x", "disc.z", "speed.vz", "motor.fy"})
    expect_same_motion(agreement("rotor_on_vehicle", column, "vehicle", 0.1, 4e-4), 1e-2);
}

/// Its only ball joint leaves a point mass free to spin, which the frame's rotation must not make felt.
TEST(MovingFrame, carries_a_point_mass_on_a_ball_joint_as_it_is_described_in_it) {
  const auto scene = [](const std::vector<std::string>& overrides) {
    return support::scene_of(R"({
      "gravity": [0, 0, -9.81],
      "frames": [{"name": "table", "position": [0.2, 0, 0], "turns": [{"axis": [0, 0.6, 0.8], "angle": {"expression": "2*t + 0.3*t^2"}}]}],
      "bodies": [{"name": "bob", "mass": 0.4, "kind": "point_mass", "position": [0.5, 0.1, -0.8], "frame": "table"}],
      "joints": [{"name": "ball", "kind": "spherical", "first": "table", "second": "bob", "position": [0.2, 0, 0], "frame": "table"}],
      "initial_velocities": [{"of": "bob", "frame": "table", "velocity": [0, 0.3, 0.0375]}],
      "sensors": [{"name": "bob", "kind": "position", "at": "bob", "frame": "table"}],
      "analysis": {"kind": "dynamic", "frame": "table", "end_time": 1, "step_size": 2e-3, "tolerance": 1e-12}})",
                             overrides);
  };
  for (const char* column : {"bob.x", "bob.y", "bob.z"})
    expect_same_motion(agreement_of(scene, "bob on a table", column, "table", 0.8, 2e-3), 1e-2);
  const Outcome plain = run_of(scene({}));  // with and without a spin about the line from the ball joint to the bob
  const Outcome spun = run_of(scene({"/initial_velocities/0/angular_velocity=[2.7, 0.9, -7.2]"}));
  for (const char* column : {"bob.x", "bob.y", "bob.z"})
    EXPECT_LT(support::largest_difference(spun.history, column, plain.history, column), 1e-10) << column;
}

/// The same scene with and without a frame around it that does not move.
TEST(MovingFrame, of_constant_pose_changes_nothing_but_directions) {
  const auto scene_at = [](const std::string& ground, const std::string& placed) {
    return support::scene_of(R"({
      "gravity": [0, 0, -9.81],
      "frames": [
        {"name": "root"},
        {"name": "still", "frame": "root", "position": [{"expression": "3 + 0*t"}, -2, 1], "rotation": {"axis": [1, 2, 3], "angle": 0.8},
         "turns": [{"axis": [0, 1, 0], "angle": {"expression": "0.4 + 0*t"}}]}],
      "sections": [{"name": "s", "stiffness": [1e4, 1e4, 1e4, 20, 30, 40], "mass": {"mass_per_length": 0.5, "rotary": [2e-3, 1e-3, 1e-3]}}],
      "nodes": [{"name": "root end", "frame": ")" +
                             placed + R"("}, {"name": "tip", "position": [1, 0.2, 0], "frame": ")" + placed + R"("}],
      "beams": [{"name": "b", "section": "s", "start": "root end", "end": "tip", "axis_2": [0, 1, 0], "frame": ")" +
                             placed + R"(", "elements": 3, "order": 2}],
      "joints": [{"name": "hinge", "kind": "revolute", "first": "still", "second": "root end", "position": [0, 0, 0], "axis": [0, 1, 0], "frame": ")" +
                             placed + R"("}],
      "loads": [{"at": "tip", "force": [1, 2, 0], "frame": "still"}],
      "initial_velocities": [{"of": "b", "frame": "still", "angular_velocity": [0, 1, 0]}],
      "sensors": [
        {"name": "tip", "kind": "position", "at": "tip", "frame": "still"},
        {"name": "speed", "kind": "velocity", "at": "tip", "frame": "still"},
        {"name": "pull", "kind": "joint_reaction", "joint": "hinge", "frame": "still"},
        {"name": "force", "kind": "section_force", "beam": "b", "station": 0},
        {"name": "energy", "kind": "kinetic_energy"}],
      "analysis": {"kind": "dynamic", "frame": ")" +
                             ground + R"(", "end_time": 0.5, "step_size": 5e-3, "tolerance": 1e-12}})");
  };
  const Outcome plain = run_of(scene_at("ground", "still"));  // in the inertial frame, everything placed by a frame
  const Outcome inside = run_of(scene_at("still", "ground")), other = run_of(scene_at("root", "still"));
  for (const std::string& c : plain.history.columns) {
    const double scale = std::max({1.0, plain.history.largest(c)});
    EXPECT_LT(support::largest_difference(inside.history, c, plain.history, c), 1e-10 * scale) << c;
    EXPECT_LT(support::largest_difference(other.history, c, plain.history, c), 1e-10 * scale) << c;
  }
}

/// An observer at rest is all that the loop sees of it: the same bits as without one.
TEST(MovingFrame, at_rest_in_the_inertial_frame_gives_the_same_bits) {
  const Outcome plain = run_of(gallery("gyroscope_on_turntable", {"/analysis/frame=ground", "/analysis/end_time=0.1"}));
  scene::Scene scene = gallery("gyroscope_on_turntable", {"/analysis/frame=ground", "/analysis/end_time=0.1"});
  scene.frames.push_back({"root", {}});
  scene.frames[0].placement.frame = "root";
  scene.analysis.frame = "root";
  EXPECT_EQ(plain.history.rows, run_of(scene).history.rows);
}

/// Equal sub-domains run in lockstep, their elements with them; a monolithic solution takes elements one by one.
TEST(MovingFrame, is_the_same_for_elements_in_lockstep) {
  const std::vector<std::string> many = {"/beams/0/elements=64", "/solver/leaf_size=2"};
  std::vector<std::string> alone = many;
  alone.push_back("/solver/form=monolithic");
  const Outcome lockstep = run_of(gallery("rotating_cantilever", many)),
                plain = run_of(gallery("rotating_cantilever", alone));
  for (const std::string& c : plain.history.columns)
    EXPECT_LT(support::largest_difference(lockstep.history, c, plain.history, c),
              1e-9 * std::max(1.0, plain.history.largest(c)))
        << c;
}

TEST(MovingFrame, holds_a_turning_beam_in_its_steady_state) {
  const Outcome r = run_of(gallery("rotating_cantilever"));
  for (const records::ExpectedResult& e : r.summary.expected) {
    EXPECT_TRUE(e.holds) << e.name << " " << e.value << " " << e.reference;
    std::printf("  %s: %.15g, closed form %.15g\n", e.name.c_str(), e.value, e.reference);
  }
  EXPECT_LE(r.summary.steps.newton_iterations, 12) << "two steps by Newton with the exact tangent";
}

/// A bent beam turning steadily, off the axis and under a load: statics in the frame is where a motion in the frame
/// comes to rest.
TEST(MovingFrame, in_statics_is_where_a_damped_motion_comes_to_rest) {
  const auto scene_of = [](const std::string& analysis) {
    return support::scene_of(R"({
      "gravity": [0, 0, -9.81],
      "frames": [{"name": "hub", "turns": [{"axis": [0, 0, 1], "angle": 6, "rate": true}]}],
      "sections": [{"name": "s", "stiffness": [1e4, 1e4, 1e4, 20, 30, 40], "mass": {"mass_per_length": 0.5, "rotary": [2e-3, 1e-3, 1e-3]},
                    "damping": {"time": 0.05}}],
      "nodes": [{"name": "root", "position": [0.2, 0.1, 0]}, {"name": "tip", "position": [1, 0.6, 0.1]}],
      "bodies": [{"name": "bob", "mass": 0.2, "inertia": [1e-3, 1e-3, 1e-3], "position": [1.1, 0.6, 0.1]}],
      "beams": [{"name": "b", "section": "s", "start": "root", "end": "tip", "axis_2": [0, 1, 0], "elements": 2, "order": 2}],
      "joints": [{"name": "clamp", "kind": "fixed", "first": "hub", "second": "root"},
                 {"name": "weld", "kind": "fixed", "first": "tip", "second": "bob"}],
      "sensors": [{"name": "tip", "kind": "position", "at": "tip"}, {"name": "clamp", "kind": "joint_reaction", "joint": "clamp"},
                  {"name": "force", "kind": "section_force", "beam": "b", "station": 0.5}],
      "analysis": )" + analysis +
                             "}");
  };
  const Outcome still = run_of(scene_of(R"({"kind": "static", "frame": "hub", "tolerance": 1e-11})"));
  const Outcome moving = run_of(scene_of(
      R"({"kind": "dynamic", "frame": "hub", "end_time": 20, "step_size": 0.02, "spectral_radius": 0.2, "tolerance": 1e-11})"));
  EXPECT_GT(std::abs(still.history.last("tip.z") - 0.1), 0.01) << "it bends";
  for (const std::string& c : still.history.columns)
    EXPECT_NEAR(still.history.last(c), moving.history.last(c), 1e-6 * std::max(1.0, still.history.largest(c))) << c;
}

/// A frame that speeds up evenly is a frame at rest under gravity the other way; half of the load is half of the
/// acceleration.
TEST(MovingFrame, that_speeds_up_evenly_is_in_statics_as_gravity_is) {
  const auto scene_of = [](const std::string& head, const std::string& frame) {
    return support::scene_of("{" + head + R"(
      "sections": [{"name": "s", "stiffness": [1e4, 1e4, 1e4, 20, 30, 40], "mass": {"mass_per_length": 0.5, "rotary": [2e-3, 1e-3, 1e-3]}}],
      "nodes": [{"name": "a"}, {"name": "b", "position": [0, 0, 1]}],
      "beams": [{"name": "rod", "section": "s", "start": "a", "end": "b", "axis_2": [0, 1, 0], "elements": 2, "order": 2}],
      "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "a"}],
      "sensors": [{"name": "tip", "kind": "position", "at": "b"}, {"name": "pull", "kind": "joint_reaction", "joint": "clamp"}],
      "analysis": {"kind": "static", "load_steps": 2, "tolerance": 1e-12)" +
                             frame + "}}");
  };
  const Outcome weight = run_of(scene_of(R"("gravity": [-6, 0, 2],)", ""));
  const Outcome sled = run_of(scene_of(
      R"("frames": [{"name": "sled", "position": [{"expression": "5*t + 3*t^2"}, 0, {"expression": "0 - t^2"}]}],)",
      R"(, "frame": "sled")"));
  EXPECT_GT(std::abs(weight.history.last("tip.x")), 0.001);
  for (const std::string& c : weight.history.columns)
    EXPECT_LT(support::largest_difference(sled.history, c, weight.history, c), 1e-11) << c;
}

/// A force that turns with a frame is the force that two laws along fixed axes make; so is a line load.
TEST(MovingFrame, turns_the_loads_that_are_given_in_it) {
  const auto scene_of = [](const std::string& loads) {
    return support::scene_of(R"({
      "frames": [{"name": "wheel", "turns": [{"axis": [0, 0, 1], "angle": {"expression": "2*t^2"}}]}],
      "sections": [{"name": "s", "stiffness": [1e4, 1e4, 1e4, 20, 30, 40], "mass": {"mass_per_length": 0.5, "rotary": [2e-3, 1e-3, 1e-3]}}],
      "nodes": [{"name": "a"}, {"name": "b", "position": [0, 0, 1]}],
      "beams": [{"name": "rod", "section": "s", "start": "a", "end": "b", "axis_2": [0, 1, 0], "elements": 2, "order": 2}],
      "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "a"}],
      "loads": [)" + loads + R"(],
      "sensors": [{"name": "tip", "kind": "position", "at": "b"}, {"name": "turn", "kind": "rotation", "at": "b"}],
      "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 5e-3, "tolerance": 1e-12}})");
  };
  const Outcome in_frame = run_of(scene_of(
      R"({"at": "b", "force": [3, 0, 1], "moment": [0, 0.5, 0], "frame": "wheel", "law": {"expression": "1 + t"}},
         {"beam": "rod", "force": [0, 2, 0], "frame": "wheel"})"));
  const Outcome by_laws = run_of(scene_of(
      R"json({"at": "b", "force": [3, 0, 0], "moment": [0, 0.5, 0], "law": {"expression": "(1 + t)*cos(2*t^2)"
}
},
         {"at": "b", "force": [0, 3, 0], "moment": [-0.5, 0, 0], "law": {"expression": "(1 + t)*sin(2*t^2)"}},
         {"at": "b", "force": [0, 0, 1], "law": {"expression": "1 + t"}},
         {"beam": "rod", "force": [0, 2, 0], "law": {"expression": "cos(2*t^2)"}},
         {"beam": "rod", "force": [-2, 0, 0], "law": {"expression": "sin(2*t^2)"}})json"));
  EXPECT_GT(in_frame.history.largest("tip.x"), 0.01);
  for (const std::string& c : in_frame.history.columns)
    EXPECT_LT(support::largest_difference(in_frame.history, c, by_laws.history, c), 1e-10) << c;
}

/// Work of the ground that moves is counted: the balance is one of the inertial frame, in either description.
TEST(MovingFrame, leaves_energy_and_momentum_balanced_in_the_inertial_frame) {
  for (const char* ground : {"vehicle", "ground"}) {
    const auto checks = [&](double h) {
      return run_of(gallery("rotor_on_vehicle", {std::string("/analysis/frame=") + ground, "/analysis/end_time=0.2",
                                                 "/analysis/step_size=" + support::text(h)}))
          .summary.checks;
    };
    const records::Checks coarse = checks(5e-4), fine = checks(2.5e-4);
    std::printf("  ground %-8s energy %.2e of %.2e J, %.2e;  momentum %.2e, %.2e kg m/s\n", ground,
                coarse.energy_balance, coarse.energy_scale, fine.energy_balance, coarse.momentum_balance,
                fine.momentum_balance);
    EXPECT_LT(coarse.energy_balance, 2e-3 * coarse.energy_scale);
    EXPECT_GT(coarse.energy_balance / fine.energy_balance, 3.0);
    EXPECT_LT(coarse.momentum_balance, 0.1) << "of 50 kg m/s and more";
    EXPECT_GT(coarse.momentum_balance / fine.momentum_balance, 3.0);
  }
}

TEST(AccelerationSplit, of_a_precessing_top_adds_up_to_the_integrators_acceleration) {
  const Outcome r = run_of(gallery("heavy_top_precession"));
  for (const records::ExpectedResult& e : r.summary.expected)
    EXPECT_TRUE(e.holds) << e.name << " " << e.value << " " << e.reference;
  scene::Scene scene = gallery("heavy_top_precession");
  for (scene::Sensor& s : scene.sensors)
    if (s.name == "tip") s.frame.clear();
  const Outcome inertial = run_of(scene);
  const char* const axes[3] = {"x", "y", "z"};
  const char* const parts[6] = {"local", "tangential", "coriolis", "centripetal", "razi", "translation"};
  double worst = 0.0, size = 0.0;
  for (const std::vector<double>& row : inertial.history.rows)
    for (const char* axis : axes) {
      const auto value = [&](const std::string& name) { return row[inertial.history.column(name)]; };
      double sum = 0.0;
      for (const char* part : parts) {
        sum += value(std::string("tip.") + part + "_" + axis);
        size = std::max(size, std::abs(value(std::string("tip.") + part + "_" + axis)));
      }
      worst = std::max(worst, std::abs(sum - value(std::string("whole.a") + axis)));
      EXPECT_NEAR(value(std::string("tip.total_") + axis), sum, 1e-12 * size);
    }
  EXPECT_GT(size, 30.0) << "parts that cancel";
  EXPECT_LT(worst, 1e-13 * size);
}

/// In a scene that is described in a moving frame the split is still that of the inertial acceleration, and beams
/// have points, too.
TEST(AccelerationSplit, in_a_moving_frame_is_that_of_the_inertial_acceleration) {
  scene::Scene scene = gallery("rotor_on_vehicle", {"/analysis/end_time=0.05"});
  scene::Sensor split;
  split.name = "beam";
  split.kind = scene::SensorKind::acceleration_split;
  split.beam = "far";
  split.station = 0.3;
  split.chain = {"vehicle", "disc"};
  split.frame = "road";
  scene.sensors.push_back(split);
  scene::Sensor whole = split;
  whole.name = "whole";
  whole.kind = scene::SensorKind::acceleration;
  whole.chain.clear();
  scene.sensors.push_back(whole);
  const Outcome r = run_of(scene);
  for (const char* axis : {"x", "y", "z"}) {
    const double size = r.history.largest(std::string("beam.total_") + axis);
    EXPECT_GT(size, 0.1);
    EXPECT_LT(support::largest_difference(r.history, std::string("beam.total_") + axis, r.history,
                                          std::string("whole.a") + axis),
              1e-11 * (1.0 + size));
  }
}

}  // namespace
}  // namespace bough::run
