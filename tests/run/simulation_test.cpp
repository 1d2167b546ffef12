// A simulation that is driven step by step, saved and taken back.
#include "bough/run/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "../support/scenes.hpp"
#include "bough/run/memory_run.hpp"

namespace bough::run {
namespace {

using support::gallery;

struct Rows final : records::Recorder {
  std::vector<records::HistoryRow> rows;
  int begun = 0, ended = 0;
  void begin(const records::HistoryHeader&) override { ++begun; }
  void row(const records::HistoryRow& r) override { rows.push_back(r); }
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override { ++ended; }
};

/// Scenes of every analysis and every integrator.
struct Case {
  const char* name;
  scene::Scene scene;
  double
      tolerance;  ///< of what comes of going back, relative to the largest value: the tolerance of Newton's iteration
};
std::vector<Case> all_analyses() {
  std::vector<Case> cases;
  cases.push_back({"load steps", gallery("bend_45"), 1e-9});
  cases.push_back({"path", gallery("deep_arch"), 1e-6});
  const std::vector<std::string> to_half_a_second{"/analysis/end_time=0.5"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), to_half_a_second.begin(), to_half_a_second.end());
    return more;
  };
  cases.push_back({"generalized-alpha", gallery("slider_crank", to_half_a_second), 1e-6});
  cases.push_back(
      {"controlled steps", gallery("slider_crank", with({"/analysis/step_control={\"tolerance\": 1e-4}"})), 1e-6});
  cases.push_back({"backward differences", gallery("slider_crank", with({"/analysis/integrator=bdf"})), 1e-6});
  cases.push_back({"variational", gallery("double_pendulum", with({"/analysis/integrator=variational"})), 1e-6});
  return cases;
}

TEST(Simulation, driven_step_by_step_gives_the_rows_of_simulate) {
  for (const Case& c : all_analyses()) {
    SCOPED_TRACE(c.name);
    Rows whole, driven;
    const records::Summary expected = simulate(c.scene, {}, whole);
    ASSERT_EQ(expected.status, records::RunStatus::ok) << expected.cause;
    Simulation simulation(c.scene, {}, &driven);
    ASSERT_TRUE(simulation.start());
    long steps = 0;
    while (simulation.take_step()) ++steps;
    EXPECT_TRUE(simulation.has_ended());
    EXPECT_FALSE(simulation.take_step());
    const records::Summary& summary = simulation.finish();
    EXPECT_EQ(summary.status, records::RunStatus::ok);
    EXPECT_EQ(driven.begun, 1);
    EXPECT_EQ(driven.ended, 1);
    ASSERT_EQ(driven.rows.size(), whole.rows.size());
    EXPECT_GT(steps, 3);
    for (std::size_t k = 0; k < whole.rows.size(); ++k) {
      EXPECT_EQ(driven.rows[k].time, whole.rows[k].time);
      EXPECT_EQ(driven.rows[k].values, whole.rows[k].values);
    }
    EXPECT_EQ(summary.notes, expected.notes);
    EXPECT_EQ(summary.doubts.size(), expected.doubts.size());
  }
}

TEST(Simulation, sensors_are_read_where_it_stands) {
  const scene::Scene scene = gallery("slider_crank", {"/analysis/end_time=0.5"});
  Rows rows;
  Simulation simulation(scene, {}, &rows);
  ASSERT_TRUE(simulation.advance_to(0.25));
  EXPECT_NEAR(simulation.time(), 0.25, scene.analysis.step_size);
  EXPECT_GE(simulation.time(), 0.25 - 1e-12);
  EXPECT_EQ(simulation.values(), rows.rows.back().values);
  const std::string first = simulation.header().columns.front();
  EXPECT_EQ(simulation.value(first), rows.rows.back().values.front());
  EXPECT_THROW((void)simulation.value("nothing of this name"), std::out_of_range);
  std::string near = first;
  near.back() = '_';
  try {
    (void)simulation.value(near);
  } catch (const std::out_of_range& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean '" + first), std::string::npos) << error.what();
  }
  EXPECT_FALSE(simulation.advance_to(10.0)) << "the scene ends before";
  EXPECT_TRUE(simulation.has_ended());
}

TEST(Simulation, sensors_are_read_at_the_consistent_start) {
  const scene::Scene scene = gallery("slider_crank");
  Rows rows;
  Simulation simulation(scene, {}, &rows);
  const std::vector<double> first = simulation.values();
  ASSERT_EQ(rows.rows.size(), 1u) << "reading comes to the start by itself";
  EXPECT_EQ(first, rows.rows.front().values);
}

TEST(Simulation, left_before_its_end_it_says_so) {
  const scene::Scene scene = gallery("slider_crank");
  Rows rows;
  Simulation simulation(scene, {}, &rows);
  ASSERT_TRUE(simulation.take_step());
  const records::Summary& summary = simulation.finish();
  EXPECT_EQ(summary.status, records::RunStatus::interrupted);
  EXPECT_NE(summary.cause.find("stopped at time"), std::string::npos) << summary.cause;
  EXPECT_EQ(rows.ended, 1);
  EXPECT_FALSE(simulation.take_step());
}

// A rotor, J = 0.5 kg m^2, under a torque that is an input: angle and rate are those of constant accelerations, which
// generalized-alpha integrates exactly. Set before the start, at it, within steps of equal and of controlled size.
TEST(Simulation, inputs_hold_from_when_they_are_set) {
  const std::string json = R"-({
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.02, "tolerance": 1e-11},
  "bodies": [{"name": "rotor", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "rotor", "axis": [0, 0, 1],
              "forces": [{"effort": {"signal": "torque"}}]}],
  "signals": [{"name": "torque", "kind": "input", "start": 3}],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"},
              {"name": "rate", "kind": "joint_rate", "joint": "axle"},
              {"name": "torque", "kind": "signal", "signal": "torque"}]})-";
  const std::vector<std::string> cases[] = {
      {}, {"/without=[\"planar\"]"}, {"/analysis/integrator=bdf"}, {"/analysis/step_control={\"tolerance\": 1e-4}"}};
  for (const std::vector<std::string>& overrides : cases) {
    const scene::Scene scene = support::scene_of(json, overrides);
    Simulation simulation(scene);
    EXPECT_EQ(simulation.set_input("torque", 1.0), "");
    ASSERT_TRUE(simulation.start());
    EXPECT_EQ(simulation.value("torque"), 1.0);
    EXPECT_EQ(simulation.set_input("torque", 2.0), "");
    EXPECT_EQ(simulation.value("torque"), 2.0);
    double angle = 0.0, rate = 0.0, since = 0.0, torque = 2.0;
    for (const double next : {-5.0, -5.0, 0.0, 7.0}) {
      ASSERT_TRUE(simulation.advance_to(since + 0.05));
      const double t = simulation.time() - since;
      angle += t * (rate + t * torque);  // accelerations torque / J
      rate += 2.0 * torque * t;
      EXPECT_NEAR(simulation.value("angle"), angle, 1e-9);
      EXPECT_NEAR(simulation.value("rate"), rate, 1e-8);
      since = simulation.time();
      torque = next;
      EXPECT_EQ(simulation.set_input("torque", next), "");
    }
    const auto moment = simulation.save();
    ASSERT_TRUE(simulation.run());
    const double t = 1.0 - since;
    EXPECT_NEAR(simulation.value("angle"), angle + t * (rate + t * torque), 1e-8);
    const records::Summary& summary = simulation.finish();
    EXPECT_LT(summary.checks.energy_balance, 1e-6 * summary.checks.energy_scale) << "a jump of an input does no work";
    EXPECT_NE(simulation.set_input("torque", 0.0), "") << "it has ended";
    simulation.restore(*moment);
    EXPECT_EQ(simulation.value("torque"), 7.0);
    ASSERT_TRUE(simulation.run());
    EXPECT_NEAR(simulation.value("angle"), angle + t * (rate + t * torque), 1e-8);
  }
}

TEST(Simulation, inputs_that_are_none_are_refused_and_unset_ones_keep_their_start) {
  const scene::Scene scene = support::scene_of(R"-({
  "analysis": {"kind": "static"},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "position": [0, 0, 0],
              "axis": [1, 0, 0], "forces": [{"effort": {"signal": "push"}, "stiffness": 40}]}],
  "signals": [{"name": "push", "kind": "input", "start": 8}, {"name": "other", "kind": "time", "law": 1}],
  "sensors": [{"name": "x", "kind": "joint_displacement", "joint": "rail"}]})-");
  Simulation simulation(scene);
  EXPECT_NE(simulation.set_input("other", 1.0).find("no signal of kind \"input\""), std::string::npos);
  EXPECT_NE(simulation.set_input("push", std::nan("")).find("finite"), std::string::npos);
  ASSERT_TRUE(simulation.run());
  EXPECT_NEAR(simulation.value("x"), 0.2, 1e-12);
}

TEST(Simulation, taken_back_it_goes_on_as_before) {
  for (const Case& c : all_analyses()) {
    SCOPED_TRACE(c.name);
    Rows rows;
    Simulation simulation(c.scene, {}, &rows);
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(simulation.take_step());
    const double time = simulation.time();
    const std::vector<double> there = simulation.values();
    const auto moment = simulation.save();
    ASSERT_TRUE(simulation.run());
    const double end = simulation.time();
    const std::vector<double> expected = simulation.values();
    const long steps = simulation.finish().steps.accepted;
    double size = 0.0;
    for (const double v : expected) size = std::max(size, std::abs(v));
    for (int again = 0; again < 2; ++again) {
      simulation.restore(*moment);
      EXPECT_EQ(simulation.time(), time);
      EXPECT_EQ(simulation.values(), there);
      EXPECT_FALSE(simulation.has_ended());
      ASSERT_TRUE(simulation.run()) << simulation.finish().cause;
      EXPECT_NEAR(simulation.time(), end, 1e-9);
      const std::vector<double> found = simulation.values();
      for (std::size_t k = 0; k < expected.size(); ++k)
        EXPECT_NEAR(found[k], expected[k], c.tolerance * size) << simulation.header().columns[k];
      EXPECT_NEAR(static_cast<double>(simulation.finish().steps.accepted), static_cast<double>(steps), 2.0);
    }
  }
}

}  // namespace
}  // namespace bough::run
