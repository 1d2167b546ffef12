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
