// Files that a scene names: where they may lie, what is wrong with them, and what comes of them.
#include "../../src/io/scene_files.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "bough/io/atomic_file.hpp"
#include "bough/io/read_scene.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

const std::string square =
    "# a square with a hole\n-0.1, -0.1\n0.1 -0.1\n+0.1;0.1\n-0.1,0.1\n\n-.05,-.05\n.05,-.05\n.05,.05\n-.05,.05\n";

std::string section_scene(const std::string& shape) {
  return R"({"schema_version": 1, "materials": [{"name": "m", "young": 2e11, "poisson": 0.3, "density": 7800}],
    "sections": [{"name": "s", "material": "m", "shear_factors": [0.8, 0.8], "shape": )" +
         shape + R"(}], "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
    "beams": [{"name": "beam", "section": "s", "start": "a", "end": "b", "elements": 1}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1}})";
}
std::string body_scene(const std::string& looks) {
  return R"({"schema_version": 1, "bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1],
    "center_of_mass": [0.5, 0, 0], "looks": )" +
         looks + R"(}], "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1}})";
}

/// Of a cube with edges of 2 about (1, 1, 1), as text.
std::string cube_obj() {
  std::string text;
  for (int k = 0; k < 8; ++k)
    text += "v " + std::to_string(2 * (k & 1)) + " " + std::to_string(k & 2) + " " + std::to_string((k & 4) / 2) + "\n";
  return text + "f 1 3 4 2\nf 5/1 6/2 8/3 7/4\nf 1//1 2//1 6//1 5//1\nf -6 -2 -1 -5\nf 1 5 7 3\nf 2 4 8 6\n";
}

std::string stl_of(const scene::Mesh& mesh) {
  std::string bytes(80, ' ');
  const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const int corner : t)
      for (const double x : mesh.points[static_cast<std::size_t>(corner)]) put(static_cast<float>(x));
    put(std::uint16_t{0});
  }
  return bytes;
}

std::string first_problem(const SceneFile& file) { return file.ok() ? "" : file.problems.front().text(); }

TEST(SceneFiles, an_outline_from_a_file_is_that_of_its_points) {
  const ScratchDirectory scratch;
  write_file(scratch / "box.csv", square);
  write_file(scratch / "turned.csv",
             "-.1 .1\n.1 .1\n.1 -.1\n-.1 -.1\n-.1 .1\n\n-.05,-.05\n-.05,.05\n.05,.05\n.05,-.05\n");
  const std::string points = R"({"kind": "polygon", "torsion_constant": 1e-4,
    "points": [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]],
    "holes": [[[-0.05, -0.05], [-0.05, 0.05], [0.05, 0.05], [0.05, -0.05]]]})";
  const SceneFile expected = read_scene_text(section_scene(points), "s");
  ASSERT_TRUE(expected.ok()) << first_problem(expected);
  for (const char* name : {"box.csv", "turned.csv"}) {
    const std::string shape = std::string(R"({"kind": "polygon", "torsion_constant": 1e-4, "file": ")") + name + "\"}";
    const SceneFile got = read_scene_text(section_scene(shape), "s", {}, scratch.path());
    ASSERT_TRUE(got.ok()) << first_problem(got);
    const scene::Section &a = got.scene.sections.at(0), &b = expected.scene.sections.at(0);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        EXPECT_NEAR(a.stiffness(i, j), b.stiffness(i, j), 1e-12 * std::abs(b.stiffness(i, i)) + 1e-6);
        EXPECT_NEAR(a.mass(i, j), b.mass(i, j), 1e-12 * std::abs(b.mass(0, 0)));
      }
    // EA and EI of the hollow square in closed form.
    EXPECT_NEAR(a.stiffness(0, 0), 2e11 * (0.04 - 0.01), 1e-3);
    EXPECT_NEAR(a.stiffness(4, 4), 2e11 * (0.2 * 0.008 - 0.1 * 0.001) / 12.0, 1e-5);
    EXPECT_NE(got.hash, read_scene_text(section_scene(shape), "s").hash) << "the file belongs to the hash";
  }
}

TEST(SceneFiles, surfaces_from_obj_and_stl_enclose_the_same_volume_and_stand_at_the_centre_of_mass) {
  const ScratchDirectory scratch;
  write_file(scratch / "cube.obj", cube_obj());
  const auto read = mesh_of_text(cube_obj(), ".obj");
  ASSERT_EQ(read.index(), 0u);
  write_file(scratch / "cube.STL", stl_of(std::get<0>(read)));
  for (const char* name : {"cube.obj", "cube.STL"}) {
    const SceneFile file = read_scene_text(body_scene(std::string(R"({"file": ")") + name + R"(", "scale": 0.5})"), "s",
                                           {}, scratch.path());
    ASSERT_TRUE(file.ok()) << first_problem(file);
    const scene::Mesh& mesh = *file.scene.bodies.at(0).looks;
    EXPECT_EQ(mesh.points.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_NEAR(std::abs(scene::volume_of(mesh)), 1.0, 1e-12);
    for (const auto& x : mesh.points) EXPECT_NEAR(std::abs(x[0]), 0.5, 1e-12);  // of 0 to 1, from 0.5
  }
}

TEST(SceneFiles, files_lie_below_the_scene_after_links_are_resolved) {
  const ScratchDirectory scratch;
  fs::create_directories(scratch / "scene/shapes");
  write_file(scratch / "outside.obj", cube_obj());
  write_file(scratch / "scene/shapes/cube.obj", cube_obj());
  fs::create_symlink(scratch / "outside.obj", scratch / "scene/link.obj");
  fs::create_symlink("shapes/cube.obj", scratch / "scene/inner.obj");
  const auto problem = [&](const std::string& name) {
    return first_problem(read_scene_text(body_scene(R"({"file": ")" + name + "\"}"), "s", {}, scratch / "scene"));
  };
  EXPECT_EQ(problem("shapes/cube.obj"), "");
  EXPECT_EQ(problem("inner.obj"), "");
  for (const char* name : {"../outside.obj", "link.obj", "shapes/../../outside.obj"})
    EXPECT_NE(problem(name).find("does not lie below the folder of the scene"), std::string::npos) << problem(name);
  EXPECT_NE(problem((scratch / "outside.obj").string()).find("has to be relative"), std::string::npos);
  EXPECT_NE(problem("none.obj").find("there is no such file"), std::string::npos);
  EXPECT_NE(problem("shapes").find("this is a directory, not a file"), std::string::npos) << problem("shapes");
  EXPECT_NE(problem("none.obj").find("/bodies/0/looks/file"), std::string::npos);
  EXPECT_NE(first_problem(read_scene_text(body_scene(R"({"file": "cube.obj"})"), "s")).find("read from a file itself"),
            std::string::npos);
}

TEST(SceneFiles, bad_texts_are_told_with_their_line_or_byte) {
  const auto words = [](const auto& outcome) {
    return outcome.index() == 1 ? std::get<1>(outcome) : std::string("good");
  };
  EXPECT_EQ(words(outline_of_text("0,0\n1,x\n")), "line 2: a corner is two finite numbers");
  EXPECT_EQ(words(outline_of_text("0,0\n1,inf\n")), "line 2: a corner is two finite numbers");
  EXPECT_EQ(words(outline_of_text("# nothing\n\n")), "the file holds no corners");
  EXPECT_NE(words(outline_of_text([] {
              std::string many;
              for (int k = 0; k < 600; ++k) many += std::to_string(k) + ",0\n";
              return many;
            }()))
                .find("more than 500"),
            std::string::npos);
  EXPECT_EQ(words(mesh_of_text("v 0 0\n", ".obj")), "line 1: a vertex has three finite coordinates");
  EXPECT_EQ(words(mesh_of_text("v 0 0 0\nf 1 2 3\n", ".obj")), "line 2: a face names vertices that stand before it");
  EXPECT_EQ(words(mesh_of_text("v 0 0 0\nf 1 1\n", ".obj")), "line 2: a face has at least three vertices");
  EXPECT_EQ(words(mesh_of_text("", ".obj")), "the file holds no triangles");
  EXPECT_EQ(words(mesh_of_text("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1e999\n", ".stl")),
            "line 4: a vertex has three finite coordinates");
  EXPECT_EQ(words(mesh_of_text("solid x\nnonsense\n", ".stl")), "line 2: this is no word of STL");
  EXPECT_NE(words(mesh_of_text("PK", ".stl")).find("this is no STL"), std::string::npos);
  EXPECT_NE(words(mesh_of_text("x", ".ply")).find(".stl or .obj"), std::string::npos);
  std::string stl = stl_of(std::get<0>(mesh_of_text(cube_obj(), ".obj")));
  const float bad = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(stl.data() + 84 + 12, &bad, sizeof bad);
  EXPECT_EQ(words(mesh_of_text(stl, ".stl")), "byte 96: a coordinate is not a finite number");
  EXPECT_NE(words(mesh_of_text(stl.substr(0, stl.size() - 1), ".stl")).find("this is no STL"), std::string::npos);
}

TEST(SceneFiles, an_outline_that_crosses_itself_is_a_problem_of_its_file) {
  const ScratchDirectory scratch;
  write_file(scratch / "eight.csv", "0,0\n2,1\n2,0\n0,1.5\n");
  const SceneFile file = read_scene_text(
      section_scene(R"({"kind": "polygon", "torsion_constant": 1, "file": "eight.csv"})"), "s", {}, scratch.path());
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.problems.front().pointer, "/sections/0/shape/file") << first_problem(file);
}

}  // namespace
}  // namespace bough::io
