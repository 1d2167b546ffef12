/// Which group a scene of point masses moves on, why not on a smaller one, and the elements there.
#include <gtest/gtest.h>

#include "bough/motion/so3.hpp"
#include "decision_of.hpp"
#include "support/given.hpp"

namespace bough::plan {
namespace {

using motion::Se3;
using motion::Translations;
using motion::Vec3;
using test::decision_of;

const Vec3<double> slope{{0.48, -0.6, 0.64}};  // of length 1

scene::Body point_mass(const std::string& name, const Vec3<double>& at) {
  scene::Body b;
  b.name = name;
  b.mass = 0.5;
  b.is_point_mass = true;
  b.placement.pose.x = at;
  b.placement.pose.R = motion::exp_so3(Vec3<double>{{0.4, 0.9, -0.2}});
  return b;
}

/// Two masses and three springs between two points of the ground, the second mass beside their line by `beside`.
scene::Scene make_row(double beside) {
  scene::Scene s;
  s.bodies = {point_mass("a", 0.5 * slope), point_mass("b", slope + Vec3<double>{{0.0, 0.0, beside}})};
  const char* ends[4] = {"", "a", "b", ""};
  for (std::size_t k = 0; k < 3; ++k) {
    support::GivenSpring spring;
    spring.name = "s" + std::to_string(k);
    spring.first.to = ends[k];
    spring.second.to = ends[k + 1];
    spring.stiffness = 100.0 + static_cast<double>(k);
    spring.rest_length = 0.4;
    s.couplings.push_back(spring);
  }
  s.couplings.back().second.offset.x = 1.7 * slope;
  return s;
}

TEST(ReducedModel, of_point_masses_is_on_a_line_or_on_translations) {
  EXPECT_TRUE(make_plan(make_row(0.0)).is_on<Translations<1>>());
  EXPECT_TRUE(make_plan(make_row(0.3)).is_on<Translations<3>>());
  scene::Scene s = make_row(0.0);
  s.without = {"line"};
  const Plan no_line = make_plan(s);
  EXPECT_TRUE(no_line.is_on<Translations<3>>());
  EXPECT_TRUE(decision_of(no_line, "line").barred);
  s.without = {"line", "translation", "planar"};
  EXPECT_TRUE(make_plan(s).is_on<Se3>());
}

/// The first reason why a scene that moves on R^3 does not after a change.
template <class Change>
std::string reason_against(Change&& change) {
  scene::Scene s = make_row(0.3);
  change(s);
  const Plan p = make_plan(s);
  EXPECT_FALSE(p.is_on<Translations<3>>());
  EXPECT_FALSE(decision_of(p, "translation").taken);
  return decision_of(p, "translation").reason;
}

TEST(ReducedModel, of_translations_is_refused_with_the_part_that_turns) {
  EXPECT_EQ(reason_against([](scene::Scene& s) {
              scene::PointLoad load;
              load.name = "push";
              load.at.to = "b";
              load.axes = scene::LoadAxes::body;
              load.force = slope;
              s.point_loads.push_back(load);
            }),
            "'push': it follows rotations");
  EXPECT_EQ(reason_against([](scene::Scene& s) {
              support::GivenBushing bushing;
              bushing.name = "mount";
              bushing.first.to = "a";
              bushing.second.to = "b";
              bushing.stiffness = motion::Mat6<double>::identity();
              s.couplings.push_back(bushing);
            }),
            "'mount': it holds rotations");
  EXPECT_EQ(reason_against([](scene::Scene& s) {
              s.bodies[1].is_point_mass = false;
              s.bodies[1].inertia = motion::Mat3<double>::identity();
              s.couplings[1].second.offset.x = {{0.0, 0.1, 0.0}};
            }),
            "'s1': it takes hold beside the origin of a body's frame");
  EXPECT_EQ(reason_against([](scene::Scene& s) {
              scene::Joint rod;
              rod.name = "hinge";
              rod.kind = scene::JointKind::spherical;
              rod.first.to = "a";
              rod.second.to = "b";
              s.joints.push_back(rod);
            }),
            "'hinge': it joins two bodies");
}

TEST(ReducedModel, of_a_line_has_places_and_springs_along_it) {
  const Plan p = make_plan(make_row(0.0));
  const ModelOn<Translations<1>>& model = std::get<ModelOn<Translations<1>>>(p.model);
  const double direction = lanes::dot(lanes::column(p.axes, 0), slope);
  EXPECT_NEAR(std::abs(direction), 1.0, 1e-15);
  ASSERT_EQ(model.nodes.size(), 2u);
  for (std::size_t n = 0; n < 2; ++n)
    EXPECT_NEAR(model.nodes[n].x.hi[0], direction * 0.5 * static_cast<double>(n), 1e-15);
  const auto& springs = std::get<std::vector<elements::SpringOn<Translations<1>>>>(model.elements);
  ASSERT_EQ(springs.size(), 3u);
  EXPECT_EQ(springs[2].stiffness, 102.0);
  EXPECT_NEAR(springs[0].ports[0].offset.x[0], -direction * 0.5, 1e-15);
  EXPECT_NEAR(springs[2].ports[1].offset.x[0], direction * 1.2, 1e-15);
  EXPECT_FALSE(springs[0].ports[1].has_offset);
  for (const auto& body : std::get<std::vector<elements::RigidBodyOn<Translations<1>>>>(model.elements))
    EXPECT_NEAR(body.mass(0, 0), 0.5, 1e-15);
}

/// Unknowns are displacements in the axes of the ground, whatever the axes of the bodies.
TEST(ReducedModel, of_translations_has_unknowns_in_the_axes_of_the_ground) {
  const scene::Scene s = make_row(0.3);
  const Plan p = make_plan(s);
  ASSERT_EQ(p.unknowns.count, 3);
  const double x[3] = {0.3, -1.2, 0.7};
  for (std::size_t n = 0; n < 2; ++n) {
    const motion::Vec6<double> eta = p.unknowns.expanded(x, n);
    const Vec3<double> moved = p.nodes[n].pose.R * lanes::linear_part(eta);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(moved[i], x[i], 1e-15);
    const Vec3<double> turned = lanes::angular_part(eta);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(turned[i], 0.0);
  }
}

}  // namespace
}  // namespace bough::plan
