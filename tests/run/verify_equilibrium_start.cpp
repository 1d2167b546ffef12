// Dynamics that starts in equilibrium ("start": "equilibrium"): against statics, against closed forms, and that it
// stays there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bough/laws/make_law.hpp"
#include "bough/scene/parts.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::gallery;
using support::Outcome;

constexpr const char* in_equilibrium = "/analysis/start=equilibrium";

/// Largest less smallest value of a column.
double range_of(const support::Table& t, const std::string& column) {
  const std::vector<double> x = t.of(column);
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  return *most - *least;
}

/// A cantilever of steel that sags by 22 mm under its weight, for 1 s.
scene::Scene cantilever() {
  const double EA = 8.4e7, EI = 2800.0, mass = 3.14;
  scene::Scene s = scene::make_cantilever(scene::make_section("s", EA, 2.7e7, 2.7e7, 2150.0, EI, EI), 2.0, 8, 2);
  for (int i = 0; i < 3; ++i) {
    s.sections[0].mass(i, i) = mass;
    s.sections[0].mass(i + 3, i + 3) = 2e-4;
  }
  s.gravity = {{0, 0, -9.81}};
  s.sensors = {scene::make_point_sensor("tip", scene::SensorKind::position, s.nodes[1].name),
               scene::make_point_sensor("speed", scene::SensorKind::velocity, s.nodes[1].name)};
  s.analysis.kind = scene::AnalysisKind::dynamics;
  s.analysis.end_time = 1.0;
  s.analysis.step_size = 1e-3;
  s.analysis.start = scene::StartKind::equilibrium;
  return s;
}

TEST(EquilibriumStart, is_that_of_statics) {
  const Outcome dynamic = support::run(cantilever());
  ASSERT_TRUE(dynamic.ok()) << dynamic.summary.cause;
  scene::Scene rest = cantilever();
  rest.analysis.kind = scene::AnalysisKind::statics;
  rest.analysis.tolerance = 1e-12;
  rest.sensors.pop_back();
  const Outcome is_static = support::run(rest);
  ASSERT_TRUE(is_static.ok()) << is_static.summary.cause;
  EXPECT_NEAR(is_static.history.last("tip.z"), -3.14 * 9.81 * 16.0 / (8.0 * 2800.0), 3e-4) << "q L^4 / 8 EI";
  for (const char* column : {"tip.x", "tip.z"})
    EXPECT_NEAR(dynamic.history.first(column), is_static.history.last(column), 1e-12) << column;
}

TEST(EquilibriumStart, stays_there) {
  const Outcome beam = support::run(cantilever());
  ASSERT_TRUE(beam.ok()) << beam.summary.cause;
  EXPECT_LT(range_of(beam.history, "tip.z"), 1e-13);
  EXPECT_LT(beam.history.largest("speed.vz"), 1e-10);
  for (const char* integrator : {"bdf", "variational"}) {
    const Outcome chain = support::run(gallery("hanging_chain", {std::string("/analysis/integrator=") + integrator}));
    ASSERT_TRUE(chain.ok()) << chain.summary.cause;
    EXPECT_LT(range_of(chain.history, "middle.z"), 1e-12) << integrator;
  }
  const Outcome rotor = support::run(gallery(
      "rotating_cantilever", {"/analysis={\"kind\":\"dynamic\",\"frame\":\"hub\",\"end_time\":1}", in_equilibrium}));
  ASSERT_TRUE(rotor.ok()) << rotor.summary.cause;
  EXPECT_LT(range_of(rotor.history, "tip.x"), 1e-13) << "relative equilibrium in the turning frame";
  EXPECT_TRUE(std::all_of(rotor.summary.expected.begin(), rotor.summary.expected.end(),
                          [](const records::ExpectedResult& e) { return e.holds; }));
}

// The tie of this crane may spin about its own axis: nothing resists that.
TEST(EquilibriumStart, leaves_motions_that_nothing_resists) {
  scene::Scene crane = gallery("../gallery/crane", {in_equilibrium, "/analysis/end_time=2"});
  crane.joints[0].drives[0].law = laws::make_constant(0.0);
  crane.output.motion = false;
  const Outcome r = support::run(crane);
  ASSERT_TRUE(r.ok()) << r.summary.cause;
  const double sag = 10.0 - r.history.first("tip.z");
  EXPECT_GT(sag, 0.05);
  EXPECT_LT(range_of(r.history, "tip.z"), 1e-6 * sag);
  EXPECT_LT(range_of(r.history, "load.z"), 1e-6 * sag);
}

TEST(EquilibriumStart, takes_the_values_of_laws_behind_time_zero) {
  scene::Scene s = cantilever();
  s.gravity = scene::Vec3::zero();
  s.point_loads = {scene::make_load(s.nodes[1].name, {{0, 0, -1}})};
  s.point_loads[0].law = laws::make_expression("step(t)");
  const Outcome r = support::run(s);
  ASSERT_TRUE(r.ok()) << r.summary.cause;
  EXPECT_NEAR(r.history.first("tip.z"), -8.0 / (3.0 * 2800.0), 1e-7) << "F L^3 / 3 EI";
  EXPECT_LT(range_of(r.history, "tip.z"), 1e-14);
}

// A pendulum falls from the horizontal into the equilibrium below its pin, where it has the velocity that was given.
TEST(EquilibriumStart, adds_the_initial_velocities) {
  const Outcome r = support::run(support::scene_of(R"({"gravity": [0, 0, -9.81],
    "bodies": [{"name": "bob", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [1, 0, 0]}],
    "joints": [{"name": "pin", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0],
                "axis": [0, 1, 0]}],
    "initial_velocities": [{"of": "bob", "velocity": [0.5, 0, 0], "angular_velocity": [0, -0.5, 0]}],
    "sensors": [{"name": "place", "kind": "position", "at": "bob"},
                {"name": "speed", "kind": "velocity", "at": "bob", "axes": "space"}],
    "analysis": {"kind": "dynamic", "start": "equilibrium", "end_time": 1, "step_size": 1e-3}})"));
  ASSERT_TRUE(r.ok()) << r.summary.cause;
  EXPECT_NEAR(r.history.first("place.z"), -1.0, 1e-12);
  EXPECT_NEAR(r.history.first("speed.vx"), 0.5, 1e-12);
  EXPECT_NEAR(r.history.first("speed.wy"), -0.5, 1e-12);
}

// A pendulum placed exactly upright has no reason to fall, and one that hangs is stable.
TEST(EquilibriumStart, tells_that_it_is_unstable) {
  for (const bool is_upright : {true, false}) {
    const Outcome r = support::run(support::scene_of(std::string(R"({"gravity": [0, 0, -9.81],
      "bodies": [{"name": "bob", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [0, 0, )") +
                                                     (is_upright ? "1" : "-1") + R"(]}],
      "joints": [{"name": "pin", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0],
                  "axis": [0, 1, 0]}],
      "sensors": [{"name": "place", "kind": "position", "at": "bob"}],
      "analysis": {"kind": "dynamic", "start": "equilibrium", "end_time": 0.1, "step_size": 1e-3}})"));
    ASSERT_TRUE(r.ok()) << r.summary.cause;
    EXPECT_EQ(r.history.first("place.z"), is_upright ? 1.0 : -1.0);
    const bool is_told = std::any_of(r.summary.notes.begin(), r.summary.notes.end(), [](const std::string& note) {
      return note.find("unstable") != std::string::npos &&
             note.find("'bob' moves most, along (1, 0, 0)") != std::string::npos;
    });
    EXPECT_EQ(is_told, is_upright);
  }
}

TEST(EquilibriumStart, names_what_comes_to_no_rest) {
  const Outcome r = support::run(gallery("free_body", {in_equilibrium, "/gravity=[0,0,-9.81]"}));
  EXPECT_FALSE(r.ok());
  EXPECT_NE(r.summary.cause.find("no equilibrium to start from: 'body' moves farthest"), std::string::npos)
      << r.summary.cause;
}

// A rotor that is described in the inertial frame starts in its equilibrium relative to its rotation, whether a frame
// carries it, a hub is driven, or it is given a spin; it is the one of the scene described in the turning frame, where
// it stays: its tip runs on a circle, and no velocity is changed.
TEST(EquilibriumStart, of_a_rotor_is_relative_to_its_rotation) {
  const auto rotor = [](const std::string& axle, const std::string& more, const std::string& analysis = "") {
    return support::run(support::scene_of(R"-({
  "sections": [{"name": "bar", "stiffness": {"EA": 2e5, "GA2": 8e4, "GA3": 8e4, "GJ": 60, "EI2": 80, "EI3": 80},
    "mass": {"mass_per_length": 0.8, "rotary": [2e-3, 1e-3, 1e-3]}}],
  "nodes": [{"name": "root", "position": [0.5, 0.2, 0]}, {"name": "tip", "position": [2.5, 0.2, 0.3]}],
  "beams": [{"name": "blade", "section": "bar", "start": "root", "end": "tip", "elements": 4, "order": 2}],
  "joints": [{"name": "clamp", "kind": "fixed", "first": "hub", "second": "root"})-" +
                                          axle +
                                          R"-(], "sensors": [{"name": "tip", "kind": "position", "at": "tip"}])-" +
                                          more + R"-(, "analysis": {"kind": "dynamic", "end_time": 0.3,
    "step_size": 1e-3, "start": "equilibrium")-" +
                                          analysis + "}}"));
  };
  const std::string frame = R"-(, "frames": [{"name": "hub", "turns": [{"axis": [0, 0, 1],
                      "angle": {"expression": "20*t"}}]}])-",
                    hub = R"-(, "bodies": [{"name": "hub", "mass": 3, "inertia": [0.1, 0.1, 0.2]}])-",
                    spin = R"-(, "initial_velocities": [{"of": "hub", "angular_velocity": [0, 0, 20]},
                      {"of": "blade", "velocity": [-4, 10, 0], "angular_velocity": [0, 0, 20]}])-";
  const auto axle = [](const std::string& drive) {
    return R"-(, {"name": "axle", "kind": "revolute", "first": "ground", "second": "hub", "position": [0, 0, 0],
      "axis": [0, 0, 1])-" +
           drive + "}";
  };
  const Outcome known = rotor("", frame, R"-(, "frame": "hub")-");
  ASSERT_TRUE(known.ok()) << known.summary.cause;
  const double radius = std::hypot(known.history.first("tip.x"), known.history.first("tip.y")),
               stretch = radius - std::hypot(2.5, 0.2);
  EXPECT_GT(stretch, 1e-3);
  const std::pair<const char*, Outcome> same[] = {
      {"carried by a frame", rotor("", frame)},
      {"driven at a rate", rotor(axle(R"-(, "drives": [{"rate": true, "law": 20}])-"), hub)},
      {"driven by an angle, and given the spin",
       rotor(axle(R"-(, "drives": [{"law": {"expression": "20*t"}}])-"), hub + spin)},
      {"given the spin", rotor(axle(""), hub + spin)}};
  for (const auto& [what, out] : same) {
    SCOPED_TRACE(what);
    ASSERT_TRUE(out.ok()) << out.summary.cause;
    for (const char* column : {"tip.x", "tip.y", "tip.z"})
      EXPECT_NEAR(out.history.first(column), known.history.first(column), 1e-9) << column;
    for (const auto& row : out.history.rows)
      EXPECT_NEAR(std::hypot(row[out.history.column("tip.x")], row[out.history.column("tip.y")]), radius,
                  0.01 * stretch);
    EXPECT_TRUE(out.summary.changed_velocities.empty());
  }
}

TEST(EquilibriumStart, refuses_frames_that_move_at_time_zero) {
  try {
    support::scene_of(R"({"frames": [{"name": "cart", "position": [{"expression": "2*t"}, 0, 0]}],
      "bodies": [{"name": "bob", "mass": 1, "inertia": [0.1, 0.1, 0.1]}],
      "joints": [{"name": "clamp", "kind": "fixed", "first": "cart", "second": "bob"}],
      "analysis": {"kind": "dynamic", "start": "equilibrium", "end_time": 1}})");
    FAIL() << "the cart moves, and the analysis is not described in it";
  } catch (const std::runtime_error& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("frame 'cart' moves at time 0"), std::string::npos) << refusal.what();
  }
}

}  // namespace
}  // namespace bough::run
