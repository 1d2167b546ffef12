// Point masses whose rotation has no effect have displacements alone. They move as bodies do that have an inertia and
// on which no moment acts, for these do not turn either.
#include <gtest/gtest.h>

#include <algorithm>
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

/// An elastic arm that carries three masses: one pinned to its tip, one on a spring below it, and one on a rod below
/// that. The masses are either points or bodies.
scene::Scene arm_with_masses(bool points, const std::vector<std::string>& overrides) {
  const std::string kind = points ? R"-("kind": "point_mass")-" : R"-("inertia": [0.02, 0.03, 0.04])-";
  const std::string turned = R"-(, "rotation": {"axis": [0, 0, 1], "angle": 0.4})-";
  return scene_of(R"-({
  "gravity": [0, -9.81, 0],
  "frames": [{"name": "table", "turns": [{"axis": [0, 1, 0], "angle": {"expression": "0.4*t + 0.6*t^2"}}]}],
  "sections": [{"name": "bar", "stiffness": {"EA": 2e5, "GA2": 8e4, "GA3": 8e4, "GJ": 60, "EI2": 80, "EI3": 80},
                "mass": {"mass_per_length": 0.8, "rotary": [2e-3, 1e-3, 1e-3]}}],
  "nodes": [{"name": "root", "position": [0, 0, 0]}, {"name": "tip", "position": [1, 0, 0]}],
  "beams": [{"name": "arm", "section": "bar", "start": "root", "end": "tip", "elements": 4}],
  "bodies": [{"name": "pinned", "mass": 0.3, "position": [1, 0, 0])-" +
                      turned + ", " + kind + R"-(},
             {"name": "load", "mass": 0.5, "position": [1, -0.5, 0])-" +
                      turned + ", " + kind + R"-(},
             {"name": "bob", "mass": 0.2, "position": [1, -1, 0])-" +
                      turned + ", " + kind + R"-(}],
  "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"},
             {"name": "pin", "kind": "spherical", "first": "tip", "second": "pinned", "position": [1, 0, 0]},
             {"name": "rod", "kind": "distance", "first": "load", "second": "bob"}],
  "springs": [{"name": "rope", "stiffness": 300, "rest_length": 0.45, "damping": 0.5,
               "first": {"to": "tip"}, "second": {"to": "load"}}],
  "sensors": [{"name": "tip", "kind": "position", "at": "tip"},
              {"name": "load", "kind": "position", "at": "load"},
              {"name": "bob", "kind": "position", "at": "bob"},
              {"name": "speed", "kind": "velocity", "at": "bob"},
              {"name": "pinned", "kind": "acceleration", "at": "pinned"},
              {"name": "pull", "kind": "joint_reaction", "joint": "rod"},
              {"name": "clamp", "kind": "joint_reaction", "joint": "clamp"},
              {"name": "energy", "kind": "total_energy"}]})-",
                  overrides);
}

int num_unknowns(const scene::Scene& scene) {
  int all = 0;
  for (const int size : plan::make_plan(scene).graph.block_size) all += size;
  return all;
}

const std::string no_frames = "/frames=[]";
const std::string dynamics =
    R"-(/analysis={"kind": "dynamic", "end_time": 0.5, "step_size": 5e-3, "tolerance": 1e-11})-";
const std::string kicked = R"-(/initial_velocities=[{"of": "load", "velocity": [0.4, 0, 0.7]}])-";
const std::string kicked_in_plane = R"-(/initial_velocities=[{"of": "load", "velocity": [0.4, 0, 0]}])-";

struct Case {
  const char* name;
  std::vector<std::string> overrides;
  int unknowns_less;  ///< of three points against three bodies
};

const std::vector<Case>& cases() {
  static const std::vector<Case> list{
      {"space", {no_frames, dynamics, kicked}, 9},
      {"plane", {no_frames, dynamics, kicked_in_plane}, 3},
      {"backward differences", {no_frames, dynamics, kicked, "/analysis/integrator=bdf"}, 9},
      {"start in equilibrium", {no_frames, dynamics, "/analysis/start=equilibrium"}, 3}};
  return list;
}

TEST(Points, move_as_bodies_on_which_no_moment_acts) {
  for (const Case& c : cases()) {
    const scene::Scene points = arm_with_masses(true, c.overrides), bodies = arm_with_masses(false, c.overrides);
    EXPECT_EQ(num_unknowns(points) + c.unknowns_less, num_unknowns(bodies)) << c.name;
    const Outcome a = run_ok(points), b = run_ok(bodies);
    ASSERT_EQ(a.history.rows.size(), b.history.rows.size()) << c.name;
    for (const std::string& column : a.history.columns)
      for (std::size_t k = 0; k < a.history.rows.size(); ++k)
        EXPECT_NEAR(a.history.of(column)[k], b.history.of(column)[k], 1e-8 * (1.0 + b.history.largest(column)))
            << c.name << ", " << column << ", row " << k;
  }
}

// Bodies that turn have other errors: in a turning frame they are integrated in axes that turn against it, and a rod of
// the variational integrator that turns during a step exerts small moments on them.
TEST(Points, differ_from_bodies_that_turn_by_errors_of_second_order_at_least) {
  const std::vector<std::vector<std::string>> list{{dynamics, kicked, "/analysis/frame=table"},
                                                   {no_frames, dynamics, kicked, "/analysis/integrator=variational"}};
  for (const std::vector<std::string>& overrides : list) {
    const auto difference = [&](double step_size) {
      std::vector<std::string> all = overrides;
      all.push_back("/analysis/step_size=" + support::text(step_size));
      const scene::Scene points = arm_with_masses(true, all), bodies = arm_with_masses(false, all);
      EXPECT_EQ(num_unknowns(points) + 9, num_unknowns(bodies));
      const Outcome a = run_ok(points), b = run_ok(bodies);
      double most = 0.0;
      for (const char* column : {"tip.x", "tip.y", "tip.z", "load.x", "load.y", "load.z", "bob.x", "bob.y", "bob.z"})
        most = std::max(most, std::abs(a.history.last(column) - b.history.last(column)));
      return most;
    };
    const double coarse = difference(5e-3), fine = difference(2.5e-3);
    EXPECT_GT(coarse, 1e-12);
    EXPECT_LT(coarse, 1e-5);
    EXPECT_GT(std::log2(coarse / fine), 1.5) << overrides.back();
  }
}

// The arm bends as under the dead weight of the masses. In statics nothing would hold the rotations of bodies.
TEST(Points, hang_in_statics_as_weights_do) {
  const std::vector<std::string> common{no_frames,
                                        R"-(/analysis={"kind": "static", "load_steps": 2, "tolerance": 1e-11})-",
                                        R"-(/sensors=[{"name": "tip", "kind": "position", "at": "tip"}])-"};
  const std::string clamp = R"-({"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"})-";
  const double m = 0.5, pinned = 0.3, g = 9.81;
  for (const char* without : {"[]", "[\"planar\"]"}) {
    std::vector<std::string> masses = common, weights = common;
    for (std::vector<std::string>* all : {&masses, &weights}) all->push_back(std::string("/without=") + without);
    masses.push_back(R"-(/bodies=[{"name": "pinned", "mass": 0.3, "position": [1, 0, 0], "kind": "point_mass"},
                                  {"name": "load", "mass": 0.5, "position": [1, -0.5, 0], "kind": "point_mass"}])-");
    masses.push_back("/joints=[" + clamp +
                     R"-(, {"name": "pin", "kind": "spherical", "first": "tip", "second": "pinned",
                            "position": [1, 0, 0]}])-");
    masses.emplace_back(R"-(/sensors=[{"name": "tip", "kind": "position", "at": "tip"},
                                      {"name": "load", "kind": "position", "at": "load"}])-");
    weights.emplace_back("/bodies=[]");
    weights.push_back("/joints=[" + clamp + "]");
    weights.emplace_back("/springs=[]");
    weights.push_back(R"-(/loads=[{"name": "weight", "at": "tip", "force": [0, )-" + support::text(-(m + pinned) * g) +
                      ", 0]}]");
    const Outcome a = run_ok(arm_with_masses(true, masses)), b = run_ok(arm_with_masses(true, weights));
    for (const char* column : {"tip.x", "tip.y", "tip.z"})
      EXPECT_NEAR(a.history.last(column), b.history.last(column), 1e-10) << column;
    EXPECT_LT(b.history.last("tip.y"), -0.01);
    EXPECT_NEAR(a.history.last("load.x"), a.history.last("tip.x"), 1e-10);
    EXPECT_NEAR(a.history.last("load.y"), a.history.last("tip.y") - (0.45 + m * g / 300.0), 1e-10);
  }
}

TEST(Points, keep_their_orientation_whatever_spin_they_are_given) {
  scene::Scene s = arm_with_masses(
      true, {no_frames, dynamics, R"-(/initial_velocities=[{"of": "load", "angular_velocity": [1, 2, 3]}])-",
             R"-(/sensors=[{"name": "axes", "kind": "rotation", "at": "load"},
                           {"name": "turning", "kind": "velocity", "at": "load"}])-"});
  const Outcome r = run_ok(s);
  for (const char* column : {"axes.rx", "axes.ry", "axes.rz"})
    for (const double value : r.history.of(column)) EXPECT_NEAR(value, r.history.first(column), 1e-14) << column;
  for (const char* column : {"turning.wx", "turning.wy", "turning.wz"}) EXPECT_EQ(r.history.largest(column), 0.0);
  ASSERT_EQ(r.summary.changed_velocities.size(), 1u);
  EXPECT_EQ(r.summary.changed_velocities[0].of, "load");
}

// A row along an axis of the ground pulls at the point alone, with whatever else acts there.
TEST(Points, do_not_turn_on_a_prescribed_motion_of_some_components) {
  for (const char* pull : {R"-("stiffness": 1000)-", R"-("force_law": {"expression": "1000*stretch"})-"})
    for (const char* analysis :
         {R"-({"kind": "static"})-", R"-({"kind": "dynamic", "end_time": 0.01, "step_size": 1e-3})-"}) {
      SCOPED_TRACE(std::string(pull) + analysis);
      const Outcome r = run_ok(scene_of(std::string(R"-({"gravity": [0, 0, -9.81],
        "bodies": [{"name": "tip", "kind": "point_mass", "mass": 1, "position": [0, 0, -1]}],
        "springs": [{"name": "s", "first": "ground", "second": "tip", "rest_length": 1, )-") +
                                        pull + R"-(}], "motions": [{"name": "m", "at": "tip", "x": 0, "y": 0}],
        "sensors": [{"name": "tip", "kind": "position", "at": "tip"}], "analysis": )-" +
                                        analysis + "}"));
      if (std::string(analysis).find("static") != std::string::npos)
        EXPECT_NEAR(r.history.last("tip.z"), -1.0 - 9.81 / 1000.0, 1e-9);
    }
}

}  // namespace
}  // namespace bough::run
