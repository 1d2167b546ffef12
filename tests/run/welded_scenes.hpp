#pragma once
/// Frames of beams and bodies tied by fixed joints, as JSON text.
#include <ostream>
#include <string>
#include <vector>

namespace bough::run {

/// Two beams that meet at a corner, a lump with a bead at the end of the second and a knob at the corner, tied by
/// fixed joints, three of them in a loop. In the plane of x and z, or bent out of it.
inline std::string frame_scene(bool bends, const std::string& held, const std::string& rest) {
  const std::string y = bends ? "0.3" : "0", out = bends ? "1" : "0";
  const std::string joint = held.find("hinge") != std::string::npos ? "hinge" : "clamp";
  const std::string grip = R"json(, {"name": "grip", "kind": "joint_reaction", "joint": ")json" + joint + "\"}";
  return R"json({"gravity": [0, 0, -9.81],
    "sections": [{"name": "bar", "stiffness": {"EA": 8.4e6, "GA2": 2.7e6, "GA3": 2.7e6, "GJ": 180, "EI2": 280, "EI3": 280},
      "mass": {"mass_per_length": 3.14, "rotary": [2.1e-4, 1.05e-4, 1.05e-4]}, "damping": {"time": 1e-4}}],
    "nodes": [{"name": "root"}, {"name": "knee", "position": [1, 0, 0]}, {"name": "start", "position": [1, 0, 0.05]},
      {"name": "tip", "position": [1, )json" +
         y + R"json(, -0.7]}],
    "bodies": [{"name": "lump", "mass": 0.5, "inertia": [0.01, 0.02, 0.03], "position": [1.05, )json" +
         y + R"json(, -0.8],
        "rotation": {"axis": [0, 1, 0], "angle": 0.4}, "center_of_mass": [0.02, 0, -0.03]},
      {"name": "bead", "kind": "point_mass", "mass": 0.1, "position": [1.2, )json" +
         y + R"json(, -0.9]},
      {"name": "knob", "mass": 0.2, "inertia": [0.002, 0.003, 0.004], "position": [1.1, 0, 0.1], "rotation": {"axis": [)json" +
         out + R"json(, 1, 0], "angle": 1.1}}],
    "beams": [{"name": "arm", "section": "bar", "start": "root", "end": "knee", "axis_2": [0, 1, 0], "elements": 2, "order": 2},
      {"name": "leg", "section": "bar", "start": "start", "end": "tip", "axis_2": [0, 1, 0], "elements": 2, "order": 3}],
    "springs": [{"name": "rope", "first": {"to": "ground", "position": [0, 0, 0.5]},
      "second": {"to": "knob", "position": [0.05, 0, 0]}, "stiffness": 40, "rest_length": 0.9, "damping": 0.2}],
    "loads": [{"name": "push", "at": {"to": "lump", "position": [0.1, 0, 0]}, "axes": "body", "force": [2, )json" +
         out + R"json(, 3]},
      {"name": "twist", "at": "knob", "moment": [0, 1.5, )json" +
         out + R"json(]}],
    "sensors": [{"name": "lump", "kind": "position", "at": {"to": "lump", "position": [0.1, 0, 0.2]}},
      {"name": "turn", "kind": "rotation", "at": "lump"}, {"name": "knob", "kind": "position", "at": "knob"},
      {"name": "tip", "kind": "position", "at": "tip"}, {"name": "split", "kind": "acceleration_split", "at": "lump", "frames": ["knob"], "frame": "knob"},
      {"name": "speed", "kind": "velocity", "at": "lump", "axes": "body"}, {"name": "rush", "kind": "acceleration", "at": "lump"},
      {"name": "arm", "kind": "section_force", "beam": "arm", "station": 1},
      {"name": "leg", "kind": "section_force", "beam": "leg", "station": 0},
      {"name": "kinetic", "kind": "kinetic_energy"}, {"name": "strain", "kind": "strain_energy"},
      {"name": "energy", "kind": "total_energy"})json" +
         (held.empty() ? "" : grip) + R"json(], "joints": [)json" + held +
         R"json({"name": "corner", "kind": "fixed", "first": "knee", "second": "start", "position": [1, 0, 0.02]},
      {"name": "hold", "kind": "fixed", "first": "tip", "second": "lump", "position": [1, 0, -0.75]},
      {"name": "wire", "kind": "fixed", "first": "bead", "second": "lump", "position": [1.1, 0, -0.8]},
      {"name": "stud", "kind": "fixed", "first": "knob", "second": "knee", "position": [1, 0, 0.1]},
      {"name": "stay", "kind": "fixed", "first": "knob", "second": "start", "position": [1, 0, 0.1]}])json" +
         rest + "}";
}

struct WeldedScene {
  std::string name, text;
};
inline void PrintTo(const WeldedScene& scene, std::ostream* out) { *out << scene.name; }

inline std::vector<WeldedScene> welded_scenes() {
  const auto analysis = [](const std::string& more, const std::string& kind = "") {
    return more + R"json(, "analysis": {)json" +
           (kind.empty() ? R"json("kind": "dynamic", "end_time": 0.3, "step_size": 0.002)json" : kind) + "}";
  };
  const std::string
      hinge = R"json({"name": "hinge", "kind": "revolute", "first": "ground", "second": "root", "position": [0, 0, 0],
    "axis": [0, 1, 0]}, )json",
      slanted = R"json({"name": "hinge", "kind": "revolute", "first": "ground", "second": "root",
    "position": [0, 0, 0], "axis": [0.6, 0, 0.8]}, )json",
      clamp = R"json({"name": "clamp", "kind": "fixed", "first": "ground",
    "second": "root"}, )json",
      at_corner = R"json({"name": "clamp", "kind": "fixed", "first": "ground",
    "second": "knob", "position": [1.1, 0, 0.1]}, )json",
      on_table = R"json({"name": "clamp", "kind": "fixed", "first": "table", "second": "root"}, )json";
  const std::string statics = R"json("kind": "static", "load_steps": 4)json",
                    in_time = R"json("kind": "dynamic", "end_time": 0.3, "step_size": 0.002, )json";
  const std::string shaker =
      R"json(, "motions": [{"name": "shaker", "at": "lump", "x": 0, "y": {"expression": "0.01*(1 - cos(30*t))"},
      "z": {"expression": "0.02*(1 - cos(20*t))"}, "rotation": {"axis": [0, 1, 0], "angle": {"expression": "0.3*(1 - cos(5*t))"}}}])json";
  const std::string table =
      R"json(, "frames": [{"name": "table", "position": [0, 0, {"expression": "0.05*(1 - cos(8*t))"}],
    "turns": [{"axis": [0, 0, 1], "angle": {"expression": "3*t^2"}}]}])json";
  const std::string spin = R"json(, "initial_velocities": [
      {"of": "arm", "velocity": [0.5, 0, 0], "angular_velocity": [0, 2, 0]}, {"of": "leg", "velocity": [0.6, 0, -2], "angular_velocity": [0, 2, 0]},
      {"of": "lump", "velocity": [-1.1, 0, -2.1], "angular_velocity": [0, 2, 0]}, {"of": "bead", "velocity": [-1.3, 0, -2.4], "angular_velocity": [0, 2, 0]}, {"of": "knob", "velocity": [0.7, 0, -2.2], "angular_velocity": [0, 2, 0]}])json";
  return {{"in_a_plane", frame_scene(false, hinge, analysis(""))},
          {"of_a_plane_in_space", frame_scene(false, hinge, analysis(R"json(, "without": ["planar"])json"))},
          {"in_space", frame_scene(true, slanted, analysis(""))},
          {"clamped", frame_scene(true, clamp, analysis(""))},
          {"held_at_the_corner", frame_scene(true, at_corner, analysis(""))},
          {"held_at_the_corner_in_statics", frame_scene(true, at_corner, analysis("", statics))},
          {"flying", frame_scene(true, "", analysis(spin))},
          {"flying_in_a_plane", frame_scene(false, "", analysis(spin))},
          {"by_bdf", frame_scene(true, slanted, analysis("", in_time + R"json("integrator": "bdf")json"))},
          {"variational", frame_scene(true, slanted, analysis("", in_time + R"json("integrator": "variational")json"))},
          {"in_statics", frame_scene(true, clamp, analysis("", statics))},
          {"in_statics_in_a_plane", frame_scene(false, clamp, analysis("", statics))},
          {"shaken", frame_scene(true, "", analysis(shaker))},
          {"shaken_in_statics", frame_scene(true, "", analysis(shaker, statics))},
          {"on_a_frame", frame_scene(true, on_table, analysis(table))},
          {"seen_from_a_frame", frame_scene(true, on_table, analysis(table, in_time + R"json("frame": "table")json"))}};
}

}  // namespace bough::run
