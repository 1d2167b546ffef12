/// What the plan leaves out changes no result: every scene of the gallery with each decision taken and barred.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "../step/lattice_scene.hpp"
#include "bough/plan/plan.hpp"
#include "bough/scene/components.hpp"
#include "support/scenes.hpp"
#include "support/source_dir.hpp"
#include "welded_scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;

std::vector<std::string> gallery_stems() {
  std::vector<std::string> stems;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data/scenarios"))
    if (entry.path().extension() == ".json") stems.push_back(entry.path().stem().string());
  std::sort(stems.begin(), stems.end());
  return stems;
}

/// The scene with places and velocities off by about one part in 1e15, each by its own; within a plane or a line, if
/// they were.
scene::Scene twin_of(scene::Scene s, int k) {
  const auto shake = [&k](scene::Vec3& v) {
    const double factor = 1.0 + (++k % 3 - 1) * 1e-15;
    for (int i = 0; i < 3; ++i) v[i] *= factor;
  };
  for (scene::Node& n : s.nodes) shake(n.placement.pose.x);
  for (scene::Body& b : s.bodies) shake(b.placement.pose.x);
  for (scene::InitialVelocity& v : s.initial_velocities) {
    shake(v.velocity);
    shake(v.angular_velocity);
  }
  shake(s.gravity);
  return s;
}

/// Largest difference of a column over the rows that both have.
double difference(const support::Table& a, const support::Table& b, std::size_t column) {
  double most = a.rows.size() == b.rows.size() ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < std::min(a.rows.size(), b.rows.size()); ++r)
    most = std::max(most, std::abs(a.rows[r][column] - b.rows[r][column]));
  return most;
}

/// Largest entry of the columns of one sensor: its vector's components share round-off.
double size_of_sensor(const support::Table& t, const std::string& column) {
  const std::string sensor = column.substr(0, column.rfind('.'));
  double most = 0.0;
  for (std::size_t c = 0; c < t.columns.size(); ++c)
    if (t.columns[c].substr(0, t.columns[c].rfind('.')) == sensor)
      for (const auto& row : t.rows) most = std::max(most, std::abs(row[c]));
  return most;
}

/// What round-off alone leaves: eps |x| in positions, eps |x| / h in velocities, eps |x| / h^2 in accelerations, eps
/// m |x| / h^2 in forces and eps of the terms of energies, whatever their sum is.
double floor_of(const scene::Scene& s, const plan::Plan& plan, const Outcome& run, const std::string& column) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  const double h = s.analysis.kind == scene::AnalysisKind::dynamics ? s.analysis.step_size : 1.0;
  double mass = 0.0;
  for (const scene::Body& b : s.bodies) mass += b.mass;
  for (const plan::BeamPlan& b : plan.beams)
    for (const scene::Beam& given : s.beams)
      for (const scene::Section& section : s.sections)
        if (given.name == b.name && given.section == section.name) mass += section.mass(0, 0) * b.length;
  for (const scene::Sensor& sensor : s.sensors) {
    if (column.substr(0, column.rfind('.')) != sensor.name && column != sensor.name) continue;
    switch (sensor.kind) {
      case scene::SensorKind::position:
        return eps * plan.length_scale;
      case scene::SensorKind::velocity:
      case scene::SensorKind::joint_rate:
        return eps * plan.length_scale / h;
      case scene::SensorKind::acceleration:
        return eps * plan.length_scale / (h * h);
      case scene::SensorKind::joint_reaction:
      case scene::SensorKind::section_force:
        return eps * mass * plan.length_scale / (h * h) * std::max(1.0, plan.length_scale);
      case scene::SensorKind::total_energy:
        return 1e-10 * run.summary.checks.energy_scale;
      default:
        return 0.0;
    }
  }
  return 0.0;
}

/// Runs of a scene with all its decisions, and of twins, which tell what round-off alone changes.
struct Runs {
  scene::Scene scene;
  plan::Plan plan;
  Outcome run;
  std::vector<Outcome> twins;
  explicit Runs(const scene::Scene& s) : scene(s), plan(plan::make_plan(s)), run(support::run(s)) {
    for (int k = 0; k < 3; ++k) twins.push_back(support::run(twin_of(s, k)));  // one alone may happen to come near
  }
};

/// The same results without a decision. Returns the run that is without. others: with twins of their own, where the
/// round-off of what is left out counts.
Outcome expect_the_same_without(const Runs& all, const std::string& decision, const Runs* others = nullptr) {
  scene::Scene s = all.scene;
  s.without.push_back(decision);
  Outcome without = support::run(s);
  EXPECT_TRUE(without.ok()) << decision << ": " << without.summary.cause;
  for (std::size_t c = 0; c < all.run.history.columns.size(); ++c) {
    const std::string& column = all.run.history.columns[c];
    double allowed =
        std::max(1e-10 * size_of_sensor(all.run.history, column), floor_of(all.scene, all.plan, all.run, column));
    for (const Outcome& twin : all.twins)
      allowed = std::max(allowed, 10.0 * difference(all.run.history, twin.history, c));
    if (others != nullptr)
      for (const Outcome& twin : others->twins)
        allowed = std::max(allowed, 10.0 * difference(others->run.history, twin.history, c));
    const double found = difference(all.run.history, without.history, c);
    EXPECT_LE(found, allowed) << decision << ", " << column << " of size " << size_of_sensor(all.run.history, column);
  }
  return without;
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, has_the_same_results_with_and_without_each_decision) {
  const scene::Scene given = support::gallery(GetParam());
  const Runs as_given(given);
  ASSERT_TRUE(as_given.run.ok()) << as_given.run.summary.cause;
  // Iterations with old factors, or in other unknowns, end elsewhere within the tolerance: these are compared at one
  // near round-off.
  scene::Scene tight = given;
  tight.analysis.tolerance = 1e-12;
  const Runs at_round_off(tight);
  for (const plan::Decision& d : as_given.plan.decisions)
    if (d.taken && d.can_be_barred)
      expect_the_same_without(d.name == "reuse" || d.name == "welded" || d.name == "planar" ? at_round_off : as_given,
                              d.name);
}

TEST(Gallery, has_a_scene_for_every_decision) {
  std::set<std::string> taken;
  for (const std::string& stem : gallery_stems())
    for (const plan::Decision& d : plan::make_plan(support::gallery(stem)).decisions)
      if (d.taken) taken.insert(d.name);
  for (const std::string& name : scene::decision_names()) EXPECT_TRUE(taken.contains(name)) << name;
}

INSTANTIATE_TEST_SUITE_P(Gallery, EveryScene, testing::ValuesIn(gallery_stems()),
                         [](const auto& given) { return given.param; });

class EveryWeldedScene : public testing::TestWithParam<WeldedScene> {};

TEST_P(EveryWeldedScene, has_the_same_results_without_the_decision) {
  scene::Scene s = support::scene_of(GetParam().text);
  s.analysis.tolerance = 1e-12;
  const Runs all(s);
  ASSERT_TRUE(all.run.ok()) << all.run.summary.cause;
  ASSERT_TRUE(all.plan.took("welded"));
  s.without.push_back("welded");
  const Runs barred(s);  // a part that is held has no round-off, its bodies have
  EXPECT_EQ(all.plan.nodes.size() + 4, barred.plan.nodes.size());
  EXPECT_EQ(all.plan.joints.size() + 5, barred.plan.joints.size());
  EXPECT_EQ(all.plan.unknowns.motions, barred.plan.unknowns.motions);
  EXPECT_GE(all.plan.held.size(), barred.plan.held.size());  // more where joints of the part form a loop
  EXPECT_EQ(all.plan.length_scale, barred.plan.length_scale);
  const Outcome other = expect_the_same_without(all, "welded", &barred);
  EXPECT_EQ(all.run.summary.steps.accepted, other.summary.steps.accepted);
  const double energy = other.summary.checks.energy_scale;
  EXPECT_NEAR(all.run.summary.checks.energy_scale, energy, 1e-9 * energy);
  EXPECT_NEAR(all.run.summary.checks.energy_balance, other.summary.checks.energy_balance, 1e-9 * energy);
  EXPECT_NEAR(all.run.summary.checks.momentum_balance, other.summary.checks.momentum_balance, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Welded, EveryWeldedScene, testing::ValuesIn(welded_scenes()),
                         [](const auto& given) { return given.param.name; });

/// Two bodies fixed to each other, the second turned by a right angle, are one with their mass, centre and inertia:
/// by the parallel axis theorem.
TEST(WeldedBodies, tumble_as_the_one_body_they_are) {
  const auto scene_with = [](const std::string& bodies, const std::string& joints, const std::string& second) {
    return support::scene_of(R"json({"bodies": [)json" + bodies + R"json(], "joints": [)json" + joints + R"json(],
      "initial_velocities": [{"of": "a", "velocity": [0.1, 0.2, -0.3], "angular_velocity": [1, 2, -0.5]})json" +
                             second + R"json(],
      "sensors": [{"name": "place", "kind": "position", "at": {"to": "a", "position": [0, 1, 0]}},
        {"name": "turn", "kind": "quaternion", "at": "a"}, {"name": "speed", "kind": "velocity", "at": "a", "axes": "body"},
        {"name": "energy", "kind": "total_energy"}],
      "analysis": {"kind": "dynamic", "end_time": 10, "step_size": 0.005, "tolerance": 1e-12, "integrator": "variational"}})json");
  };
  // a: 2 kg at the origin; b: 6 kg with its centre at (0, 1, 0), its axes 1 and 2 along -y and x.
  const scene::Scene pair = scene_with(
      R"json({"name": "a", "mass": 2, "inertia": [0.3, 0.4, 0.5]},
        {"name": "b", "mass": 6, "inertia": [0.8, 0.7, 0.9], "position": [0, 1.5, 0], "rotation": {"axis": [0, 0, 1], "angle": -1.5707963267948966},
         "center_of_mass": [0.5, 0, 0]})json",
      R"json({"name": "both", "kind": "fixed", "first": "a", "second": "b", "position": [0.2, 0.3, 0.4]})json",
      // v + w x r,  r = (0, 1.5, 0)
      R"json(, {"of": "b", "velocity": [0.85, 0.2, 1.2], "angular_velocity": [1, 2, -0.5]})json");
  // mu = 2 * 6 / 8 of the distance 1 along y; b's inertia about x is 0.7, about y 0.8.
  const scene::Scene one = scene_with(
      R"json({"name": "a", "mass": 8, "inertia": [2.5, 1.2, 2.9], "center_of_mass": [0, 0.75, 0]})json", "", "");
  const plan::Plan plan = plan::make_plan(pair);
  ASSERT_TRUE(plan.took("welded"));
  ASSERT_EQ(plan.nodes.size(), 1u);
  const Outcome found = support::run(pair), expected = support::run(one);
  ASSERT_TRUE(found.ok() && expected.ok());
  for (std::size_t c = 0; c < found.history.columns.size(); ++c)
    EXPECT_LE(difference(found.history, expected.history, c),
              1e-10 * size_of_sensor(expected.history, found.history.columns[c]))
        << found.history.columns[c];
  EXPECT_LT(found.summary.checks.momentum_balance, 1e-11);
  EXPECT_LT(found.summary.checks.energy_balance, 1e-4 * found.summary.checks.energy_scale);
}

/// The last picture of a run.
class LastPicture final : public records::Recorder {
 public:
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame& f) override { frame = f; }
  void end(const records::Summary&) override {}
  records::MotionFrame frame;
};

TEST(WeldedBodies, are_shown_as_the_bodies_they_are) {
  scene::Scene s =
      support::scene_of(frame_scene(true, "", R"json(, "analysis": {"kind": "dynamic", "end_time": 0.02})json"));
  s.output.motion = true;
  LastPicture with, without;
  ASSERT_EQ(run::simulate(s, {}, with).status, records::RunStatus::ok);
  s.without.push_back("welded");
  ASSERT_EQ(run::simulate(s, {}, without).status, records::RunStatus::ok);
  const auto expect_near = [](const auto& a, const auto& b, const std::string& what) {
    for (std::size_t i = 0; i < std::size(a); ++i) EXPECT_NEAR(a[i], b[i], 1e-8) << what;
  };
  const std::vector<records::BodyPose>&a = with.frame.bodies, &b = without.frame.bodies;
  ASSERT_EQ(a.size(), 3u);
  ASSERT_EQ(b.size(), 3u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    expect_near(a[i].position, b[i].position, a[i].name);
    expect_near(a[i].center, b[i].center, a[i].name);
    expect_near(a[i].axes, b[i].axes, a[i].name);
    ASSERT_EQ(a[i].attachments.size(), b[i].attachments.size());
    for (std::size_t k = 0; k < a[i].attachments.size(); ++k)
      expect_near(a[i].attachments[k], b[i].attachments[k], a[i].name);
  }
  ASSERT_EQ(with.frame.links.size(), without.frame.links.size());
  for (const records::Link& link : without.frame.links) {
    const auto same = std::find_if(with.frame.links.begin(), with.frame.links.end(),
                                   [&](const records::Link& other) { return other.name == link.name; });
    ASSERT_NE(same, with.frame.links.end()) << link.name;
    expect_near(same->first, link.first, link.name);
    expect_near(same->second, link.second, link.name);
  }
}

/// A lattice of the size from which symmetric parts are taken, one edge clamped, measured at the far corner.
scene::Scene clamped_lattice(scene::AnalysisKind kind) {
  scene::Scene s = test::make_lattice(kind);
  for (int i = 0; i < 10; ++i) {
    scene::Joint clamp;
    clamp.name = "clamp " + std::to_string(i);
    clamp.kind = scene::JointKind::fixed;
    clamp.first.offset.x = {{0.0, 0.5 * i, 0.0}};
    clamp.second.to = "0," + std::to_string(i);
    s.joints.push_back(clamp);
  }
  scene::Sensor corner;
  corner.name = "corner";
  corner.at.to = "9,9";
  s.sensors.push_back(corner);
  scene::Sensor force;
  force.name = "force";
  force.kind = scene::SensorKind::section_force;
  force.beam = "0,4 to 1,4";
  s.sensors.push_back(force);
  return s;
}

TEST(Symmetric, a_lattice_has_the_same_results_without_the_decision) {
  for (const auto kind : {scene::AnalysisKind::dynamics, scene::AnalysisKind::statics}) {
    scene::Scene given = clamped_lattice(kind);
    if (kind == scene::AnalysisKind::statics)
      given.gravity = {{0.0, 0.0, -0.5}};  // in one step: iterates need not be near an equilibrium
    const Runs all(given);
    ASSERT_TRUE(all.run.ok()) << all.run.summary.cause;
    ASSERT_TRUE(all.plan.took("symmetric"));
    expect_the_same_without(all, "symmetric");
  }
}

TEST(Symmetric, a_lattice_pressed_beyond_buckling_has_the_same_results_without_the_decision) {
  scene::Scene s = clamped_lattice(scene::AnalysisKind::statics);
  s.gravity = scene::Vec3::zero();
  for (int i = 0; i < 10; ++i) {  // in its plane, where it stays: ten beams of 4.5 m buckle at 340 N each
    scene::PointLoad load;
    load.name = "load " + std::to_string(i);
    load.at.to = "9," + std::to_string(i);
    load.force = {{-2000.0, 0.0, 0.0}};
    s.point_loads.push_back(load);
  }
  const Runs all(s);
  ASSERT_TRUE(all.run.ok()) << all.run.summary.cause;
  ASSERT_TRUE(all.plan.took("symmetric"));
  expect_the_same_without(all, "symmetric");
}

}  // namespace
}  // namespace bough::run
