// Shapes, poses, names: what the scene layer computes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bough/scene/components.hpp"
#include "bough/scene/nearest_name.hpp"
#include "bough/scene/poses.hpp"
#include "bough/scene/shapes.hpp"

namespace bough::scene {
namespace {

using std::numbers::pi;

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

Frame at(double x, double y, double z) { return {Mat3::identity(), {{x, y, z}}}; }

TEST(SceneShapes, the_torsion_constant_of_a_rectangle_meets_its_known_values_and_limits) {
  // Timoshenko, Goodier, table of k1: a square 0.1406, 2:1 0.229, 10:1 0.312 (digits as printed).
  EXPECT_NEAR(rectangle_torsion_constant(1, 1), 0.1406, 5e-5);
  EXPECT_NEAR(rectangle_torsion_constant(2, 1), 2 * 0.229, 1e-3);
  EXPECT_NEAR(rectangle_torsion_constant(10, 1), 10 * 0.312, 6e-3);
  // a thin strip: a b^3 / 3 (1 - 0.630 b/a), the series' own limit
  EXPECT_NEAR(rectangle_torsion_constant(1e6, 1), 1e6 / 3.0 * (1 - 0.6302e-6), 1e-4);
}

TEST(SceneShapes, the_torsion_series_meets_prandtl_s_stress_function_on_a_grid) {
  // Oracle: five-point differences of  laplace(u) = -2,  J = 2 int u, on a 1 x 0.5 rectangle; error O(h^2), here 1e-3.
  const int m = 40, n = 20;
  const double h = 1.0 / m;
  std::vector<double> u(static_cast<std::size_t>((m + 1) * (n + 1)), 0.0);
  const auto id = [&](int i, int j) { return static_cast<std::size_t>(i * (n + 1) + j); };
  for (int sweep = 0; sweep < 1500; ++sweep)
    for (int i = 1; i < m; ++i)
      for (int j = 1; j < n; ++j) {
        const double next = 0.25 * (u[id(i - 1, j)] + u[id(i + 1, j)] + u[id(i, j - 1)] + u[id(i, j + 1)] + 2 * h * h);
        u[id(i, j)] += 1.8 * (next - u[id(i, j)]);
      }
  double J = 0.0;
  for (const double x : u) J += 2 * x * h * h;
  EXPECT_NEAR(J, rectangle_torsion_constant(1.0, 0.5), 5e-3 * J);
}

TEST(SceneShapes, a_tube_is_the_difference_of_two_circles) {
  const AreaFigures tube = area_figures(Tube{0.5, 0.3}), outer = area_figures(Circle{0.5}),
                    inner = area_figures(Circle{0.3});
  EXPECT_NEAR(tube.area, outer.area - inner.area, 1e-15);
  EXPECT_NEAR(tube.second_moment_2, outer.second_moment_2 - inner.second_moment_2, 1e-15);
  EXPECT_NEAR(tube.torsion, outer.torsion - inner.torsion, 1e-15);
  EXPECT_NEAR(area_figures(Tube{0.5, 1e-9}).shear_factor_2, 6.0 / 7.0, 1e-12);
  EXPECT_NEAR(area_figures(Tube{1.0, 1 - 1e-9}).shear_factor_2, 0.5, 1e-6) << "a thin ring: 24/48";
}

TEST(SceneShapes, section_axes_go_with_width_and_height) {
  const AreaFigures f = area_figures(Rectangle{0.1, 0.3});
  EXPECT_NEAR(f.second_moment_2, 0.1 * 0.027 / 12, 1e-17) << "bending about axis 2 has the height along axis 3";
  EXPECT_NEAR(f.second_moment_3, 0.3 * 0.001 / 12, 1e-17);
}

TEST(SceneShapes, the_mass_matrix_gives_the_kinetic_energy_of_the_offset_mass) {
  const Vec3 c = {{0.1, -0.2, 0.3}}, J = {{0.5, 0.4, 0.3}}, v = {{1, 2, -1}}, w = {{0.3, -0.7, 0.2}};
  const Mat6 M = section_mass_matrix(2.0, J, c);
  const Vec6 twist = lanes::join(v, w);
  const Vec3 v_c = v + cross(w, c);
  const double energy =
      0.5 * 2.0 * dot(v_c, v_c) + 0.5 * (J[0] * w[0] * w[0] + J[1] * w[1] * w[1] + J[2] * w[2] * w[2]);
  EXPECT_NEAR(0.5 * lanes::dot(twist, Vec6(M * twist)), energy, 1e-14);
}

TEST(SceneShapes, a_flat_box_obeys_the_perpendicular_axes_and_a_long_cylinder_is_a_rod) {
  const Mat3 plate = inertia_of(Box{{{2, 3, 0}}}, 5);
  EXPECT_NEAR(plate(2, 2), plate(0, 0) + plate(1, 1), 1e-14);
  const Mat3 thin = inertia_of(Cylinder{1e-6, 2, 2}, 5), rod = inertia_of(Rod{2, 2}, 5);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(thin.m[i], rod.m[i], 1e-11);
  const Mat3 ball = inertia_of(Sphere{2}, 3);
  EXPECT_DOUBLE_EQ(ball(0, 0), 0.4 * 3 * 4);
  EXPECT_DOUBLE_EQ(volume_of(Cylinder{1, 2, 1}), 2 * pi);
}

Scene beam_scene() {
  Scene s;
  s.nodes = {{"a", {at(0, 0, 0), ""}}, {"b", {at(0, 2, 0), ""}}};
  Beam beam;
  beam.name = "beam";
  beam.start = "a";
  beam.end = "b";
  beam.elements = 2;
  beam.order = 2;
  s.beams = {beam};
  return s;
}

TEST(ScenePoses, inner_nodes_of_a_straight_beam_divide_it_evenly_and_turn_with_its_twist) {
  Scene s = beam_scene();
  s.beams[0].twist = pi / 2;
  s.beams[0].axis_2 = {{0, 0, 5}};
  const Poses poses(s);
  expect_near(poses.of(std::string_view("beam.1"))->x, {{0, 0.5, 0}}, 1e-15);
  expect_near(column(poses.of(std::string_view("beam.0"))->R, 0), {{0, 1, 0}}, 1e-15);
  expect_near(column(poses.of(std::string_view("beam.0"))->R, 1), {{0, 0, 1}}, 1e-15);
  expect_near(column(poses.of(std::string_view("beam.4"))->R, 1), {{1, 0, 0}}, 1e-15);
  EXPECT_FALSE(poses.of(std::string_view("beam.5")));
  EXPECT_FALSE(poses.of(std::string_view("beam.x")));
  EXPECT_FALSE(poses.of(std::string_view("beam")));
}

TEST(ScenePoses, a_beam_without_axis_2_has_its_axis_3_nearest_to_the_vertical) {
  Scene s = beam_scene();
  for (const Vec3& end : {Vec3{{3, 0, 0}}, Vec3{{0, -2, 0}}, Vec3{{1, 1, 1}}}) {
    s.nodes[1].placement.pose.x = end;
    const Poses poses(s);
    const auto H = poses.axis_of(s.beams[0]);
    EXPECT_NEAR(H->start.R(2, 1), 0.0, 1e-15) << "axis 2 is horizontal";
    EXPECT_GT(H->start.R(2, 2), 0.0) << "axis 3 points up";
  }
  s.nodes[1].placement.pose.x = {{0, 0, 3}};
  const Poses poses(s);
  expect_near(column(poses.axis_of(s.beams[0])->at(0.0).R, 1), {{0, 1, 0}}, 1e-15);
}

TEST(ScenePoses, a_curved_beam_runs_along_its_circle) {
  Scene s = beam_scene();
  Beam& b = s.beams[0];
  b.curve = BeamCurve::curvature;
  b.tangent = {{2, 0, 0}};
  b.axis_2 = {{0, 1, 0}};
  b.curvature = {{0, 0, 0.5}};
  b.length = pi;
  const Poses poses(s);
  expect_near(poses.axis_of(b)->at(1.0).x, {{2, 2, 0}}, 1e-15);
  expect_near(column(poses.axis_of(b)->at(1.0).R, 0), {{0, 1, 0}}, 1e-15);
  expect_near(poses.axis_of(b)->at(0.5).x, {{2 * std::sin(pi / 4), 2 - 2 * std::cos(pi / 4), 0}}, 1e-15);
}

TEST(ScenePoses, circles_of_frames_end_without_a_pose) {
  Scene s;
  s.frames = {{"p", {at(1, 0, 0), "q"}}, {"q", {at(1, 0, 0), "p"}}};
  EXPECT_FALSE(Poses(s).of(std::string_view("p")));
  EXPECT_TRUE(Poses(s).of(std::string_view("ground")));
  (void)resolve(s, {Frame::identity(), "p"});  // ends as well
}

TEST(ScenePoses, two_axes_make_a_rotation_whichever_two_they_are) {
  const Vec3 main = {{1, 2, 3}}, side = {{-1, 0, 2}};
  for (int k = 1; k <= 3; ++k) {
    const auto R = axes_from(k, main, side);
    ASSERT_TRUE(R);
    const Vec3 a = column(*R, k - 1);
    expect_near(cross(a, main), Vec3::zero(), 1e-15);
    expect_near(cross(column(*R, 0), column(*R, 1)), column(*R, 2), 1e-15);
    EXPECT_GT(dot(column(*R, k % 3), side), 0.0);
  }
  EXPECT_FALSE(axes_from(1, main, 2.0 * main));
  EXPECT_FALSE(axes_from(1, Vec3::zero(), side));
}

TEST(SceneNames, the_nearest_name_is_found_for_slips_and_not_for_strangers) {
  const std::vector<std::string> known = {"position", "rotation", "frame", "mass", "EI2", "EI3", "step_size"};
  EXPECT_EQ(nearest_name("positon", known), "position");
  EXPECT_EQ(nearest_name("psoition", known), "position");
  EXPECT_EQ(nearest_name("Position", known), "position");
  EXPECT_EQ(nearest_name("mas", known), "mass");
  EXPECT_EQ(nearest_name("ei3", known), "EI3");
  EXPECT_EQ(nearest_name("step-size", known), "step_size");
  EXPECT_EQ(nearest_name("stepsize", known), "step_size");
  EXPECT_EQ(nearest_name("temperature", known), "");
  EXPECT_EQ(nearest_name("", known), "");
  EXPECT_EQ(nearest_name(std::string(1000, 'a'), known), "");
}

TEST(SceneNames, the_edit_distance_is_a_metric_on_small_words) {
  const std::string words[] = {"", "a", "A", "ab", "ba", "abc", "acb", "xyz"};
  for (const auto& a : words)
    for (const auto& b : words) {
      EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
      EXPECT_EQ(edit_distance(a, b) == 0, a == b);
    }
  EXPECT_EQ(edit_distance("abc", "acb"), 2) << "a swap is one edit";
  EXPECT_EQ(edit_distance("abc", "xyz"), 6);
}

TEST(SceneNames, every_sensor_kind_has_a_name_of_its_own_and_columns) {
  std::vector<std::string> names;
  for (int k = 0; k <= static_cast<int>(SensorKind::total_energy); ++k) {
    Sensor s;
    s.name = "s";
    s.kind = static_cast<SensorKind>(k);
    EXPECT_EQ(columns_of(s).size(), std::max<std::size_t>(1, components_of(s.kind).size()));
    for (const std::string& other : names) EXPECT_NE(other, to_string(s.kind));
    names.push_back(to_string(s.kind));
  }
}

}  // namespace
}  // namespace bough::scene
