/// Loads, supports and what is read off them: closed forms at small displacement, equilibrium at large.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bough/laws/make_law.hpp"
#include "support/given.hpp"
#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

using std::numbers::pi;
constexpr scene::LoadAxes space = scene::LoadAxes::space, body = scene::LoadAxes::body;

Vec3<double> vector_of(const Outcome& o, const std::string& sensor, const char* const (&names)[3]) {
  return {{o.final(sensor + "." + names[0]), o.final(sensor + "." + names[1]), o.final(sensor + "." + names[2])}};
}
Vec3<double> point(const Outcome& o, const std::string& s) { return vector_of(o, s, {"x", "y", "z"}); }
Vec3<double> force(const Outcome& o, const std::string& s) { return vector_of(o, s, {"fx", "fy", "fz"}); }
Vec3<double> moment(const Outcome& o, const std::string& s) { return vector_of(o, s, {"mx", "my", "mz"}); }
Vec3<double> turn(const Outcome& o, const std::string& s) { return vector_of(o, s, {"rx", "ry", "rz"}); }

void expect_near(const Vec3<double>& a, const Vec3<double>& b, double tolerance, const std::string& what) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << what << ", component " << i;
}

scene::Scene soft_cantilever(int elements = 8, int order = 3) {
  scene::Scene s = scene::make_cantilever(scene::make_section("s", 4e5, 2e5, 3e5, 50, 80, 120), 2.0, elements, order);
  s.analysis.load_steps = 4;
  s.analysis.tolerance = 1e-11;
  return s;
}

/// All six resultants by the convention that what lies beyond the section acts on what lies before it:
///   N = F1, Q = (F2, F3), T = M1 and M2 = M2tip - (L - x) F3, M3 = M3tip + (L - x) F2, with q on the rest of the
///     length.
TEST(VerifyStatics, section_forces_at_the_nodes_under_tip_and_line_loads) {
  const double L = 2.0, tiny = 1e-6;
  const Vec3<double> F = tiny * Vec3<double>{{3, 2, -5}}, M = tiny * Vec3<double>{{0.7, 0.3, -0.4}},
                     q = tiny * Vec3<double>{{1, -4, 6}};
  for (int order = 1; order <= 3; ++order) {
    // Axially as soft as in bending: the round-off of positions times EA stays below the small forces.
    scene::Scene s = scene::make_cantilever(scene::make_section("s", 400, 200, 300, 50, 80, 120), L, 4, order);
    s.analysis.tolerance = 1e-11;
    s.point_loads = {scene::make_load("tip", F, M)};
    scene::LineLoad line;
    line.name = "line";
    line.beam = "beam";
    line.force = q;
    s.line_loads = {line};
    for (const int k : {0, 1, 2, 3, 4})
      s.sensors.push_back(scene::make_section_sensor("at " + std::to_string(k), "beam", 0.25 * k));
    const Outcome o = run(s);
    ASSERT_TRUE(o.ok()) << o.text();
    for (const int k : {0, 1, 2, 3, 4}) {
      const std::string at = "at " + std::to_string(k);
      const double r = L * (1.0 - 0.25 * k);
      // Displacements are of the order of tiny, so the change of the geometry stays below 1e-6 of the forces.
      const double tolerance = 1e-6 * tiny * 10.0;
      expect_near(vector_of(o, at, {"N", "Q2", "Q3"}), F + r * q, tolerance, at);
      const Vec3<double> m{{M[0], M[1] - r * F[2] - 0.5 * r * r * q[2], M[2] + r * F[1] + 0.5 * r * r * q[1]}};
      expect_near(vector_of(o, at, {"T", "M2", "M3"}), m, tolerance, at);
    }
  }
}

/// w = q L^4 / (8 EI) + q L^2 / (2 GA), dead or following, in both planes; end slope q L^3 / (6 EI).
TEST(VerifyStatics, uniform_line_load_bends_a_cantilever_by_the_closed_form) {
  const double L = 2.0, q = 1e-5;
  for (const scene::LoadAxes axes : {space, body})
    for (int order = 2; order <= 3; ++order) {
      scene::Scene s = soft_cantilever(4, order);
      scene::LineLoad line;
      line.name = "line";
      line.beam = "beam";
      line.axes = axes;
      line.force = {{0, q, -2 * q}};
      s.line_loads = {line};
      const Outcome o = run(s);
      ASSERT_TRUE(o.ok()) << o.text();
      const Vec3<double> tip = point(o, "tip"), slope = turn(o, "turn");
      const double w2 = q * std::pow(L, 4) / (8 * 120) + q * L * L / (2 * 2e5),
                   w3 = -2 * q * std::pow(L, 4) / (8 * 80) - 2 * q * L * L / (2 * 3e5);
      EXPECT_NEAR(tip[1] / w2, 1.0, 1e-8) << order;
      EXPECT_NEAR(tip[2] / w3, 1.0, 1e-8) << order;
      EXPECT_NEAR(slope[2] / (q * L * L * L / (6 * 120)), 1.0, 1e-8) << order;
      EXPECT_NEAR(slope[1] / (2 * q * L * L * L / (6 * 80)), 1.0, 1e-8) << order;
    }
}

TEST(VerifyStatics, elements_of_every_order_carry_the_parabola_of_a_line_load_between_their_nodes) {
  const double L = 2.0, q = 1e-5;
  for (int order = 1; order <= 3; ++order) {
    scene::Scene s = soft_cantilever(2, order);
    scene::LineLoad line;
    line.name = "line";
    line.beam = "beam";
    line.force = {{0, q, 0}};
    s.line_loads = {line};
    for (int k = 0; k <= 4; ++k)
      s.sensors.push_back(scene::make_section_sensor("at " + std::to_string(k), "beam", 0.125 * k));
    const Outcome o = run(s);
    ASSERT_TRUE(o.ok()) << o.text();
    for (int k = 0; k <= 4; ++k) {
      const double left = L * (1.0 - 0.125 * k), M = 0.5 * q * left * left;
      const double difference = std::abs(o.final("at " + std::to_string(k) + ".M3") - M) / (0.5 * q * L * L);
      EXPECT_LT(difference, 1e-8) << order << ", station " << k;
    }
  }
}

TEST(VerifyStatics, own_weight_bends_like_a_line_load_and_is_carried_by_the_clamp) {
  scene::Scene s = soft_cantilever(4, 3);
  scene::set_mass(s.sections[0], 3.0, 0.1, 0.05, 0.05);
  s.gravity = {{0, 0, -9.81e-6}};
  const Outcome o = run(s);
  ASSERT_TRUE(o.ok()) << o.text();
  const double q = -3.0 * 9.81e-6;
  EXPECT_NEAR(point(o, "tip")[2] / (q * 16 / (8 * 80) + q * 4 / (2 * 3e5)), 1.0, 1e-7);
  EXPECT_NEAR(force(o, "clamp")[2] / (-q * 2), 1.0, 1e-9);
}

/// The clamp's reaction is the wrench of the ground on the root: minus the loads, at any displacement.
TEST(VerifyStatics, reactions_balance_the_loads_at_large_displacement) {
  scene::Scene s = soft_cantilever();
  const Vec3<double> F{{-20, 60, 35}}, M{{10, -20, 5}};
  s.point_loads = {scene::make_load("tip", F, M)};
  s.sensors.push_back(scene::make_section_sensor("root", "beam", 0.0));
  const Outcome o = run(s);
  ASSERT_TRUE(o.ok()) << o.text();
  const Vec3<double> tip = point(o, "tip"), at_root = M + lanes::cross(tip, F);
  EXPECT_GT(std::abs(tip[1]), 0.5);
  expect_near(force(o, "clamp"), -F, 1e-8 * 60, "force");
  expect_near(moment(o, "clamp"), -at_root, 1e-8 * 100, "moment");
  expect_near(vector_of(o, "root", {"N", "Q2", "Q3"}), F, 1e-8 * 60, "root section");
  expect_near(vector_of(o, "root", {"T", "M2", "M3"}), at_root, 1e-8 * 100, "root section");
}

/// A follower load that ended up turned by R is the dead load R F at the same equilibrium; so is a moment.
TEST(VerifyStatics, follower_loads_are_dead_loads_turned_with_the_tip) {
  scene::Scene s = soft_cantilever();
  const Vec3<double> F{{0, 40, 25}}, M{{8, 0, 30}};
  s.point_loads = {scene::make_load("tip", F, M, body)};
  s.analysis.load_steps = 10;
  const Outcome follower = run(s);
  ASSERT_TRUE(follower.ok()) << follower.text();
  const motion::Mat3<double> R = motion::exp_so3(turn(follower, "turn"));
  s.point_loads = {scene::make_load("tip", R * F, R * M, space)};
  const Outcome dead = run(s);
  ASSERT_TRUE(dead.ok()) << dead.text();
  expect_near(point(dead, "tip"), point(follower, "tip"), 1e-8, "tip");
  expect_near(turn(dead, "turn"), turn(follower, "turn"), 1e-8, "turn");
  s.point_loads = {scene::make_load("tip", F, M, space)};
  const Outcome other = run(s);
  ASSERT_TRUE(other.ok()) << other.text();
  EXPECT_GT(std::abs(point(other, "tip")[1] - point(follower, "tip")[1]), 0.01)
      << "the two kinds differ where the tip turns";
}

TEST(VerifyStatics, a_load_beside_a_node_is_the_load_and_its_moment) {
  scene::Scene s = soft_cantilever();
  const Vec3<double> F{{5, 20, -10}}, arm{{0.1, 0.2, -0.3}};
  scene::PointLoad beside = scene::make_load("tip", F, Vec3<double>::zero(), body);
  beside.at.offset.x = arm;
  s.point_loads = {beside};
  const Outcome a = run(s);
  s.point_loads = {scene::make_load("tip", F, lanes::cross(arm, F), body)};
  const Outcome b = run(s);
  ASSERT_TRUE(a.ok() && b.ok()) << a.text() << b.text();
  expect_near(point(a, "tip"), point(b, "tip"), 1e-9, "tip");
}

/// Driving the tip to where a load of 10 EI/L^2 brought it takes that load.
TEST(VerifyStatics, prescribed_displacement_returns_the_load_that_causes_it) {
  scene::Scene s = scene::make_cantilever(scene::make_section("s", 1e6, 1e6, 1e6, 1, 1, 1), 1.0, 10, 3);
  s.analysis.load_steps = 10;
  s.analysis.tolerance = 1e-11;
  s.point_loads = {scene::make_load("tip", {{0, 10, 0}})};
  const Outcome loaded = run(s);
  ASSERT_TRUE(loaded.ok()) << loaded.text();
  s.point_loads.clear();
  scene::PrescribedMotion m;
  m.name = "drive";
  m.at.to = "tip";
  m.displacement[1] = laws::make_ramp(0, 1, 0, point(loaded, "tip")[1]);
  s.motions = {m};
  const Outcome driven = run(s);
  ASSERT_TRUE(driven.ok()) << driven.text();
  expect_near(point(driven, "tip"), point(loaded, "tip"), 1e-9, "tip");
  EXPECT_NEAR(force(driven, "clamp")[1], -10.0, 1e-6);
}

/// Turning the tip twice around rolls the beam up twice; the torque is EI 4 pi / L. The other bending stiffness has
/// to differ: after one turn of a round rod any axis across it would do as well, and the tangent is truly singular.
TEST(VerifyStatics, prescribed_rotation_counts_turns) {
  scene::Scene s = scene::make_cantilever(scene::make_section("s", 1e4, 1e4, 1e4, 20, 20, 2), 1.0, 10, 1);
  s.analysis.load_steps = 8;
  scene::PrescribedMotion m;
  m.name = "drive";
  m.at.to = "tip";
  m.rotation_axis = Vec3<double>::unit(2);
  m.angle = laws::make_ramp(0, 1, 0, 4 * pi);
  s.motions = {m};
  const Outcome o = run(s);
  ASSERT_TRUE(o.ok()) << o.text();
  expect_near(point(o, "tip"), Vec3<double>::zero(), 1e-9, "tip meets the root");
  EXPECT_NEAR(moment(o, "clamp")[2], -2 * 4 * pi, 1e-7);
}

/// Simply supported beam under its uniform load: half of it at each end, q L^2 / 8 in the middle, 5 q L^4 / (384 EI)
/// + q L^2 / (8 GA).
TEST(VerifyStatics, a_beam_on_a_hinge_and_a_slider) {
  const double q = 1e-5, L = 2.0;
  scene::Scene s = soft_cantilever(4, 3);
  scene::Joint hinge = s.joints[0];
  hinge.name = "hinge";
  hinge.kind = scene::JointKind::revolute;
  s.joints = {hinge};
  scene::PrescribedMotion slider;  // free along x and about z
  slider.name = "slider";
  slider.at.to = "tip";
  slider.displacement[1] = laws::make_constant(0.0);
  slider.displacement[2] = laws::make_constant(0.0);
  s.motions = {slider};
  scene::LineLoad line;
  line.name = "line";
  line.beam = "beam";
  line.force = {{0, -q, 0}};
  s.line_loads = {line};
  s.sensors = {scene::make_joint_sensor("hinge", "hinge"), scene::make_section_sensor("middle", "beam", 0.5),
               scene::make_section_sensor("left", "beam", 0.0), scene::make_section_sensor("right", "beam", 1.0),
               scene::make_joint_sensor("angle", "hinge", scene::SensorKind::joint_angle)};
  scene::Sensor sag = scene::make_point_sensor("sag", scene::SensorKind::position, "");
  sag.beam = "beam";
  sag.station = 0.5;
  s.sensors.push_back(sag);
  const Outcome o = run(s);
  ASSERT_TRUE(o.ok()) << o.text();
  EXPECT_NEAR(o.final("hinge.fy"), q * L / 2, 1e-8 * q);
  EXPECT_NEAR(o.final("left.Q2"), -q * L / 2, 1e-6 * q);  // what lies beyond pulls down
  EXPECT_NEAR(o.final("right.Q2"), q * L / 2, 1e-6 * q);
  EXPECT_NEAR(o.final("middle.M3"), q * L * L / 8, 1e-6 * q);
  EXPECT_NEAR(o.final("left.M3"), 0.0, 1e-8 * q);
  EXPECT_NEAR(o.final("sag.y") / -(5 * q * std::pow(L, 4) / (384 * 120) + q * L * L / (8 * 2e5)), 1.0, 1e-6);
  EXPECT_NEAR(o.final("angle") / -(q * L * L * L / (24 * 120)), 1.0, 1e-6);
}

/// A body in a bushing: each stiffness alone answers each load alone; a turn by M / k is exact at any angle.
TEST(VerifyStatics, bushings_answer_with_their_stiffness) {
  scene::Scene s;
  scene::Body b;
  b.name = "block";
  b.mass = 2.0;
  b.inertia = motion::Mat3<double>::identity();
  s.bodies = {b};
  support::GivenBushing k;
  k.name = "mount";
  k.second.to = "block";
  const double diagonal[6] = {100, 200, 300, 10, 20, 30};
  for (int i = 0; i < 6; ++i) k.stiffness(i, i) = diagonal[i];
  s.couplings = {k};
  s.analysis.kind = scene::AnalysisKind::statics;
  s.sensors = {scene::make_point_sensor("at", scene::SensorKind::position, "block"),
               scene::make_point_sensor("turn", scene::SensorKind::rotation, "block")};
  for (int i = 0; i < 3; ++i) {
    s.point_loads = {scene::make_load("block", 50.0 * Vec3<double>::unit(i))};
    Outcome o = run(s);
    ASSERT_TRUE(o.ok()) << o.text();
    expect_near(point(o, "at"), (50.0 / diagonal[i]) * Vec3<double>::unit(i), 1e-10, "displacement");
    s.point_loads = {scene::make_load("block", Vec3<double>::zero(), (2.0 * diagonal[3 + i]) * Vec3<double>::unit(i))};
    s.analysis.load_steps = 4;
    o = run(s);
    ASSERT_TRUE(o.ok()) << o.text();
    expect_near(turn(o, "turn"), 2.0 * Vec3<double>::unit(i), 1e-10, "rotation of 2 rad");
  }
  s.point_loads.clear();
  s.gravity = {{0, 0, -9.81}};
  const Outcome o = run(s);
  ASSERT_TRUE(o.ok()) << o.text();
  EXPECT_NEAR(o.final("at.z"), -2.0 * 9.81 / 300, 1e-10);
}

/// A mass on three springs of a tripod: 3 k (l - l0) sin(angle) = weight, solved here by bisection.
TEST(VerifyStatics, springs_carry_a_weight) {
  const double k = 500.0, rest = 1.0, weight = 40.0;
  scene::Scene s;
  scene::Body b;
  b.name = "weight";
  b.is_point_mass = true;
  b.mass = weight / 10.0;
  b.placement.pose.x = {{0, 0, -0.6}};
  s.bodies = {b};
  for (int i = 0; i < 3; ++i) {
    support::GivenSpring spring;
    spring.name = "spring " + std::to_string(i);
    spring.first.offset.x = {{0.8 * std::cos(2 * pi * i / 3), 0.8 * std::sin(2 * pi * i / 3), 0.0}};
    spring.second.to = "weight";
    spring.stiffness = k;
    spring.rest_length = rest;
    s.couplings.push_back(spring);
  }
  s.gravity = {{0, 0, -10}};
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.load_steps = 4;
  s.sensors = {scene::make_point_sensor("at", scene::SensorKind::position, "weight")};
  const Outcome o = run(s);
  ASSERT_TRUE(o.ok()) << o.text();
  double low = 0.6, high = 2.0;
  for (int i = 0; i < 100; ++i) {
    const double z = 0.5 * (low + high), l = std::hypot(0.8, z);
    (3 * k * (l - rest) * z / l < weight ? low : high) = z;
  }
  expect_near(point(o, "at"), {{0, 0, -low}}, 1e-10, "place");
}

/// Torsion spring of a hinge: a dead weight on an arm, k theta = m g a cos(theta).
TEST(VerifyStatics, a_joint_spring_holds_an_arm) {
  scene::Scene s;
  scene::Body b;
  b.name = "arm";
  b.mass = 3.0;
  b.inertia = motion::Mat3<double>::identity();
  b.center_of_mass = {{0.5, 0, 0}};
  s.bodies = {b};
  scene::Joint hinge = scene::make_weld("hinge", "arm");
  hinge.kind = scene::JointKind::revolute;
  scene::JointForce spring;
  spring.coordinate = "angle";
  spring.stiffness = 12.0;
  hinge.forces = {spring};
  s.joints = {hinge};
  s.gravity = {{0, -9.81, 0}};
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.load_steps = 3;
  s.sensors = {scene::make_joint_sensor("angle", "hinge", scene::SensorKind::joint_angle),
               scene::make_joint_sensor("hinge", "hinge")};
  const Outcome o = run(s);
  ASSERT_TRUE(o.ok()) << o.text();
  double theta = 0.5;
  for (int i = 0; i < 200; ++i)
    theta -= (12.0 * theta - 3.0 * 9.81 * 0.5 * std::cos(theta)) / (12.0 + 3.0 * 9.81 * 0.5 * std::sin(theta));
  EXPECT_NEAR(o.final("angle"), -theta, 1e-9);
  EXPECT_NEAR(o.final("hinge.fy"), 3.0 * 9.81, 1e-7);
}

/// Space frame of two legs at a right angle: its own finest mesh is the reference.
TEST(VerifyStatics, right_angle_frame_converges_with_orders_2_4_6) {
  const auto tip = [](int elements, int order) {
    scene::Scene s;
    s.sections = {scene::make_section("s", 1e6, 1e6, 1e6, 1e3, 1e3, 1e3)};
    s.nodes = {scene::make_node("root", {{0, 0, 0}}), scene::make_node("corner", {{10, 0, 0}}),
               scene::make_node("tip", {{10, 10, 0}})};
    s.beams = {scene::make_beam("first leg", "s", "root", "corner", elements, order),
               scene::make_beam("second leg", "s", "corner", "tip", elements, order)};
    s.beams[1].axis_2 = {{-1, 0, 0}};
    s.joints = {scene::make_weld("clamp", "root")};
    s.point_loads = {scene::make_load("tip", {{3, -2, 12}})};
    s.sensors = {scene::make_point_sensor("tip", scene::SensorKind::position, "tip")};
    s.analysis.kind = scene::AnalysisKind::statics;
    s.analysis.load_steps = 4;
    s.analysis.tolerance = 1e-11;
    const Outcome o = run(s);
    EXPECT_TRUE(o.ok()) << o.text();
    return o.ok() ? point(o, "tip") : Vec3<double>::zero();
  };
  const auto size = [](const Vec3<double>& d) { return std::sqrt(lanes::dot(d, d)); };
  const Vec3<double> exact = tip(32, 3);
  const int coarsest[] = {16, 4, 3};
  for (int order = 1; order <= 3; ++order) {
    const int n = coarsest[order - 1];
    const Vec3<double> a = tip(n, order), b = tip(2 * n, order), c = tip(4 * n, order);
    const double p = observed_order(size(a - b), size(b - c)), factor = std::pow(2.0, 2.0 * order);
    const double finest = size(c - exact), extrapolated = size(c + (1.0 / (factor - 1.0)) * (c - b) - exact);
    std::printf("  order %d: observed %.3f, finest %.2e, extrapolated %.2e\n", order, p, finest / 10,
                extrapolated / 10);
    EXPECT_NEAR(p, 2.0 * order, 0.2) << order;
    EXPECT_LT(std::min(finest, extrapolated), 1e-6 * 10) << order;
  }
}

}  // namespace
}  // namespace bough::verify
