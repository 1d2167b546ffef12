// Scenes that a program may build without a file: the checks stand on their own.
#include "bough/scene/problems.hpp"

#include <gtest/gtest.h>

#include "bough/laws/make_law.hpp"
#include "bough/motion/se3.hpp"
#include "bough/scene/parts.hpp"

namespace bough::scene {
namespace {

/// A cantilever in statics: good.
Scene cantilever() {
  Scene s;
  Section section;
  section.name = "section";
  section.stiffness = section.mass = section.damping = Mat6::zero();
  for (int i = 0; i < 6; ++i) section.stiffness(i, i) = section.mass(i, i) = 1.0;
  s.sections = {section};
  s.nodes = {{"root", {}}, {"tip", {{Mat3::identity(), {{1, 0, 0}}}, ""}}};
  Beam b;
  b.name = "beam";
  b.section = "section";
  b.start = "root";
  b.end = "tip";
  s.beams = {b};
  Joint j;
  j.name = "clamp";
  j.second.to = "root";
  s.joints = {j};
  s.analysis.kind = AnalysisKind::statics;
  return s;
}

/// "section index key" of each problem.
std::vector<std::string> places(const Scene& s, std::vector<std::string> defective = {}) {
  std::vector<std::string> r;
  for (const SceneProblem& p : problems_in(s, defective))
    r.push_back((p.is_warning ? "warning " : "") + p.section + " " + std::to_string(p.index) + " " + p.key);
  return r;
}

using Places = std::vector<std::string>;

TEST(SceneProblems, a_cantilever_has_none) { EXPECT_EQ(places(cantilever()), Places{}); }

TEST(SceneProblems, what_names_a_defective_thing_is_not_reported) {
  Scene s = cantilever();
  s.beams[0].section = "lost";
  EXPECT_EQ(places(s), (Places{"beams 0 section", "warning sections 0 name"}));
  EXPECT_EQ(places(s, {"lost"}), (Places{}));
}

TEST(SceneProblems, a_static_scene_that_nothing_holds_is_warned_about) {
  Scene s = cantilever();
  s.joints.clear();
  EXPECT_EQ(places(s), (Places{"warning nodes 0 name"}));
}

TEST(SceneProblems, dynamics_needs_mass_and_a_spectral_radius_below_one) {
  Scene s = cantilever();
  s.analysis.kind = AnalysisKind::dynamics;
  s.analysis.end_time = 1.0;
  s.analysis.spectral_radius = 1.0;
  s.joints[0].kind = JointKind::revolute;  // a clamp has nothing to oscillate with
  s.sections[0].mass = Mat6::zero();
  EXPECT_EQ(places(s), (Places{"warning beams 0 section", "analysis 0 spectral_radius", "analysis 0 kind"}));
}

TEST(SceneProblems, a_gap_or_a_turn_between_joint_frames_is_told_with_its_size) {
  Scene s = cantilever();
  s.joints[0].first.offset.x = {{0, 0, 0.25}};
  auto p = problems_in(s);
  ASSERT_EQ(p.size(), 1u);
  EXPECT_NE(p[0].rule.find("0.25 m apart"), std::string::npos) << p[0].rule;
  s.joints[0].first.offset = {motion::exp_so3(Vec3{{0.125, 0, 0}}), Vec3::zero()};
  p = problems_in(s);
  ASSERT_EQ(p.size(), 1u);
  EXPECT_NE(p[0].rule.find("0.125 rad"), std::string::npos) << p[0].rule;
}

TEST(SceneProblems, joints_may_stand_apart_along_what_they_leave_free) {
  Scene s = cantilever();
  s.joints[0].kind = JointKind::prismatic;
  s.joints[0].first.offset.x = {{0, 0, 0.25}};
  EXPECT_EQ(places(s), Places{}) << "along axis 3";
  s.joints[0].kind = JointKind::cylindrical;
  EXPECT_EQ(places(s), Places{}) << "along axis 3";
  s.joints[0].first.offset.x = {{0.25, 0, 0}};
  EXPECT_EQ(places(s), (Places{"joints 0 "})) << "off axis 3";
  s.joints[0].first.offset.x = {{0, 0, 0.25}};
  s.joints[0].kind = JointKind::revolute;
  s.joints[0].first.offset = {motion::exp_so3(Vec3{{0, 0, 1.0}}), Vec3::zero()};
  EXPECT_EQ(places(s), Places{}) << "about axis 3";
  s.joints[0].kind = JointKind::planar;
  s.joints[0].first.offset.x = {{1, 2, 0}};
  EXPECT_EQ(places(s), Places{}) << "in the plane";
  s.joints[0].first.offset.x = {{1, 2, 0.1}};
  EXPECT_EQ(places(s), (Places{"joints 0 "})) << "out of the plane";
  s.joints[0].kind = JointKind::spherical;
  s.joints[0].first.offset = {motion::exp_so3(Vec3{{1, 2, 0.3}}), Vec3::zero()};
  EXPECT_EQ(places(s), Places{}) << "any turn of a ball joint";
}

TEST(SceneProblems, a_drive_that_starts_elsewhere_is_warned_about_and_counts_whole_turns_as_the_same) {
  Scene s = cantilever();
  s.analysis.kind = AnalysisKind::dynamics;
  s.analysis.end_time = 1.0;
  s.joints[0].kind = JointKind::revolute;
  s.joints[0].drives = {{"angle", false, laws::make_constant(0.5), ""}};
  EXPECT_EQ(places(s), (Places{"warning joints 0 drives/0/law"}));
  s.joints[0].drives[0].law = laws::make_constant(4 * 3.14159265358979323846);
  EXPECT_EQ(places(s), Places{});
  s.joints[0].drives[0] = {"angle", true, laws::make_constant(0.5), ""};
  EXPECT_EQ(places(s), Places{}) << "a rate may start at any value";
}

TEST(SceneProblems, a_spin_about_a_line_through_a_joint_does_not_leave_it_by_round_off) {
  Scene s;
  Body b;
  b.name = "shaft";
  b.mass = 1.0;
  b.inertia = Mat3::identity();
  b.placement.pose.R = motion::exp_so3(Vec3{{0.0, 0.0, 0.6}});
  b.placement.pose.x = b.placement.pose.R * Vec3{{0.41, 0.0, 0.0}};
  s.bodies = {b};
  Joint j;
  j.name = "ball";
  j.kind = JointKind::spherical;
  j.second.to = "shaft";
  j.second.offset.x = {{-0.41, 0.0, 0.0}};
  s.joints = {j};
  InitialVelocity v;
  v.of = "shaft";
  v.axes = LoadAxes::body;
  v.angular_velocity = {{6.0, 0.0, 0.0}};
  s.initial_velocities = {v};
  s.analysis.end_time = 1.0;
  EXPECT_EQ(places(s), Places{});
  s.initial_velocities[0].angular_velocity = {{6.0, 0.0, 0.1}};
  s.joints[0].second.offset.x = {{-0.41, 0.0, 0.0}};
  s.initial_velocities[0].velocity = {{0.0, 0.0, 0.1}};
  EXPECT_EQ(places(s), Places{"warning joints 0 name"});
}

TEST(SceneProblems, inner_nodes_of_beams_are_places) {
  Scene s = cantilever();
  s.beams[0].elements = 4;
  PointLoad l;
  l.name = "load";
  l.force = {{0, 0, 1}};
  l.law = laws::make_constant(1);
  l.at.to = "beam.2";
  s.point_loads = {l};
  EXPECT_EQ(places(s), Places{});
  for (const char* wrong : {"beam.5", "beam.-1", "beam.", "beam.02", "beam.99999999999999999999", "beam"}) {
    s.point_loads[0].at.to = wrong;
    EXPECT_EQ(places(s), (Places{"point_loads 0 at"})) << wrong;
  }
}

TEST(SceneProblems, indefinite_and_coupled_matrices_are_found) {
  const auto with = [](double diagonal, double coupling) {
    Scene s = cantilever();
    s.sections[0].mass(0, 0) = s.sections[0].mass(4, 4) = diagonal;
    s.sections[0].mass(0, 4) = s.sections[0].mass(4, 0) = coupling;
    return places(s);
  };
  EXPECT_EQ(with(1.0, 0.5), Places{});
  EXPECT_EQ(with(1.0, 1.0), Places{}) << "semi-definite: a point mass off the axis";
  EXPECT_EQ(with(1.0, 1.001), (Places{"sections 0 mass"}));
  EXPECT_EQ(with(0.0, 0.0), Places{});
  EXPECT_EQ(with(0.0, 0.1), (Places{"sections 0 mass"})) << "coupling without mass";
}

/// A number, a direction, a matrix and a factor of it.
constexpr CouplingField pull_fields[] = {
    {.name = "pull", .unit = "N", .about = "F.", .standard = "0", .is_strength = true},
    {.name = "along", .type = CouplingFieldType::direction, .unit = "-", .about = "Where to."},
    {.name = "block", .type = CouplingFieldType::matrix, .unit = "N/m", .about = "K.", .is_strength = true},
    {.name = "factor", .type = CouplingFieldType::law, .unit = "-", .about = "Of K.", .multiplied = "block"}};
constexpr CouplingKind pulls{"pulls",     "pull", "Pulls.", "One end.",           "The other.",
                             pull_fields, false,  false,    CouplingStart::apart, nullptr};

TEST(SceneProblems, fields_of_couplings_are_checked_as_their_kind_declares_them) {
  Scene s = cantilever();
  s.couplings = {make_coupling(pulls, "c", "", "tip", {1.0, 0.0, 0.0, 2.0})};
  Coupling& c = s.couplings[0];
  EXPECT_EQ(places(s), Places{});
  const Coupling good = c;
  c.values[0] = -1.0;
  EXPECT_EQ(places(s), (Places{"couplings 0 pull"}));
  c.values[0] = 0.0;
  EXPECT_EQ(places(s), (Places{"warning couplings 0 "}));
  EXPECT_EQ(problems_in(s, {})[0].rule, "without pull and block it does nothing");
  c = good;
  c.values[3] = 0.0;
  EXPECT_EQ(places(s), (Places{"couplings 0 along"}));
  c = good;
  c.factors[0].law = laws::make_constant(2.0);
  EXPECT_EQ(places(s), (Places{"couplings 0 factor"}));
  c.values[4] = 3.0;
  EXPECT_EQ(places(s), Places{});
  c.values[4] = -3.0;
  EXPECT_EQ(places(s), (Places{"couplings 0 block"}));
  c = good;
  c.values.pop_back();
  EXPECT_EQ(places(s), (Places{"couplings 0 values"}));
}

TEST(SceneProblems, a_mass_off_the_axis_without_inertia_of_its_own_is_semi_definite) {
  Scene s = cantilever();
  const Mat3 c = lanes::skew(Vec3{{0.3, -0.2, 0.7}}), cc = c * c;
  Mat6& M = s.sections[0].mass;
  M = Mat6::zero();
  for (int i = 0; i < 3; ++i) {
    M(i, i) = 1.0;
    for (int j = 0; j < 3; ++j) {
      M(i, j + 3) = -c(i, j);
      M(i + 3, j) = c(i, j);
      M(i + 3, j + 3) = -cc(i, j);
    }
  }
  EXPECT_EQ(places(s), Places{});
}

TEST(SceneProblems, the_rank_deficient_inertia_of_a_rod_is_good_in_any_axes) {
  Scene s = cantilever();
  Body b;
  b.name = "rod";
  b.mass = 1.0;
  const Mat3 R = motion::exp_so3(Vec3{{0.4, -0.8, 1.3}});
  Mat3 J = Mat3::zero();
  J(1, 1) = J(2, 2) = 0.1;
  b.inertia = R * J * lanes::transpose(R);
  s.bodies = {b};
  EXPECT_EQ(places(s), (Places{"warning bodies 0 name"})) << "held by nothing, but possible";
  b.inertia(0, 0) += 0.3;
  s.bodies = {b};
  EXPECT_EQ(places(s), (Places{"bodies 0 inertia", "warning bodies 0 name"}));
}

}  // namespace
}  // namespace bough::scene
