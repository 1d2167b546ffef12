/// What pictures of a run hold, and how many of them there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bough/io/read_scene.hpp"
#include "bough/run/simulate.hpp"
#include "bough/scene/outlines.hpp"

namespace bough::run {
namespace {

class Pictures : public records::Recorder {
 public:
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame& frame) override { frames.push_back(frame); }
  void parts(const records::MotionParts& told) override { all_parts = told; }
  void end(const records::Summary& told) override { summary = told; }

  std::vector<records::MotionFrame> frames;
  records::MotionParts all_parts;
  records::Summary summary;
};

Pictures pictures_of(const std::string& text) {
  const io::SceneFile file = io::read_scene_text(text, "test");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.problems.front().text());
  Pictures pictures;
  simulate(file.scene, {}, pictures);
  return pictures;
}

const std::string bar = R"("schema_version": 1, "sections": [{"name": "bar",
  "stiffness": {"EA": 1e6, "GA2": 1e6, "GA3": 1e6, "GJ": 100, "EI2": 100, "EI3": 100},
  "mass": {"mass_per_length": 1, "rotary": [1e-3, 1e-3, 1e-3]}}])";

TEST(Pictures, line_loads_are_arrows_along_their_beam_that_follow_law_and_axes) {
  const Pictures p = pictures_of("{" + bar + R"(,
    "nodes": [{"name": "root"}, {"name": "tip", "position": [2, 0, 0]}],
    "beams": [{"name": "beam", "section": "bar", "start": "root", "end": "tip", "elements": 4}],
    "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "root", "position": [0, 0, 0]}],
    "loads": [{"name": "wind", "beam": "beam", "force": [0, 0, -3], "axes": "body", "law": {"expression": "t"}},
              {"name": "weight", "at": "tip", "force": [0, 5, 0]}],
    "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 0.05}, "output": {"motion": true}})");
  ASSERT_FALSE(p.frames.empty());
  std::size_t along = 0, at_point = 0;
  for (const records::MotionFrame& f : p.frames) {
    ASSERT_EQ(f.arrows.size(), p.frames.front().arrows.size());
    for (const records::Arrow& a : f.arrows) {
      const double size = std::hypot(a.force[0], a.force[1], a.force[2]);
      EXPECT_EQ(a.is_per_length, a.name == "wind");
      EXPECT_NEAR(size, a.is_per_length ? 3.0 * f.time : 5.0, 1e-12);
      (a.is_per_length ? along : at_point) += 1;
    }
  }
  EXPECT_EQ(at_point, p.frames.size());
  EXPECT_EQ(along, 5 * p.frames.size()) << "one at each node";
}

TEST(Pictures, springs_and_dampers_are_told_apart) {
  const Pictures p = pictures_of(R"({"schema_version": 1,
    "bodies": [{"name": "a", "kind": "point_mass", "mass": 1}],
    "springs": [
      {"name": "s", "first": "a", "second": {"to": "ground", "position": [1, 0, 0]}, "stiffness": 4},
      {"name": "d", "first": "a", "second": {"to": "ground", "position": [0, 1, 0]}, "damping": 2, "stiffness": 0},
      {"name": "b", "first": "a", "second": {"to": "ground", "position": [0, 0, 1]}, "stiffness": 4, "damping": 2}],
    "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01}, "output": {"motion": true}})");
  ASSERT_FALSE(p.frames.empty());
  std::map<std::string, std::string> kinds;
  for (std::size_t k = 0; k < p.frames[0].links.size(); ++k)
    kinds[p.frames[0].links[k].name] = p.all_parts.links.at(k).kind;
  EXPECT_EQ(kinds["s"], "spring");
  EXPECT_EQ(kinds["d"], "damper");
  EXPECT_EQ(kinds["b"], "spring and damper");
}

/// Largest distance of a surface's points along axis 0 to 2 from the centre of mass.
double reach(const scene::Mesh& mesh, std::size_t axis) {
  double most = 0.0;
  for (const auto& p : mesh.points) most = std::max(most, std::abs(p[axis]));
  return most;
}

TEST(Pictures, bodies_without_a_shape_are_solids_of_their_inertia_or_bars_to_where_they_are_held) {
  // A disc of radius 0.5 and length 0.2, Jt = m (3 r^2 + l^2)/12, and a cuboid of 0.6 x 0.4 x 0.2,
  // J1 = m (b^2 + c^2)/12.
  const Pictures p = pictures_of(R"({"schema_version": 1,
    "bodies": [
      {"name": "disc", "mass": 2, "inertia": [0.1316666666666667, 0.25, 0.1316666666666667], "position": [5, 0, 0]},
      {"name": "ball", "mass": 2.5, "inertia": [0.04, 0.04, 0.04], "position": [10, 0, 0]},
      {"name": "block", "mass": 12, "inertia": [0.2, 0.4, 0.52], "position": [15, 0, 0]},
      {"name": "link", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0],
       "rotation": {"axis": [0, 0, 1], "angle": 0.4}},
      {"name": "end", "kind": "point_mass", "mass": 1, "position": [3, 0, 0]}],
    "joints": [
      {"name": "pin", "kind": "revolute", "first": "ground", "second": "link", "position": [0, 0, 0],
       "axis": [0, 0, 1]},
      {"name": "ball joint", "kind": "spherical", "first": "link", "second": "end", "position": [3, 0, 0]}],
    "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.05}, "output": {"motion": true}})");
  ASSERT_FALSE(p.frames.empty());
  std::map<std::string, scene::Mesh> of;
  for (std::size_t k = 0; k < p.frames[0].bodies.size(); ++k)
    if (p.all_parts.bodies.at(k) >= 0)
      of[p.frames[0].bodies[k].name] = p.all_parts.meshes.at(static_cast<std::size_t>(p.all_parts.bodies[k]));
  ASSERT_EQ(of.size(), 4u) << "a point mass has no surface";
  EXPECT_NEAR(reach(of["disc"], 1), 0.1, 1e-9);
  EXPECT_NEAR(reach(of["disc"], 0), 0.5, 0.006) << "polygons of the circle's area";
  EXPECT_NEAR(scene::volume_of(of["disc"]), 0.25 * 3.14159265358979 * 0.2, 1e-9);
  EXPECT_NEAR(reach(of["ball"], 2), 0.2, 0.003);
  EXPECT_NEAR(reach(of["block"], 0), 0.3, 1e-9);
  EXPECT_NEAR(reach(of["block"], 1), 0.2, 1e-9);
  EXPECT_NEAR(reach(of["block"], 2), 0.1, 1e-9);
  // Bars of radius 0.1 from (1, 0, 0) to (0, 0, 0) and (3, 0, 0), in axes turned by 0.4.
  EXPECT_NEAR(reach(of["link"], 0), 2.0 * std::cos(0.4) + 0.1 * std::sin(0.4), 0.002);
  EXPECT_NEAR(reach(of["link"], 1), 2.0 * std::sin(0.4) + 0.1 * std::cos(0.4), 0.002);
  EXPECT_NEAR(reach(of["link"], 2), 0.1, 0.002);
  EXPECT_NEAR(scene::volume_of(of["link"]), 0.01 * 3.14159265358979 * 3.0, 1e-9) << "triangles face outwards";
}

// A frame on an arm: 2 m along x, turned by 3 t about y, in one that goes up by t^2.
TEST(Pictures, moving_frames_are_where_their_laws_put_them) {
  const Pictures p = pictures_of(R"({"schema_version": 1,
    "frames": [{"name": "lift", "position": [0.5, 0, {"expression": "t^2"}]},
               {"name": "arm", "frame": "lift", "position": [2, 0, 0],
                "turns": [{"axis": [0, 1, 0], "angle": {"expression": "3*t"}}]}],
    "bodies": [{"name": "a", "kind": "point_mass", "mass": 1}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1}, "output": {"motion": true}})");
  ASSERT_GT(p.frames.size(), 5u);
  for (const records::MotionFrame& f : p.frames) {
    ASSERT_EQ(f.frames.size(), 2u);
    const records::FramePose &lift = f.frames[0], &arm = f.frames[1];
    EXPECT_EQ(lift.name, "lift");
    EXPECT_EQ(arm.name, "arm");
    const double up = f.time * f.time;
    for (const auto& [pose, x] : {std::pair{&lift, 0.5}, std::pair{&arm, 2.5}}) {
      EXPECT_NEAR(pose->position[0], x, 1e-14);
      EXPECT_NEAR(pose->position[1], 0.0, 1e-14);
      EXPECT_NEAR(pose->position[2], up, 1e-14);
    }
    EXPECT_NEAR(arm.axes[0], std::cos(3.0 * f.time), 1e-14);
    EXPECT_NEAR(std::abs(arm.axes[2]), std::abs(std::sin(3.0 * f.time)), 1e-14);
    EXPECT_EQ(lift.axes[0], 1.0);
  }
}

/// A rotor at 5 rad/s, of one blade.
std::string rotor(double end_time, const std::string& output, double step = 0.01) {
  return R"({"schema_version": 1,
    "bodies": [{"name": "hub", "mass": 1, "inertia": [1, 1, 1]}],
    "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "hub", "axis": [0, 0, 1],
      "drives": [{"law": 5, "rate": true}]}],
    "initial_velocities": [{"of": "hub", "angular_velocity": [0, 0, 5]}],
    "analysis": {"kind": "dynamic", "end_time": )" +
         std::to_string(end_time) + R"(, "step_size": )" + std::to_string(step) + R"(}, "output": )" + output + "}";
}

// 100 s are eighty turns: with pictures at equal times alone, five radians would lie between two.
TEST(Pictures, are_taken_wherever_a_part_has_turned) {
  const Pictures p = pictures_of(rotor(100.0, R"({"motion": true})"));
  EXPECT_GT(p.frames.size(), 1000u);
  std::size_t for_others = 0;
  for (std::size_t k = 1; k < p.frames.size(); ++k) {
    const double turned = 5.0 * (p.frames[k].time - p.frames[k - 1].time);
    EXPECT_LE(turned, 0.31) << "a quarter of a radian, and a step";
    EXPECT_NEAR(p.frames[k].turn, turned, 1e-9);
    for_others += p.frames[k].for_others ? 1 : 0;
  }
  EXPECT_LE(for_others, 101u) << "programs that draw nothing between pictures get those at equal times";
  EXPECT_GE(for_others, 99u);
  for (const std::string& note : p.summary.notes) EXPECT_EQ(note.find("turns by more"), std::string::npos) << note;
}

TEST(Pictures, that_lie_too_far_apart_are_told) {
  const Pictures p = pictures_of(rotor(10.0, R"({"motion": true, "motion_stride": 50})"));
  EXPECT_EQ(p.frames.size(), 21u) << "a stride is followed";
  EXPECT_NEAR(p.frames[1].turn, 2.5, 1e-9);
  bool is_told = false;
  for (const std::string& note : p.summary.notes)
    is_told |= note.find("turns by more than 0.75 rad") != std::string::npos;
  EXPECT_TRUE(is_told);
}

TEST(Pictures, of_a_small_structure_every_picture_is_a_file_for_other_programs_too) {
  const Pictures p = pictures_of(R"({"schema_version": 1,
    "bodies": [{"name": "a", "kind": "point_mass", "mass": 1}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.001}, "output": {"motion": true}})");
  EXPECT_EQ(p.frames.size(), 101u);
  for (const records::MotionFrame& f : p.frames) EXPECT_TRUE(f.for_others);
  for (const std::string& note : p.summary.notes) EXPECT_EQ(note.find("pictures are kept"), std::string::npos) << note;
}

}  // namespace
}  // namespace bough::run
