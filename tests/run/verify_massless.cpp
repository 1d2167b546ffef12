// Beams whose sections have no rotary inertia: their rotations are those of statics at every instant. They are the limit
// of small inertias, and keep energy.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;
using support::scene_of;

/// A beam of 4 m along x under gravity, held at its start, in space or in its plane.
std::string beam(const std::string& joint, const std::string& rotary, int order, const std::string& more = "") {
  return R"-({"gravity": [0, 0, -9.81],
  "sections": [{"name": "s", "stiffness": {"EA": 1e7, "GA2": 1e6, "GA3": 1e6, "GJ": 2e4, "EI2": 3e4, "EI3": 2e4},
    "mass": {"mass_per_length": 10)-" +
         rotary + R"-(}}],
  "nodes": [{"name": "a"}, {"name": "b", "position": [4, 0, 0]}],
  "beams": [{"name": "beam", "section": "s", "start": "a", "end": "b", "elements": 6, "order": )-" +
         std::to_string(order) + R"-(}],
  "joints": [)-" +
         joint + R"-(],
  "sensors": [{"name": "tip", "kind": "position", "at": "b"}, {"name": "spin", "kind": "velocity", "at": "b"},
    {"name": "energy", "kind": "total_energy"}])-" +
         more + "}";
}

const std::string clamp = R"-({"name": "hold", "kind": "fixed", "first": "ground", "second": "a"})-";
const std::string pin =
    R"-({"name": "hold", "kind": "revolute", "first": "ground", "second": "a", "axis": [0, 1, 0]})-";
const std::string small = R"-(, "rotary": [2e-7, 1e-7, 1e-7])-";

std::vector<std::string> with(const std::string& integrator, double end, double step, bool in_space = false) {
  return {std::string("/analysis={\"kind\": \"dynamic\", \"integrator\": \"") + integrator +
              "\", \"end_time\": " + support::text(end) + ", \"step_size\": " + support::text(step) + "}",
          std::string("/without=") + (in_space ? "[\"planar\"]" : "[]")};
}

TEST(Massless, rotations_of_beams_are_the_limit_of_small_inertias) {
  for (const std::string& held : {clamp, pin})
    for (const int order : {1, 2, 3})
      for (const char* integrator : {"generalized_alpha", "bdf"})
        for (const bool in_space : {false, true}) {
          SCOPED_TRACE(held.substr(28, 8) + " order " + std::to_string(order) + " " + integrator +
                       (in_space ? " in space" : ""));
          const auto overrides = with(integrator, 0.2, 1e-3, in_space);
          const Outcome none = run_ok(scene_of(beam(held, "", order), overrides)),
                        limit = run_ok(scene_of(beam(held, small, order), overrides));
          const double moved = std::abs(limit.history.last("tip.z"));
          EXPECT_GT(moved, 0.01);
          EXPECT_NEAR(none.history.last("tip.z"), limit.history.last("tip.z"), 1e-4 * moved);
          EXPECT_NEAR(none.history.last("spin.wy"), limit.history.last("spin.wy"),
                      0.02 * limit.history.largest("spin.wy"));
        }
}

// The variational integrator has an elastic inertia of beams, so that it takes them, too; generalized-alpha without
// dissipation keeps the energy of steps that are resolved.
TEST(Massless, rotations_keep_the_energy) {
  for (const char* integrator : {"generalized_alpha", "variational"}) {
    SCOPED_TRACE(integrator);
    auto overrides = with(integrator, 1.0, 2e-4);
    if (std::string(integrator) == "generalized_alpha") overrides.emplace_back("/analysis/spectral_radius=0.95");
    overrides.emplace_back("/beams/0/elements=3");
    const Outcome out = run_ok(scene_of(beam(pin, "", 2), overrides));
    double worst = 0.0;
    for (const double e : out.history.of("energy")) worst = std::max(worst, std::abs(e - out.history.first("energy")));
    EXPECT_LT(worst, 2e-3 * 10.0 * 4.0 * 9.81) << worst;
  }
}

TEST(Massless, chains_of_beams_swing) {
  const std::string chain = R"-({"gravity": [0, 0, -9.81],
  "sections": [{"name": "s", "stiffness": {"EA": 1e6, "GA2": 1e5, "GA3": 1e5, "GJ": 200, "EI2": 300, "EI3": 300},
    "mass": {"mass_per_length": 2}}],
  "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}, {"name": "c", "position": [1, 0, 0]},
    {"name": "d", "position": [2, 0, 0]}],
  "beams": [{"name": "first", "section": "s", "start": "a", "end": "b", "elements": 3},
    {"name": "second", "section": "s", "start": "c", "end": "d", "elements": 3, "order": 2}],
  "joints": [{"name": "top", "kind": "revolute", "first": "ground", "second": "a", "axis": [0, 1, 0]},
    {"name": "knee", "kind": "revolute", "first": "b", "second": "c", "position": [1, 0, 0], "axis": [0, 1, 0]}],
  "sensors": [{"name": "end", "kind": "position", "at": "d"}, {"name": "energy", "kind": "total_energy"}]})-";
  for (const bool in_space : {false, true}) {
    const Outcome out = run_ok(scene_of(chain, with("generalized_alpha", 0.5, 1e-3, in_space)));
    EXPECT_LT(out.history.last("end.z"), -0.5);
    EXPECT_NEAR(out.history.last("energy"), out.history.first("energy"), 1e-2 * 2.0 * 2.0 * 9.81);
  }
}

// A spin about its own axis that neither inertia nor stiffness resists is named before the run.
TEST(Massless, a_spin_that_nothing_resists_is_named) {
  const std::string ball = R"-({"name": "ball", "kind": "spherical", "first": "ground", "second": "a"})-";
  const plan::Plan free = plan::make_plan(scene_of(beam(ball, "", 2), with("generalized_alpha", 0.1, 1e-3, true)));
  ASSERT_EQ(free.mobility.massless.size(), 1u);
  EXPECT_NE(free.mobility.massless[0].find("'beam' can turn about the axis (1, 0, 0)"), std::string::npos)
      << free.mobility.massless[0];
  for (const std::string& sound :
       {beam(ball, R"-(, "rotary": [1e-3, 0, 0])-", 2), beam(clamp, "", 2), beam(pin, "", 1)})
    EXPECT_TRUE(plan::make_plan(scene_of(sound, with("generalized_alpha", 0.1, 1e-3, true))).mobility.massless.empty());
}

}  // namespace
}  // namespace bough::run
