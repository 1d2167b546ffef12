// Sections and bodies of a file that are given by shapes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/scene/shapes.hpp"
#include "support/source_dir.hpp"

namespace bough::io {
namespace {

std::string scene_with(const std::string& section, const std::string& more = "") {
  return R"({"schema_version": 1, "materials": [{"name": "m", "young": 2e11, "shear": 8e10, "density": 7800}],
    "sections": [{"name": "s", )" +
         section + R"(}], "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
    "beams": [{"name": "beam", "section": "s", "start": "a", "end": "b", "axis_2": [0, 1, 0], "elements": 1}],
    "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a", "position": [0, 0, 0]}],
    "loads": [{"name": "load", "at": "b", "force": [0, 100, 200]}],
    "analysis": {"kind": "static"})" +
         more + "}";
}

std::string rows_of(const scene::Mat6& K) {
  std::string text = "[";
  for (int i = 0; i < 6; ++i) {
    text += i > 0 ? ",[" : "[";
    for (int j = 0; j < 6; ++j) {
      if (j > 0) text += ',';
      append_number(text, K(i, j));
    }
    text += ']';
  }
  return text + "]";
}

TEST(SceneShapes, a_section_by_its_outline_is_the_section_by_the_numbers_of_its_figures) {
  for (const char* shape : {R"({"kind": "ellipse", "width": 0.04, "height": 0.02})",
                            R"({"kind": "box", "width": 0.04, "height": 0.02, "thickness": 0.002})",
                            R"({"kind": "i", "width": 0.04, "height": 0.06, "web": 0.002, "flange": 0.003})",
                            R"({"kind": "c", "width": 0.04, "height": 0.06, "web": 0.002, "flange": 0.003})",
                            R"({"kind": "l", "width": 0.04, "height": 0.06, "thickness": 0.002})"}) {
    const std::string by_shape = std::string("\"material\": \"m\", \"shape\": ") + shape;
    const SceneFile shaped = read_scene_text(scene_with(by_shape), "shaped");
    for (const Problem& p : shaped.problems) ADD_FAILURE() << p.text();
    ASSERT_EQ(shaped.scene.sections.size(), 1u) << shape;
    const scene::Section& s = shaped.scene.sections[0];
    ASSERT_TRUE(s.shape.has_value());
    const std::string by_numbers =
        "\"stiffness\": " + rows_of(s.stiffness) + ", \"mass\": " + rows_of(s.mass) + ", \"outline\": " + shape;
    const SceneFile given = read_scene_text(scene_with(by_numbers), "given");
    for (const Problem& p : given.problems) ADD_FAILURE() << p.text();
    ASSERT_EQ(given.scene.sections.size(), 1u) << shape;
    const scene::Section& g = given.scene.sections[0];
    EXPECT_EQ(g.shape->index(), s.shape->index());
    const scene::AreaFigures f = scene::area_figures(*s.shape);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        EXPECT_EQ(g.stiffness(i, j), s.stiffness(i, j)) << shape << i << j;
        EXPECT_EQ(g.mass(i, j), s.mass(i, j)) << shape << i << j;
      }
    EXPECT_EQ(s.stiffness(0, 0), 2e11 * f.area);
    EXPECT_EQ(s.stiffness(4, 4), 2e11 * f.second_moment_2);
    EXPECT_EQ(s.mass(5, 5), 7800 * f.second_moment_3);
  }
}

TEST(SceneShapes, a_polygon_is_exact_and_asks_for_what_is_not_computed) {
  const std::string points = R"("points": [[0, 0], [0.04, 0], [0.04, 0.02], [0, 0.02]])";
  const SceneFile good =
      read_scene_text(scene_with(R"("material": "m", "shear_factors": [0.8, 0.9], "shape": {"kind": "polygon", )" +
                                 points + R"(, "torsion_constant": 7e-8})"),
                      "good");
  for (const Problem& p : good.problems) ADD_FAILURE() << p.text();
  ASSERT_EQ(good.scene.sections.size(), 1u);
  const scene::Mat6& K = good.scene.sections[0].stiffness;
  EXPECT_NEAR(K(0, 0), 2e11 * 8e-4, 1e-6);
  EXPECT_NEAR(K(4, 4), 2e11 * 0.04 * std::pow(0.02, 3) / 12.0, 1e-9);
  EXPECT_NEAR(K(3, 3), 8e10 * 7e-8, 1e-9);
  const SceneFile bad =
      read_scene_text(scene_with(R"("material": "m", "shape": {"kind": "polygon", )" + points + "}"), "bad");
  std::string told;
  for (const Problem& p : bad.problems) told += p.text() + "\n";
  EXPECT_NE(told.find("shear_factors"), std::string::npos) << told;
  EXPECT_NE(told.find("torsion_constant"), std::string::npos) << told;
}

TEST(SceneShapes, impossible_outlines_are_told_with_their_place) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"kind": "box", "width": 0.04, "height": 0.02, "thickness": 0.01})", "/sections/0/shape/thickness"},
      {R"({"kind": "i", "width": 0.04, "height": 0.02, "web": 0.05, "flange": 0.001})", "/sections/0/shape/web"},
      {R"({"kind": "c", "width": 0.04, "height": 0.02, "web": 0.001, "flange": 0.01})", "/sections/0/shape/flange"},
      {R"({"kind": "tube", "outer_radius": 0.04, "inner_radius": 0.05})", "/sections/0/shape/inner_radius"},
      {R"({"kind": "polygon", "torsion_constant": 1, "points": [[0, 0], [1, 1], [1, 0], [0, 1]]})",
       "/sections/0/shape"},
      {R"({"kind": "polygon", "torsion_constant": 1, "points": [[0, 0], [0, 1], [1, 0]]})", "clockwise"},
      {R"({"kind": "l", "width": 0, "height": 0.02, "thickness": 0.01})", "/sections/0/shape/width"},
  };
  for (const auto& [shape, words] : cases) {
    const SceneFile file = read_scene_text(
        scene_with(std::string(R"("material": "m", "shear_factors": [1, 1], "shape": )") + shape), "bad");
    std::string told;
    for (const Problem& p : file.problems) told += p.text() + "\n";
    EXPECT_NE(told.find(words), std::string::npos) << shape << "\n" << told;
  }
}

TEST(SceneShapes, of_open_sections_a_warning_says_that_warping_is_left_out) {
  const SceneFile file = read_scene_text(
      scene_with(R"("material": "m", "shape": {"kind": "l", "width": 0.04, "height": 0.06, "thickness": 0.002})"), "l");
  std::string told;
  for (const Problem& p : file.warnings) told += p.text() + "\n";
  EXPECT_NE(told.find("warping"), std::string::npos) << told;
}

TEST(SceneShapes, bodies_take_mass_and_inertia_of_theirs) {
  const SceneFile file = read_scene_text(R"({"schema_version": 1, "bodies": [
    {"name": "ring", "density": 1000, "shape": {"kind": "ring", "outer_radius": 0.2, "inner_radius": 0.1, "length": 0.1, "axis": 3}},
    {"name": "cone", "mass": 2, "position": [1, 0, 0], "shape": {"kind": "cone", "radius": 0.2, "length": 0.4}},
    {"name": "pill", "mass": 2, "position": [2, 0, 0], "shape": {"kind": "capsule", "radius": 0.2, "length": 0.4}},
    {"name": "bar", "density": 1000, "position": [3, 0, 0],
     "shape": {"kind": "extrusion", "length": 0.5, "points": [[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]]}}],
    "analysis": {"kind": "dynamic", "end_time": 1}})",
                                         "bodies");
  for (const Problem& p : file.problems) ADD_FAILURE() << p.text();
  ASSERT_EQ(file.scene.bodies.size(), 4u);
  EXPECT_NEAR(file.scene.bodies[0].mass, 1000 * 3.14159265358979 * 0.03 * 0.1, 1e-9);
  EXPECT_NEAR(file.scene.bodies[1].inertia(0, 0), 0.3 * 2 * 0.04, 1e-15) << "a full cone: 3/10 m R^2";
  EXPECT_NEAR(file.scene.bodies[3].mass, 10.0, 1e-12);
  EXPECT_NEAR(file.scene.bodies[3].inertia(0, 0), 10.0 * (0.04 + 0.01) / 12.0, 1e-12);
  for (const scene::Body& b : file.scene.bodies) EXPECT_TRUE(b.shape.has_value()) << b.name;
}

TEST(SceneShapes, the_scenes_of_the_gallery_are_read_without_a_problem) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_dir() / "data" / "gallery")) {
    const SceneFile file = read_scene(entry.path());
    for (const Problem& p : file.problems) ADD_FAILURE() << entry.path() << ": " << p.text();
    ++count;
  }
  EXPECT_GE(count, 6);
}

}  // namespace
}  // namespace bough::io
