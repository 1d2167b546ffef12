#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "../step/small_scenes.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/plan/plan.hpp"
#include "bough/scene/components.hpp"
#include "support/given.hpp"

namespace bough::plan {
namespace {

TEST(MakePlan, numbers_elements_blocks_and_multipliers_without_gaps) {
  scene::Scene chain = test::make_chain(3);
  chain.without = {"planar"};
  const Plan p = make_plan(chain);
  EXPECT_EQ(p.nodes.size(), 9u);      // two ends and one inner node a link
  EXPECT_EQ(p.directory.size(), 9u);  // two elements and one hinge a link
  EXPECT_EQ(p.num_multipliers, 15);
  EXPECT_EQ(p.graph.num_blocks(), 12);
  EXPECT_EQ(p.graph.num_elements(), 9);
  for (int e = 0; e < p.graph.num_elements(); ++e) {
    int size = 0, unknowns = 0;
    for (auto k = p.graph.element_begin[static_cast<std::size_t>(e)];
         k < p.graph.element_begin[static_cast<std::size_t>(e) + 1]; ++k)
      size += p.graph.block_size[static_cast<std::size_t>(p.graph.element_blocks[static_cast<std::size_t>(k)])];
    with_element(p.elements, p.directory[static_cast<std::size_t>(e)],
                 [&](const auto& x) { unknowns = elements::num_unknowns(x); });
    EXPECT_EQ(size, unknowns) << e;
  }
  for (const JointPlan& j : p.joints) {
    EXPECT_EQ(p.element_owner[static_cast<std::size_t>(j.element)], j.name);
    EXPECT_EQ(p.graph.block_kind[static_cast<std::size_t>(j.block)], blocks::BlockKind::multiplier);
  }
  for (const BeamPlan& b : p.beams)
    for (int e : b.elements) EXPECT_EQ(p.element_owner[static_cast<std::size_t>(e)], b.name);
}

TEST(MakePlan, counts_turns_of_those_joints_whose_angle_is_read) {
  scene::Scene chain = test::make_chain(5);
  for (const auto& [kind, joint] :
       {std::pair{scene::SensorKind::joint_reaction, "hinge1"}, std::pair{scene::SensorKind::joint_angle, "hinge2"}}) {
    scene::Sensor sensor;
    sensor.name = joint;
    sensor.kind = kind;
    sensor.joint = joint;
    chain.sensors.push_back(sensor);
  }
  scene::JointForce spring;
  spring.coordinate = "angle";
  spring.stiffness = 1.0;
  chain.joints[3].forces.push_back(spring);
  scene::JointDrive drive;
  drive.coordinate = "angle";
  drive.law = laws::make_constant(0.0);
  chain.joints[4].drives.push_back(drive);
  EXPECT_EQ(make_plan(chain).turning_joints, (std::vector<int>{2, 3, 4}));
}

TEST(MakePlan, says_that_a_retired_simplification_changes_nothing) {
  scene::Scene chain = test::make_chain(2);
  const Plan plain = make_plan(chain);
  for (const std::string& name : scene::retired_decision_names()) {
    chain.without = {name};
    const Plan p = make_plan(chain);
    ASSERT_EQ(p.notes.size(), plain.notes.size() + 1) << name;
    EXPECT_NE(p.notes.back().find(name), std::string::npos) << p.notes.back();
    EXPECT_EQ(p.graph.block_size, plain.graph.block_size);
  }
}

TEST(MakePlan, lays_a_curved_beam_on_its_circle) {
  scene::Scene s;
  s.sections.push_back(test::make_bar_section());
  const double radius = 2.0, angle = 1.0;
  for (int k = 0; k < 2; ++k) {
    scene::Node n;
    n.name = k == 0 ? "start" : "end";
    if (k == 1) n.placement.pose.x = {{radius * std::sin(angle), radius * (1.0 - std::cos(angle)), 0.0}};
    s.nodes.push_back(n);
  }
  scene::Beam b;
  b.name = "arc";
  b.section = "bar";
  b.start = "start";
  b.end = "end";
  b.curve = scene::BeamCurve::curvature;
  b.tangent = {{1.0, 0.0, 0.0}};
  b.axis_2 = {{0.0, 1.0, 0.0}};
  b.curvature = {{0.0, 0.0, 1.0 / radius}};
  b.length = radius * angle;
  b.elements = 3;
  b.order = 2;
  s.beams.push_back(b);
  const Plan p = make_plan(s);
  for (int node : p.beams[0].nodes) {
    const auto& x = p.nodes[static_cast<std::size_t>(node)].pose.x;
    EXPECT_NEAR(std::hypot(x[0], x[1] - radius), radius, 1e-14);
  }
  // Stress-free as it lies: the reference strain is (1, 0, 0; curvature).
  for (const auto& e : array_of<elements::Beam<3>>(p.elements))
    for (const auto& strain : e.reference_strain) {
      EXPECT_NEAR(strain[0], 1.0, 1e-14);
      EXPECT_NEAR(strain[5], 1.0 / radius, 1e-14);
    }
}

TEST(MakePlan, gives_a_point_mass_displacements_alone_only_where_nothing_depends_on_its_rotation) {
  scene::Scene s;
  for (const char* name : {"free", "barred"}) {
    scene::Body b;
    b.name = name;
    b.mass = 1.0;
    b.is_point_mass = true;
    s.bodies.push_back(b);
  }
  support::GivenSpring spring;
  spring.name = "line";
  spring.first.offset.x = {{0.0, 1.0, 0.0}};
  spring.second.to = "free";
  s.couplings.push_back(spring);
  scene::Joint j;
  j.name = "hinge";
  j.kind = scene::JointKind::revolute;
  j.second.to = "barred";
  j.second.offset.x = {{0.0, 1.0, 0.0}};
  s.joints.push_back(j);
  const Plan p = make_plan(s);
  EXPECT_EQ(p.joints.size(), 1u);
  EXPECT_TRUE(p.nodes[0].is_point);
  EXPECT_FALSE(p.nodes[1].is_point);
  EXPECT_EQ(p.unknowns.count_of(0) + 1, p.unknowns.count_of(1));  // in a plane
}

/// A point mass met by ball joints at these points of its own.
scene::Scene scene_of_held_mass(const std::vector<motion::Vec3<double>>& points) {
  scene::Scene s;
  scene::Body b;
  b.name = "bob";
  b.mass = 3.0;
  b.is_point_mass = true;
  s.bodies.push_back(b);
  for (const motion::Vec3<double>& x : points) {
    scene::Joint j;
    j.name = "ball " + std::to_string(s.joints.size());
    j.kind = scene::JointKind::spherical;
    j.first.offset.x = j.second.offset.x = x;
    j.second.to = "bob";
    s.joints.push_back(j);
  }
  return s;
}
Plan plan_of_held_mass(const std::vector<motion::Vec3<double>>& points) {
  return make_plan(scene_of_held_mass(points));
}

TEST(MakePlan, keeps_a_point_mass_from_spinning_about_the_one_line_it_is_held_at) {
  for (const std::vector<motion::Vec3<double>>& points :
       {std::vector<motion::Vec3<double>>{{{0.0, 0.6, -0.8}}},
        std::vector<motion::Vec3<double>>{{{0.0, 0.6, -0.8}}, {{0.0, -0.3, 0.4}}}}) {
    const Plan p = plan_of_held_mass(points);
    ASSERT_FALSE(p.notes.empty());
    EXPECT_NE(p.notes[0].find("'bob' is held at one line"), std::string::npos);
    const motion::Mat6<double>& m = array_of<elements::RigidBody>(p.elements)[0].mass;
    EXPECT_NEAR(m(4, 4), 3.0 * 0.36, 1e-15);
    EXPECT_NEAR(m(4, 5), -3.0 * 0.48, 1e-15);
    EXPECT_EQ(m(3, 3), 0.0);
    EXPECT_EQ(m(0, 4), 0.0);
  }
  const Plan held = plan_of_held_mass({{{0.0, 0.6, -0.8}}, {{1.0, 0.0, 0.0}}});
  for (const std::string& note : held.notes) EXPECT_EQ(note.find("at one line"), std::string::npos) << note;
  EXPECT_EQ(array_of<elements::RigidBody>(held.elements)[0].mass(4, 4), 0.0);
}

TEST(MakePlan, starts_a_point_mass_without_a_spin_about_the_line_it_is_held_at) {
  scene::Scene s = scene_of_held_mass({{{0.0, 0.6, -0.8}}});
  s.initial_velocities.push_back({});
  s.initial_velocities[0].of = "bob";
  s.initial_velocities[0].velocity = {{1.0, 2.0, 3.0}};
  s.initial_velocities[0].angular_velocity = {{0.5, 0.0, 1.0}};
  const motion::Vec6<double> twist = make_plan(s).nodes[0].twist;
  const double expected[] = {1.0, 2.0, 3.0, 0.5, 0.48, 0.36};  // less -0.8 about the line (0, 0.6, -0.8)
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(twist[i], expected[i], 1e-15);
  s.initial_velocities.clear();
  scene::FrameDef table;  // the same turning as that of the ground
  table.name = "table";
  table.motion.emplace();
  table.motion->turns.push_back({{{0.0, 0.0, 1.0}}, laws::make_expression("2*t")});
  s.frames.push_back(table);
  s.analysis.frame = "table";
  const motion::Vec6<double> inside = make_plan(s).nodes[0].twist;
  const double left[] = {0.0, 0.0, 0.0, 0.0, 0.96, -1.28};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(inside[i], left[i], 1e-15);
}

TEST(MakePlan, integrates_a_driven_rate_from_the_initial_angle) {
  scene::Scene s;
  scene::Body b;
  b.name = "wheel";
  b.mass = 1.0;
  b.inertia = motion::Mat3<double>::identity();
  b.placement.pose.R = motion::exp_so3(motion::Vec3<double>{{0.0, 0.0, 0.3}});
  s.bodies.push_back(b);
  scene::Joint j;
  j.name = "axle";
  j.kind = scene::JointKind::revolute;
  j.second.to = "wheel";
  j.drives.push_back({"angle", true, laws::make_constant(2.0), ""});
  s.joints.push_back(j);
  const Plan p = make_plan(s);
  const auto& joint = array_of<elements::Joint>(p.elements)[0];
  ASSERT_EQ(joint.num_rows, 6);
  const laws::Law& law = p.laws[static_cast<std::size_t>(joint.rows[5].law)].law;
  EXPECT_NEAR(law.at(0.0).value, 0.3, 1e-15);
  EXPECT_NEAR(law.at(5.0).value, 10.3, 1e-14);
}

}  // namespace
}  // namespace bough::plan
