// What a good file becomes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "bough/io/read_scene.hpp"
#include "bough/motion/se3.hpp"
#include "bough/scene/couplings.hpp"
#include "bough/scene/poses.hpp"
#include "scene_base.hpp"
#include "support/source_dir.hpp"
#include "support/untrapped.hpp"

namespace bough::io {
namespace {

using scene::Vec3;
constexpr double round_off = 1e-14;  // a few operations on numbers of size 1

scene::Scene good(const std::string& text, std::vector<std::string> overrides = {}) {
  const SceneFile file = read_scene_text(text, "good", overrides);
  for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
  return file.scene;
}

std::string minimal(const std::string& lists) {
  return "{\"schema_version\": 1, \"analysis\": {\"kind\": \"dynamic\", \"end_time\": 1}, " + lists + "}";
}

std::string body(const std::string& keys) { return minimal("\"bodies\": [{\"name\": \"b\", " + keys + "}]"); }

void expect_near(const Vec3& a, const Vec3& b, double tolerance = round_off) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

TEST(SceneRead, what_is_left_out_takes_the_defaults_of_the_scene) {
  const scene::Scene s = good(body("\"mass\": 1, \"inertia\": [1, 1, 1]"));
  const scene::Scene d;
  EXPECT_EQ(s.analysis.step_size, d.analysis.step_size);
  EXPECT_EQ(s.analysis.spectral_radius, d.analysis.spectral_radius);
  EXPECT_EQ(s.analysis.bdf_order, d.analysis.bdf_order);
  EXPECT_EQ(s.analysis.newmark_beta, d.analysis.newmark_beta);
  EXPECT_EQ(s.analysis.newton, d.analysis.newton);
  EXPECT_EQ(s.analysis.tolerance, d.analysis.tolerance);
  EXPECT_EQ(s.analysis.max_iterations, d.analysis.max_iterations);
  EXPECT_EQ(s.analysis.max_cuts, d.analysis.max_cuts);
  EXPECT_EQ(s.analysis.load_steps, d.analysis.load_steps);
  EXPECT_EQ(s.solver.form, d.solver.form);
  EXPECT_EQ(s.solver.leaf_size, d.solver.leaf_size);
  EXPECT_EQ(s.solver.depth, d.solver.depth);
  EXPECT_EQ(s.solver.penalty_factor, d.solver.penalty_factor);
  EXPECT_EQ(s.solver.tasks, d.solver.tasks);
  EXPECT_EQ(s.output.stride, d.output.stride);
  EXPECT_EQ(s.output.motion, d.output.motion);
  EXPECT_EQ(s.output.motion_stride, d.output.motion_stride);
  EXPECT_EQ(s.output.checks, d.output.checks);
  EXPECT_EQ(s.output.checkpoint, d.output.checkpoint);
  EXPECT_EQ(s.output.checkpoint_time, d.output.checkpoint_time);
}

TEST(SceneRead, the_former_name_of_the_form_of_the_solver_is_still_read) {
  using scene::SolverForm;
  for (const auto& [kind, form] :
       {std::pair{"automatic", SolverForm::local}, std::pair{"hierarchical", SolverForm::local},
        std::pair{"global", SolverForm::global}, std::pair{"hybrid", SolverForm::hybrid},
        std::pair{"monolithic", SolverForm::monolithic}})
    EXPECT_EQ(good(test::base_scene(), {std::string("/solver={\"kind\": \"") + kind + "\"}"}).solver.form, form)
        << kind;
  EXPECT_EQ(good(test::base_scene(), {"/solver={\"form\": \"augmented\", \"penalty_factor\": 10}"}).solver.form,
            SolverForm::augmented);
}

TEST(SceneRead, the_name_of_a_scene_is_that_of_its_file) {
  const SceneFile file = read_scene(support::source_dir() / "data" / "scenarios" / "pendulum.json");
  EXPECT_EQ(file.scene.name, "pendulum");
}

TEST(SceneRead, all_forms_of_a_rotation_say_the_same) {
  const std::string forms[] = {R"({"axis": [0, 0, 7], "angle": 1.5707963267948966})",
                               R"({"quaternion": [0.7071067811865476, 0, 0, 0.7071067811865476]})",
                               R"({"rotation_vector": [0, 0, 1.5707963267948966]})",
                               R"({"axes": {"1": [0, 2, 0], "2": [-1, 5, 0]}})",
                               R"({"axes": {"3": [0, 0, 1], "1": [0, 1, 9]}})",
                               R"({"axes": {"2": [-1, 0, 0], "1": [0, 3, 0]}})",
                               R"({"axes": {"1": [0, 1, 0], "3": [0, 0, 3]}})"};
  for (const std::string& form : forms) {
    SCOPED_TRACE(form);
    const scene::Scene s = good(body("\"mass\": 1, \"inertia\": [1, 1, 1], \"rotation\": " + form));
    ASSERT_EQ(s.bodies.size(), 1u);
    const auto& R = s.bodies[0].placement.pose.R;
    expect_near(column(R, 0), {{0, 1, 0}});
    expect_near(column(R, 1), {{-1, 0, 0}});
    expect_near(column(R, 2), {{0, 0, 1}});
  }
}

TEST(SceneRead, frames_stand_in_each_other) {
  const scene::Scene s = good(minimal(R"("frames": [{"name": "inner", "frame": "outer", "position": [1, 0, 0]},
    {"name": "outer", "position": [0, 0, 5], "rotation": {"axis": [0, 0, 1], "angle": 1.5707963267948966}}],
    "bodies": [{"name": "b", "mass": 1, "inertia": [1, 1, 1], "frame": "inner", "position": [1, 0, 0]}])"));
  expect_near(scene::initial_pose(s, "inner")->x, {{0, 1, 5}});
  expect_near(scene::initial_pose(s, "b")->x, {{0, 2, 5}});
  expect_near(column(scene::initial_pose(s, "b")->R, 0), {{0, 1, 0}});
}

TEST(SceneRead, a_joint_given_by_position_and_axis_has_coinciding_frames_on_both_sides) {
  const std::string text = minimal(R"("bodies": [
    {"name": "a", "mass": 1, "inertia": [1, 1, 1], "position": [1, 2, 3], "rotation": {"rotation_vector": [0.3, -0.2, 0.5]}},
    {"name": "b", "mass": 1, "inertia": [1, 1, 1], "position": [-1, 0, 2], "rotation": {"rotation_vector": [1, 2, -0.5]}}],
    "joints": [{"name": "j", "kind": "revolute", "first": "a", "second": "b", "position": [0.5, 0.5, 0.5], "axis": [1, 1, 1]}])");
  const scene::Scene s = good(text);
  const scene::Poses poses(s);
  const auto first = poses.of(s.joints[0].first), second = poses.of(s.joints[0].second);
  expect_near(first->x, {{0.5, 0.5, 0.5}});
  expect_near(second->x, {{0.5, 0.5, 0.5}});
  const double d = 1 / std::sqrt(3.0);
  expect_near(column(first->R, 2), {{d, d, d}});
  for (int k = 0; k < 3; ++k) expect_near(column(first->R, k), column(second->R, k));
}

TEST(SceneRead, a_bare_name_takes_the_place_of_the_other_side) {
  const scene::Scene s = good(test::base_scene());
  EXPECT_EQ(s.joints[0].first.to, "");
  expect_near(s.joints[0].first.offset.x, Vec3::zero());
  EXPECT_EQ(s.joints[2].forces[0].coordinate, "angle");
  expect_near(s.joints[2].second.offset.x, {{0, 0, 1}});
  const scene::Scene t =
      good(test::spoilt("\"first\": \"ground\", \"second\": \"root\"", "\"first\": \"ground\", \"second\": \"tip\""));
  expect_near(t.joints[0].first.offset.x, {{1, 0, -1}});
}

TEST(SceneRead, a_universal_joint_has_its_first_axis_in_the_first_and_its_second_in_the_second) {
  const scene::Scene s = good(minimal(
      R"("bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}, {"name": "b", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]}],
    "joints": [{"name": "j", "kind": "universal", "first": "a", "second": "b", "position": [1, 0, 0], "axis": [0, 2, 0], "second_axis": [0, 0, 3]}])"));
  expect_near(column(s.joints[0].first.offset.R, 0), {{0, 1, 0}});
  expect_near(column(s.joints[0].second.offset.R, 1), {{0, 0, 1}});
}

TEST(SceneRead, springs_rest_at_their_first_length_unless_told) {
  const scene::Scene s = good(test::base_scene());
  EXPECT_DOUBLE_EQ(scene::line_force_of(s.couplings[0])->rest_length, std::sqrt(1.0 + 4.0 + 1.0));
}

TEST(SceneRead, laws_of_every_kind_have_the_values_they_promise) {
  const struct {
    std::string json;
    double t, value;
  } cases[] = {
      {"3", 0.5, 3},
      {R"({"kind": "constant", "value": 2})", 0.5, 2},
      {R"({"kind": "ramp", "end_time": 2, "to": 4})", 0.5, 1},
      {R"({"kind": "smooth_ramp", "end_time": 1, "from": 1, "to": 3})", 0.5, 2},
      {R"({"kind": "cycloidal", "end_time": 1, "to": 2})", 0.5, 1},
      {R"({"kind": "harmonic", "amplitude": 2, "omega": 3, "phase": 0.1, "offset": 1})", 0.5, 1 + 2 * std::sin(1.6)},
      {R"({"kind": "table", "times": [0, 1], "values": [1, 3]})", 0.5, 2},
      {R"({"kind": "table", "times": [0, 0.5, 1], "values": [0, 0.25, 1], "interpolation": "cubic"})", 0.25, 0.0625},
      {R"({"kind": "piecewise", "pieces": [{"start": 0, "law": 1}, {"start": 0.4, "law": {"expression": "t"}}]})", 0.5,
       0.5},
      {R"({"kind": "sum", "terms": [1, {"expression": "2*t"}]})", 0.5, 2},
      {R"({"kind": "product", "factors": [4, {"expression": "t"}, {"expression": "t"}]})", 0.5, 1},
      {R"({"kind": "scaled", "factor": -2, "law": {"expression": "t"}})", 0.5, -1},
      {"{\"expression\": \"sin(pi*t)\"}", 0.5, 1}};
  for (const auto& c : cases) {
    const scene::Scene s = good(test::spoilt("{ \"kind\": \"ramp\", \"end_time\": 0.5 }", c.json));
    ASSERT_EQ(s.point_loads.size(), 1u) << c.json;
    EXPECT_NEAR(s.point_loads[0].law.at(c.t).value, c.value, round_off) << c.json;
  }
}

TEST(SceneRead, loads_without_a_law_are_constant_in_time_and_grow_with_the_load_factor) {
  const scene::Scene moving = good(test::base_scene());
  EXPECT_EQ(moving.line_loads[0].law.at(0.25).value, 1.0);
  EXPECT_EQ(moving.gravity_law.at(0.25).value, 1.0);
  EXPECT_EQ(moving.line_loads[0].name, "load_1");
  std::string text =
      test::spoilt("{ \"kind\": \"dynamic\", \"end_time\": 1, \"step_size\": 1e-3, \"spectral_radius\": 0.9 }",
                   "{ \"kind\": \"static\", \"load_steps\": 4 }");
  const scene::Scene still = good(text);
  EXPECT_EQ(still.analysis.load_steps, 4);
  EXPECT_EQ(still.line_loads[0].law.at(0.25).value, 0.25);
  EXPECT_EQ(still.gravity_law.at(0.25).value, 0.25);
}

TEST(SceneRead, sections_and_bodies_from_shapes_have_the_closed_forms_of_mechanics) {
  const scene::Scene s = good(test::base_scene());
  const double E = 2.1e11, G = E / 2.6, rho = 7850, b = 0.02, h = 0.04, A = b * h;
  const auto& bar = s.sections[0];
  EXPECT_NEAR(bar.stiffness(0, 0), E * A, 1e-12 * E * A);
  EXPECT_NEAR(bar.stiffness(1, 1), 5.0 / 6.0 * G * A, 1e-12 * E * A);
  EXPECT_NEAR(bar.stiffness(4, 4), E * b * h * h * h / 12, 1e-12 * E * A * h * h);
  EXPECT_NEAR(bar.stiffness(5, 5), E * h * b * b * b / 12, 1e-12 * E * A * h * h);
  EXPECT_NEAR(bar.mass(4, 4), rho * b * h * h * h / 12, 1e-15);
  EXPECT_EQ(bar.mass(3, 3), bar.mass(4, 4) + bar.mass(5, 5));
  const scene::Scene box = good(body(R"("density": 3, "shape": {"kind": "box", "size": [1, 2, 3]})"));
  EXPECT_DOUBLE_EQ(box.bodies[0].mass, 18.0);
  EXPECT_DOUBLE_EQ(box.bodies[0].inertia(0, 0), 18.0 * 13.0 / 12.0);
}

TEST(SceneRead, damping_by_a_time_is_that_multiple_of_the_stiffness) {
  const scene::Scene s =
      good(test::spoilt("\"material\": \"steel\" }", "\"material\": \"steel\", \"damping\": { \"time\": 0.01 } }"));
  for (int i = 0; i < 36; ++i) EXPECT_EQ(s.sections[0].damping.m[i], 0.01 * s.sections[0].stiffness.m[i]);
}

TEST(SceneRead, overrides_change_values_make_keys_and_reach_items_by_name) {
  const scene::Scene s =
      good(test::base_scene(), {"/analysis/step_size=2e-3", "/beams/upper/elements=7", "/solver/form=monolithic",
                                "/solver/library=sparse_lu", "/solver/leaf_size=3", "/gravity=[0, 0, 0]",
                                "/nodes/1/position/0=1.5", "/output/motion=true"});
  EXPECT_EQ(s.analysis.step_size, 2e-3);
  EXPECT_EQ(s.beams[0].elements, 7);
  EXPECT_EQ(s.solver.form, scene::SolverForm::monolithic);
  EXPECT_EQ(s.solver.library, scene::SolverLibrary::sparse_lu);
  EXPECT_EQ(s.solver.leaf_size, 3);
  EXPECT_EQ(s.gravity[2], 0.0);
  EXPECT_EQ(s.nodes[1].placement.pose.x[0], 1.5);
  EXPECT_TRUE(s.output.motion);
}

TEST(SceneRead, wrong_overrides_are_problems_that_say_where_they_come_from) {
  const ::bough::test::Untrapped untrapped;  // 1e400
  const struct {
    std::string override, message;
  } cases[] = {{"/analysis/step_size=-1", "above 0"},
               {"/analysis/stepsize=1", "did you mean \"step_size\"?"},
               {"/nodes/9/name=a", "no such item"},
               {"/nodes/kne/position=[0,0,0]", "did you mean \"knee\"?"},
               {"analysis=1", "/pointer=value"},
               {"/analysis/step_size", "/pointer=value"},
               {"/analysis/step_size=[1", "not JSON"},
               {"/analysis/step_size=1e400", "too large"},
               {"/analysis/step_size=1e-400", "too small"},
               {"/analysis/step_size/x=1", "nothing inside"},
               {"/analysis/end_time=NaN", "not a string"},
               {"/analysis/end_time=null", "null is not a value"},
               {"=1", "/pointer=value"},
               {"/~2=1", "/pointer=value"}};
  for (const auto& c : cases) {
    const std::vector<std::string> overrides = {c.override};
    const SceneFile file = read_scene_text(test::base_scene(), "override", overrides);
    ASSERT_EQ(file.problems.size(), 1u) << c.override;
    EXPECT_NE(file.problems[0].text().find(c.message), std::string::npos)
        << c.override << " gave " << file.problems[0].text();
    EXPECT_EQ(file.problems[0].line, 0) << file.problems[0].text();
  }
}

TEST(SceneRead, every_scene_of_the_gallery_is_good_and_says_what_it_has_to_meet) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data" / "scenarios")) {
    if (entry.path().extension() != ".json") continue;
    ++count;
    SCOPED_TRACE(entry.path().string());
    const SceneFile file = read_scene(entry.path());
    for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
    for (const Problem& p : file.warnings) ADD_FAILURE() << p.text();
    EXPECT_FALSE(file.scene.title.empty());
    EXPECT_FALSE(file.scene.sensors.empty());
    EXPECT_FALSE(file.scene.expected.empty());
    for (const scene::Expected& e : file.scene.expected) EXPECT_FALSE(e.source.empty()) << e.quantity;
  }
  EXPECT_GE(count, 12);
}

/// Evaluated factor by factor, each in the one before, it took a stack of megabytes.
TEST(SceneRead, a_product_of_many_factors_is_no_tower_of_products) {
  std::string factors = R"({"expression": "1 + t"})";
  for (int i = 1; i < 100'000; ++i) factors += R"x(, {"expression": "cos(t)"})x";
  const SceneFile file = read_scene_text(
      R"({"schema_version": 1, "bodies": [{"name": "a", "kind": "point_mass", "mass": 1}],
          "loads": [{"at": "a", "force": [1, 0, 0],
          "law": {"kind": "product", "factors": [)" +
          factors + R"(]}}], "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1}})",
      "product");
  ASSERT_TRUE(file.ok()) << file.problems.front().text();
  EXPECT_NEAR(file.scene.point_loads.front().law.at(1e-3).value, 1.001 * std::pow(std::cos(1e-3), 99'999), 1e-9);
}

}  // namespace
}  // namespace bough::io
