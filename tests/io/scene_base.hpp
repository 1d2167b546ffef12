#pragma once
/// A small good scene that touches every list, for tests that spoil it in one place.
#include <string>

namespace bough::io::test {

inline const std::string& base_scene() {
  static const std::string text = R"({
  "schema_version": 1,
  "title": "base",
  "gravity": [0, 0, -9.81],
  "frames": [ { "name": "bench", "position": [0, 0, 1], "rotation": { "axis": [0, 0, 1], "angle": 0.5 } } ],
  "materials": [ { "name": "steel", "young": 2.1e11, "poisson": 0.3, "density": 7850 } ],
  "sections": [
    { "name": "bar", "shape": { "kind": "rectangle", "width": 0.02, "height": 0.04 }, "material": "steel" },
    { "name": "plain", "stiffness": { "EA": 1e6, "GA2": 1e6, "GA3": 1e6, "GJ": 10, "EI2": 20, "EI3": 30 }, "mass": { "mass_per_length": 2, "rotary": [0.2, 0.1, 0.1] } }
  ],
  "nodes": [
    { "name": "root" },
    { "name": "knee", "position": [1, 0, 0] },
    { "name": "tip", "position": [1, 0, -1] }
  ],
  "bodies": [
    { "name": "cart", "mass": 2, "inertia": [0.1, 0.2, 0.25], "position": [0, 2, 0] },
    { "name": "bob", "kind": "point_mass", "mass": 0.5, "position": [0, 2, -1] }
  ],
  "beams": [
    { "name": "upper", "section": "bar", "start": "root", "end": "knee", "axis_2": [0, 1, 0], "elements": 4 },
    { "name": "lower", "section": "plain", "start": "knee", "end": "tip", "elements": 2, "order": 2 }
  ],
  "joints": [
    { "name": "clamp", "kind": "fixed", "first": "ground", "second": "root" },
    { "name": "rail", "kind": "prismatic", "first": "ground", "second": "cart", "position": [0, 2, 0], "axis": [1, 0, 0] },
    { "name": "hinge", "kind": "revolute", "first": "cart", "second": "bob", "position": [0, 2, 0], "axis": [0, 1, 0], "forces": [ { "damping": 0.1 } ] }
  ],
  "springs": [ { "name": "coil", "first": "tip", "second": "cart", "stiffness": 10 } ],
  "bushings": [ { "name": "rubber", "first": "tip", "second": "ground", "stiffness": [1, 1, 1, 2, 2, 2] } ],
  "loads": [
    { "name": "push", "at": "tip", "force": [1, 0, 0], "law": { "kind": "ramp", "end_time": 0.5 } },
    { "beam": "upper", "force": [0, 0, -1] }
  ],
  "motions": [ ],
  "initial_velocities": [ { "of": "cart", "velocity": [1, 0, 0] } ],
  "sensors": [
    { "name": "tip", "kind": "position", "at": "tip" },
    { "name": "root force", "kind": "section_force", "beam": "upper", "station": 0 },
    { "name": "angle", "kind": "joint_angle", "joint": "hinge" },
    { "name": "energy", "kind": "total_energy" }
  ],
  "analysis": { "kind": "dynamic", "end_time": 1, "step_size": 1e-3, "spectral_radius": 0.9 },
  "solver": { "form": "local" },
  "output": { "stride": 2 },
  "expected": [ { "quantity": "tip.x", "time": 1, "value": 1, "tolerance": 5 } ]
}
)";
  return text;
}

/// The base scene with one piece of text replaced; empty where the piece is not in it exactly once.
inline std::string spoilt(const std::string& from, const std::string& to) {
  std::string text = base_scene();
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) return {};
  return text.replace(at, from.size(), to);
}

}  // namespace bough::io::test
