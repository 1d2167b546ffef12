/// Scenes in fewer unknowns a node: what the plan makes of them, and planar elements against those in space.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bough/results/energies.hpp"
#include "step/same_motion.hpp"
#include "support/given.hpp"
#include "support/rig.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using motion::Vec3;
using motion::Vec6;
using test::expand;
using test::Rig;

const plan::Decision& decision(const plan::Plan& plan, const std::string& name) {
  for (const plan::Decision& d : plan.decisions)
    if (d.name == name) return d;
  throw std::runtime_error("no decision " + name);
}

/// Every kind of element and joint in the plane of x and y.
scene::Scene flat_scene() {
  return support::scene_of(R"({
    "gravity": [1, -9.81, 0],
    "materials": [{"name": "steel", "young": 2.1e11, "poisson": 0.3, "density": 7850}],
    "sections": [
      {"name": "bar", "shape": {"kind": "rectangle", "width": 0.02, "height": 0.03}, "material": "steel"},
      {"name": "damped", "stiffness": {"EA": 4e5, "GA2": 1e5, "GA3": 2e5, "GJ": 30, "EI2": 70, "EI3": 50},
       "mass": {"mass_per_length": 0.3, "rotary": [5e-4, 2e-4, 3e-4]}, "damping": [900, 300, 400, 0.2, 0.4, 0.3]}],
    "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0.2, 0]}, {"name": "c", "position": [2, 0, 0]},
      {"name": "d", "position": [2.5, 1, 0], "rotation": {"axis": [0, 0, 1], "angle": 0.7}},
      {"name": "e", "position": [3, 2, 0], "rotation": {"axis": [1, 0, 0], "angle": 1.5707963267948966}}],
    "bodies": [
      {"name": "block", "mass": 2, "inertia": [[0.1, 0.03, 0], [0.03, 0.2, 0], [0, 0, 0.3]], "center_of_mass": [0.1, -0.05, 0],
       "position": [3, 0, 0]},
      {"name": "slider", "mass": 1, "inertia": [0.01, 0.02, 0.03], "position": [4, 0, 0],
       "rotation": {"axis": [0, 0, 1], "angle": 0.3}},
      {"name": "plate", "mass": 1, "inertia": [0.01, 0.02, 0.03], "position": [5, 1, 0]},
      {"name": "weight", "kind": "point_mass", "mass": 0.4, "position": [0, 3, 0]}],
    "beams": [
      {"name": "one", "section": "bar", "start": "a", "end": "b", "elements": 3, "axis_2": [0, 1, 0]},
      {"name": "two", "section": "damped", "start": "b", "end": "c", "elements": 2, "order": 2, "axis_2": [0, 0, 1]},
      {"name": "three", "section": "damped", "start": "c", "end": "d", "order": 3, "axis_2": [0, 0, -1]},
      {"name": "four", "section": "bar", "start": "d", "end": "e", "elements": 4, "axis_2": [0, 0, 1]}],
    "joints": [
      {"name": "wall", "kind": "fixed", "first": "ground", "second": "a", "position": [0, 0, 0]},
      {"name": "pin", "kind": "revolute", "first": "c", "second": "block", "position": [2.5, 0.1, 0], "axis": [0, 0, -1],
       "forces": [{"stiffness": 3, "rest": 0.2, "damping": 0.5, "effort": 2}]},
      {"name": "rail", "kind": "prismatic", "first": "block", "second": "slider", "position": [3.5, 0, 0], "axis": [1, 0, 0],
       "forces": [{"stiffness": 40, "damping": 3}]},
      {"name": "floor", "kind": "planar", "first": "ground", "second": "plate", "position": [5, 1, 0], "axis": [0, 0, 1]},
      {"name": "ball", "kind": "spherical", "first": "e", "second": "plate", "position": [4, 2, 0]},
      {"name": "tube", "kind": "cylindrical", "first": "slider", "second": "plate", "position": [4.5, 0, 0], "axis": [0, 1, 0]},
      {"name": "crank", "kind": "revolute", "first": "ground", "second": "d", "position": [2.5, 1, 0], "axis": [0, 0, 1],
       "drives": [{"law": 0.4, "rate": true}]}],
    "springs": [{"name": "spring", "stiffness": 100, "damping": 4, "rest_length": 0.5,
                 "first": {"to": "weight"}, "second": {"to": "block", "position": [0, 0.2, 0]}},
                {"name": "tie", "stiffness": 50, "first": {"to": "ground", "position": [0, 5, 0]}, "second": {"to": "weight"}}],
    "bushings": [{"name": "mount", "first": "ground", "second": "slider", "position": [4, 0, 0],
      "stiffness": [900, 800, 700, 60, 50, 40], "damping": [9, 8, 7, 0.6, 0.5, 0.4]}],
    "loads": [
      {"name": "dead", "at": "c", "force": [3, 4, 0], "moment": [0, 0, 2]},
      {"name": "follower", "at": {"to": "block", "position": [0.1, 0.3, 0]}, "axes": "body", "force": [1, -2, 0], "moment": [0, 0, -3]},
      {"name": "snow", "beam": "two", "force": [0, -5, 0]},
      {"name": "pressure", "beam": "four", "axes": "body", "force": [0, 0, 7]}],
    "initial_velocities": [{"of": "weight", "velocity": [0.3, 0.1, 0]}],
    "sensors": [],
    "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.001}})");
}

/// Motions within the plane of `flat`, the same in both.
void stir_in_plane(Rig& flat, Rig& whole) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto any = [&](std::size_t node, double size) {
    double x[6] = {};
    for (double& entry : x) entry = size * uniform(random);
    return flat.plan.unknowns.expanded(x, node);
  };
  for (std::size_t n = 0; n < flat.plan.nodes.size(); ++n) {
    const Vec6<double> eta = any(n, 0.05), v = any(n, 1.0), a = any(n, 10.0);
    for (Rig* rig : {&flat, &whole}) {
      step::move_node(rig->plan, rig->state, n, eta);
      step::set_velocity(rig->plan, rig->state, n, v);
      step::set_acceleration(rig->plan, rig->state, n, a);
    }
  }
  for (std::size_t j = 0; j < flat.plan.joints.size(); ++j)
    for (int row : flat.plan.joints[j].rows)
      flat.state.multipliers[static_cast<std::size_t>(flat.plan.joints[j].multiplier_begin + row)] =
          whole.state.multipliers[static_cast<std::size_t>(whole.plan.joints[j].multiplier_begin + row)] =
              10.0 * uniform(random);
}

double largest_of(const std::vector<double>& v) {
  double most = 0.0;
  for (double x : v) most = std::max(most, std::abs(x));
  return most;
}
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// Energies, momentum, and moment of momentum about the normal of the plane if something turns.
void expect_same_energies(Rig& few, Rig& all) {
  results::EnergyMeter meter_of_few(few.plan), meter_of_all(all.plan);
  const results::Energies a = meter_of_few.eval(few.system, few.state), b = meter_of_all.eval(all.system, all.state);
  const double scale = b.kinetic + b.strain + std::abs(b.potential);
  EXPECT_EQ(b.kinetic > 0.0, all.plan.is_dynamic);
  EXPECT_NEAR(a.kinetic, b.kinetic, 1e-13 * scale);
  EXPECT_NEAR(a.strain, b.strain, 1e-13 * scale);
  EXPECT_NEAR(a.potential, b.potential, 1e-13 * scale);
  const double largest = std::sqrt(lanes::dot(b.momentum, b.momentum));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a.momentum[i], b.momentum[i], 1e-13 * largest);
  if (!few.plan.is_on<motion::Se2>() || !few.plan.is_dynamic) return;
  const Vec3<double> normal = lanes::column(few.plan.axes, 2);
  const double of_few = lanes::dot(lanes::angular_part(a.momentum), normal);
  EXPECT_NE(of_few, 0.0);
  EXPECT_NEAR(of_few, lanes::dot(lanes::angular_part(b.momentum), normal), 1e-13 * largest);
}

void compare(const scene::Scene& scene, const elements::Slopes& slopes) {
  scene::Scene spatial = scene;
  spatial.without = {"planar"};
  Rig flat(scene), whole(spatial);
  ASSERT_TRUE(decision(flat.plan, "planar").taken) << decision(flat.plan, "planar").reason;
  ASSERT_TRUE(flat.plan.is_on<motion::Se2>());
  ASSERT_FALSE(whole.plan.is_on<motion::Se2>());
  EXPECT_TRUE(decision(whole.plan, "planar").barred);
  stir_in_plane(flat, whole);
  for (Rig* rig : {&flat, &whole}) {
    ASSERT_FALSE(rig->system.set_time(0.03));
    ASSERT_FALSE(rig->system.evaluate(rig->state, slopes, true));
  }
  expect_same_energies(flat, whole);
  // The residual in space has no part out of the plane, and the part in it is that of the planar elements.
  const std::vector<double> residual = expand(flat, whole, flat.system.right_hand_side());
  EXPECT_LT(largest_difference(residual, whole.system.right_hand_side()), 1e-12 * largest_of(residual));
  // So for the tangent, column by column.
  std::vector<double> x(flat.system.places().size(), 0.0), product(x.size()), other(whole.system.places().size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = 1.0;
    flat.system.linear().multiply(x.data(), product.data());
    const std::vector<double> wide = expand(flat, whole, x), expected = expand(flat, whole, product);
    whole.system.linear().multiply(wide.data(), other.data());
    EXPECT_LT(largest_difference(expected, other), 1e-12 * largest_of(expected)) << "column " << i;
    x[i] = 0.0;
  }
}

scene::Frame oblique() {
  const Vec3<double> turn{{0.4, -0.7, 1.1}};
  return {motion::exp_so3(turn), {{20.0, -3.0, 7.0}}};
}

TEST(PlanarElements, are_those_in_space_within_the_plane) {
  compare(flat_scene(), {120.0, 2.0e4, false});
  compare(support::moved(flat_scene(), oblique()), {120.0, 2.0e4, false});
}

/// Enough equal links that their elements run in lockstep.
scene::Scene chain(int links) {
  std::string nodes, beams, joints;
  const auto x = [](int i) { return "[" + std::to_string(i) + ", 0, 0]"; };
  for (int l = 0; l < links; ++l) {
    const std::string n = std::to_string(l), comma = l > 0 ? "," : "";
    nodes += comma + R"({"name": "a)" + n + R"(", "position": )" + x(l) + R"(}, {"name": "b)" + n +
             R"(", "position": )" + x(l + 1) + "}";
    beams += comma + R"({"name": "link )" + n + R"(", "section": "bar", "start": "a)" + n + R"(", "end": "b)" + n +
             R"(", "elements": 4})";
    joints += comma + R"({"name": "hinge )" + n + R"(", "kind": "revolute", "first": ")" +
              (l == 0 ? "ground" : "b" + std::to_string(l - 1)) + R"(", "second": "a)" + n + R"(", "position": )" +
              x(l) + R"(, "axis": [0, 1, 0]})";
  }
  return support::scene_of(
      R"({"gravity": [0, 0, -9.81],
    "materials": [{"name": "steel", "young": 2.1e11, "poisson": 0.3, "density": 7850}],
    "sections": [{"name": "bar", "shape": {"kind": "rectangle", "width": 0.02, "height": 0.02}, "material": "steel"}],
    "nodes": [)" +
      nodes + R"(], "beams": [)" + beams + R"(], "joints": [)" + joints +
      R"(], "sensors": [{"name": "energy", "kind": "total_energy"}, {"name": "end", "kind": "acceleration", "at": "b1"}],
    "analysis": {"kind": "dynamic", "end_time": 0.02, "step_size": 0.001}})");
}

TEST(PlanarElements, are_those_in_space_in_lockstep) { compare(chain(32), {120.0, 2.0e4, false}); }

class Rows final : public records::Recorder {
 public:
  std::vector<std::vector<double>> values;
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow& row) override { values.push_back(row.values); }
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
};

TEST(PlanarElements, give_the_same_bits_on_any_number_of_threads) {
  Rows one, three;
  scene::Scene s = chain(32);
  s.without = {"small"};
  ASSERT_EQ(simulate(s, {}, one).status, records::RunStatus::ok);
  SimulateOptions options;
  options.threads = 3;
  simulate(s, options, three);
  EXPECT_EQ(one.values.size(), 21u);
  EXPECT_EQ(one.values, three.values);
}

TEST(PlanarElements, are_those_in_space_where_accelerations_are_sought) {
  compare(support::moved(flat_scene(), oblique()), {0.0, 0.0, true});
}

TEST(PlanarElements, are_those_in_space_in_statics) {
  scene::Scene s = support::moved(flat_scene(), oblique());
  s.analysis.kind = scene::AnalysisKind::statics;
  compare(s, {});
}

TEST(Unknowns, of_a_plane_are_three_a_node_and_the_rows_that_hold_in_it) {
  const Rig rig(flat_scene());
  EXPECT_EQ(rig.plan.unknowns.motions, plan::Motions::planar);
  const auto rows = [&rig](const std::string& name) {
    for (const plan::JointPlan& j : rig.plan.joints)
      if (j.name == name) return j.rows.size();
    return std::size_t{99};
  };
  EXPECT_EQ(rows("wall"), 3u);
  EXPECT_EQ(rows("pin"), 2u);
  EXPECT_EQ(rows("rail"), 2u);
  EXPECT_EQ(rows("floor"), 0u);
  EXPECT_EQ(rows("ball"), 2u);
  EXPECT_EQ(rows("tube"), 2u);
  EXPECT_EQ(rows("crank"), 3u);  // two displacements and the angle that is driven
  EXPECT_EQ(rig.system.places().size(),
            3 * (rig.plan.nodes.size() - 1) - 1 + 2 + 2 + 2 + 2 + 3);  // of all but the wall; the mass does not turn
}

/// What stands against the plane where one thing leaves it.
std::string reason(const std::function<void(scene::Scene&)>& change, const std::string& name = "planar") {
  scene::Scene s = flat_scene();
  change(s);
  const plan::Plan p = plan::make_plan(s);
  EXPECT_TRUE(p.unknowns.is_whole());
  EXPECT_FALSE(decision(p, name).taken);
  return decision(p, name).reason;
}

TEST(Unknowns, are_six_with_a_reason_where_something_leaves_the_plane) {
  using scene::Scene;
  EXPECT_EQ(reason([](Scene& s) { s.gravity[2] = 1e-6; }), "gravity acts out of the plane");
  EXPECT_EQ(reason([](Scene& s) { s.bodies[3].placement.pose.x[2] = 1e-6; }), "'weight': it lies outside the plane");
  EXPECT_EQ(reason([](Scene& s) { s.bodies[0].center_of_mass[2] = 1e-6; }),
            "'block': its mass is not symmetric about the plane (centre of mass, principal axes)");
  EXPECT_EQ(reason([](Scene& s) { s.bodies[0].inertia(0, 2) = s.bodies[0].inertia(2, 0) = 1e-6; }),
            "'block': its mass is not symmetric about the plane (centre of mass, principal axes)");
  EXPECT_EQ(reason([](Scene& s) { s.beams[0].twist = 0.1; }), "'one': it is twisted");
  EXPECT_EQ(reason([](Scene& s) {
              s.sections[0].stiffness(0, 5) = s.sections[0].stiffness(5, 0) = 10.0;
              s.sections[0].stiffness(0, 4) = s.sections[0].stiffness(4, 0) = 10.0;
            }),
            "'one': its section couples bending in the plane with other strains");
  EXPECT_EQ(reason([](Scene& s) { s.point_loads[0].force[2] = 1e-6; }), "'dead': its force acts out of the plane");
  EXPECT_EQ(reason([](Scene& s) { s.point_loads[1].moment[0] = 1e-6; }),
            "'follower': its moment acts out of the plane");
  EXPECT_EQ(reason([](Scene& s) { s.initial_velocities[0].velocity[2] = 1e-6; }),
            "'weight': it starts out of the plane");
  EXPECT_EQ(reason([](Scene& s) { s.couplings[0].second.offset.x[2] = 1e-6; }),
            "'spring': it takes hold outside the plane");
  EXPECT_EQ(reason([](Scene& s) { s.joints[4].kind = scene::JointKind::screw; }), "'ball': it is a screw");
  EXPECT_EQ(reason([](Scene& s) {
              const std::span<double> K = support::values_of(s.couplings.back(), "stiffness");
              K[2] = K[12] = 1e-3;
            }),
            "'mount': its stiffness or damping couples motions in the plane with others");
}

/// Two systems of one scene, the second in space: motions after 20 steps. Both see rounded places, to which stiff
/// elements answer by EA / L eps |x| = 7.5e-7 N.
void expect_same_steps(scene::Scene scene, double h, double tolerance) {
  scene.analysis.tolerance = 1e-12;
  Rig flat(scene);
  scene.without = {"planar"};
  Rig whole(scene);
  ASSERT_TRUE(flat.plan.is_on<motion::Se2>());
  ASSERT_FALSE(whole.plan.is_on<motion::Se2>());
  for (Rig* rig : {&flat, &whole}) {
    ASSERT_TRUE(step::make_consistent(rig->system, rig->state, true, h).ok);
    EXPECT_GE(test::take_steps(*rig, h), 20);
  }
  double speed = 1.0;
  for (const elements::NodeMotion& n : whole.nodes()) speed = std::max(speed, largest_of({n.v.v, n.v.v + 6}));
  for (std::size_t n = 0; n < flat.plan.nodes.size(); ++n) {
    const elements::NodeMotion &a = flat.nodes()[n], &b = whole.nodes()[n];
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a.x.hi[i], b.x.hi[i], tolerance) << flat.plan.nodes[n].name;
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(a.v[i], b.v[i], tolerance * speed) << flat.plan.nodes[n].name;
  }
}

TEST(PlanarSteps, are_those_in_space_by_every_integrator) {
  for (const scene::Integrator integrator :
       {scene::Integrator::generalized_alpha, scene::Integrator::bdf, scene::Integrator::variational})
    for (const bool is_oblique : {false, true}) {
      SCOPED_TRACE(static_cast<int>(integrator));
      scene::Scene s = is_oblique ? support::moved(flat_scene(), oblique()) : flat_scene();
      s.analysis.integrator = integrator;
      expect_same_steps(s, 1e-3, 1e-9);
      s = is_oblique ? support::moved(chain(3), oblique()) : chain(3);
      s.analysis.integrator = integrator;
      expect_same_steps(s, 1e-4, 1e-9);
    }
}

TEST(PlanarSteps, keep_momenta_by_the_variational_integrator) {
  scene::Scene s = flat_scene();
  s.joints.clear();
  s.motions.clear();
  s.point_loads.clear();
  s.line_loads.clear();
  s.couplings.clear();
  s.gravity = Vec3<double>::zero();
  s.analysis.integrator = scene::Integrator::variational;
  Rig rig(s);
  ASSERT_TRUE(rig.plan.is_on<motion::Se2>());
  ASSERT_TRUE(step::make_consistent(rig.system, rig.state, true, 1e-3).ok);
  results::EnergyMeter meter(rig.plan);
  const Vec6<double> before = meter.eval(rig.system, rig.state).momentum;
  EXPECT_GE(test::take_steps(rig, 1e-3), 20);
  const Vec6<double> after = meter.eval(rig.system, rig.state).momentum;
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(after[i], before[i], 1e-12);
  EXPECT_GT(std::abs(before[0]), 0.1);
}

scene::Scene masses(const std::string& second) {
  return support::scene_of(R"({
    "gravity": [0, 0, -9.81],
    "bodies": [{"name": "upper", "kind": "point_mass", "mass": 1, "position": [0, 0, -1]},
               {"name": "lower", "kind": "point_mass", "mass": 2, "position": )" +
                           second + R"(}],
    "springs": [{"name": "a", "stiffness": 100, "first": {"to": "ground"}, "second": {"to": "upper"}},
                {"name": "b", "stiffness": 200, "damping": 1, "first": {"to": "upper"}, "second": {"to": "lower"}}],
    "sensors": [{"name": "lower", "kind": "position", "at": "lower"}],
    "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 0.001}})");
}

TEST(Unknowns, of_point_masses_on_a_line_are_one_each) {
  const Rig rig(masses("[0, 0, -2]"));
  EXPECT_EQ(rig.plan.unknowns.motions, plan::Motions::line);
  EXPECT_EQ(rig.system.places().size(), 2u);
  EXPECT_TRUE(decision(rig.plan, "translation").reason.find("nothing turns") != std::string::npos);
  EXPECT_FALSE(decision(rig.plan, "translation").taken);
}

TEST(Unknowns, of_point_masses_are_three_each) {
  const Rig rig(masses("[0.5, 0.2, -2]"));
  EXPECT_EQ(rig.plan.unknowns.motions, plan::Motions::translation);
  EXPECT_EQ(rig.system.places().size(), 6u);
  EXPECT_EQ(decision(rig.plan, "line").reason, "'a': it takes hold off the line");
}

TEST(Unknowns, of_point_masses_give_the_energies_in_space) {
  for (const std::string where : {"[0, 0, -2]", "[0.5, 0.2, -2]"}) {
    SCOPED_TRACE(where);
    scene::Scene s = support::moved(masses(where), oblique());
    Rig few(s);
    ASSERT_FALSE(few.plan.is_on<motion::Se3>());
    s.without = {"line", "translation", "planar"};
    Rig all(s);
    ASSERT_TRUE(all.plan.is_on<motion::Se3>());
    for (std::size_t n = 0; n < few.plan.nodes.size(); ++n) {
      const double x[] = {0.1, -0.2, 0.3}, v[] = {-0.7, 0.5, 0.9};
      const Vec6<double> eta = few.plan.unknowns.expanded(x, n), velocity = few.plan.unknowns.expanded(v, n);
      for (Rig* rig : {&few, &all}) {
        step::move_node(rig->plan, rig->state, n, eta);
        step::set_velocity(rig->plan, rig->state, n, velocity);
        ASSERT_FALSE(rig->system.set_time(0.0));
      }
    }
    expect_same_energies(few, all);
  }
}

TEST(Unknowns, fewer_give_the_same_motion) {
  for (const std::string where : {"[0, 0, -2]", "[0.5, 0, -2]", "[0.5, 0.2, -2]"}) {
    scene::Scene s = masses(where);
    s.analysis.tolerance = 1e-12;
    const support::Outcome few = support::run(s);
    s.without = {"line", "translation", "planar"};
    const support::Outcome all = support::run(s);
    ASSERT_TRUE(few.ok() && all.ok());
    for (const char* column : {"lower.x", "lower.y", "lower.z"})
      EXPECT_LT(support::largest_difference(few.history, column, all.history, column), 1e-12) << where << column;
  }
}

}  // namespace
}  // namespace bough::run
