/// Accuracy as input: the steps and meshes that are found meet it, and what cannot be met is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bough/records/errors.hpp"
#include "bough/run/memory_run.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::scene_of;

/// A pendulum of two weights that does not turn over.
constexpr const char* weights = R"({"gravity": [0, 0, -9.81],
  "bodies": [{"name": "a", "mass": 1, "inertia": [1e-3, 1e-3, 1e-3], "position": [0.3, 0, -0.4]},
             {"name": "b", "mass": 1, "inertia": [1e-3, 1e-3, 1e-3], "position": [0.3, 0, -0.9]}],
  "joints": [{"name": "A", "kind": "revolute", "first": "ground", "second": "a", "position": [0, 0, 0],
              "axis": [0, 1, 0]},
             {"name": "B", "kind": "revolute", "first": "a", "second": "b", "position": [0.3, 0, -0.4],
              "axis": [0, 1, 0]}],
  "sensors": [{"name": "b", "kind": "position", "at": "b"}],
  "analysis": {"kind": "dynamic", "end_time": 2}})";

TEST(Accuracy, steps_are_found_that_meet_it) {
  const MemoryRun fine = run_in_memory(scene_of(weights, {"/analysis/step_size=6.103515625e-5"}));
  for (const char* asked : {"1e-2", "1e-4", "1e-5"}) {
    SCOPED_TRACE(asked);
    const MemoryRun run = run_in_memory(scene_of(weights, {std::string("/analysis/accuracy=") + asked}));
    ASSERT_TRUE(run.ok()) << run.text();
    EXPECT_TRUE(run.summary.doubts.empty()) << run.summary.doubts.front().text;
    EXPECT_TRUE(run.says("accuracy that was asked for is met")) << run.text();
    ASSERT_NE(run.summary.errors, nullptr);
    const double goal = std::stod(asked);
    for (const auto& e : run.summary.errors->columns)
      if (e.range > 0.0) EXPECT_LE(e.time.largest, goal * e.range) << e.name;
    // Against steps of another run, whose ends fall between those found: compared at the end.
    const double error = std::abs(run.final("b.x") - fine.final("b.x"));
    std::printf("asked %s: %ld steps, b.x off by %.2g at the end\n", asked, run.summary.steps.accepted, error);
    EXPECT_LE(error, 1.5 * goal);
    // Steps aim at 0.7 of what is allowed: far smaller errors would mean far more steps than needed.
    double share = 0.0;
    for (const auto& e : run.summary.errors->columns)
      if (e.range > 0.0) share = std::max(share, e.time.largest / (goal * e.range));
    if (run.summary.steps.accepted > 256) EXPECT_GT(share, 0.3);
  }
}

TEST(Accuracy, meshes_are_found_that_meet_it) {
  const auto beam = [](const std::string& analysis) {
    return scene_of(R"({"sections": [{"name": "s", "stiffness": [1e6, 1e6, 1e6, 100, 100, 100]}],
      "nodes": [{"name": "root", "position": [0, 0, 0]}, {"name": "tip", "position": [1, 0, 0]}],
      "beams": [{"name": "bar", "start": "root", "end": "tip", "section": "s", "elements": 1, "order": 1}],
      "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
      "loads": [{"at": "tip", "force": [0, 0, 60]}],
      "sensors": [{"name": "tip", "kind": "position", "at": "tip"}],
      "analysis": {"kind": "static", "load_steps": 4)" +
                    analysis + "}}");
  };
  const MemoryRun run = run_in_memory(beam(R"(, "accuracy": 1e-4)"));
  ASSERT_TRUE(run.ok()) << run.text();
  EXPECT_TRUE(run.summary.doubts.empty()) << run.summary.doubts.front().text;
  EXPECT_TRUE(run.says("times as many elements")) << run.text();
  scene::Scene finest = beam("");
  finest.beams[0].elements = 512;
  const MemoryRun fine = run_in_memory(finest);
  EXPECT_LE(std::abs(run.final("tip.z") - fine.final("tip.z")), 1.2e-4 * std::abs(fine.final("tip.z")));
}

TEST(Accuracy, it_may_be_that_of_some_results) {
  const MemoryRun all = run_in_memory(scene_of(weights, {R"(/analysis/accuracy={"relative": 1e-5, "of": ["b.x"]})"}));
  ASSERT_TRUE(all.ok()) << all.text();
  EXPECT_TRUE(all.says("'b.x'")) << all.text();
  const MemoryRun absolute = run_in_memory(scene_of(weights, {R"(/analysis/accuracy={"absolute": 1e-3})"}));
  ASSERT_TRUE(absolute.ok()) << absolute.text();
  for (const auto& e : absolute.summary.errors->columns) EXPECT_LE(e.time.largest, 1e-3) << e.name;
}

TEST(Accuracy, what_is_out_of_reach_is_told) {
  const MemoryRun far = run_in_memory(scene_of(weights, {"/analysis/accuracy=1e-14"}));
  EXPECT_FALSE(far.ok());
  EXPECT_TRUE(far.says("would take steps of")) << far.text();
}

TEST(Accuracy, faults_in_what_is_asked_are_named) {
  for (const char* fault :
       {R"(/analysis/accuracy={"mesh": false})", R"(/analysis/accuracy={"relative": 1e-3, "of": ["c"]})"})
    EXPECT_THROW((void)scene_of(weights, {fault}), std::exception) << fault;
  EXPECT_NO_THROW((void)scene_of(weights, {R"(/analysis/accuracy={"relative": 1e-3, "of": ["b.z"]})"}));
}

}  // namespace
}  // namespace bough::run
