#pragma once
/// Scenes on which orders of convergence are measured.
#include "support/scenes.hpp"

namespace bough::run {

/// Ball joint, then a hinge askew: no symmetry, no dependent rows, gyroscopic terms and a spring with a damper.
inline scene::Scene spatial_pendulum() {
  return support::scene_of(R"({
    "gravity": [0.3, -1.0, -9.81],
    "bodies": [
      {"name": "a", "mass": 2, "inertia": [0.3, 0.5, 0.4], "center_of_mass": [0.5, 0.1, 0]},
      {"name": "b", "mass": 1, "inertia": [0.05, 0.1, 0.12], "position": [1, 0.2, 0.1], "center_of_mass": [0.3, 0, -0.2]}],
    "joints": [
      {"name": "ball", "kind": "spherical", "first": "ground", "second": "a", "position": [0, 0, 0]},
      {"name": "hinge", "kind": "revolute", "first": "a", "second": "b", "position": [1, 0.2, 0.1], "axis": [1, 2, -1]}],
    "springs": [{"name": "spring", "first": {"to": "ground", "position": [0, 0, 2]}, "second": {"to": "b", "position": [0.5, 0, 0]},
                 "stiffness": 20, "rest_length": 1.5, "damping": 0.5}],
    "initial_velocities": [{"of": "a", "angular_velocity": [1, 2, 3]}, {"of": "b", "angular_velocity": [4, 1, 2]}],
    "analysis": {"kind": "dynamic", "end_time": 1, "tolerance": 1e-12}})");
}

/// A hinge driven in time carries a body on a universal joint.
inline scene::Scene driven_pendulum() {
  return support::scene_of(R"({
    "gravity": [0.3, -1.0, -9.81],
    "bodies": [
      {"name": "a", "mass": 2, "inertia": [0.3, 0.5, 0.4], "center_of_mass": [0.5, 0.1, 0]},
      {"name": "b", "mass": 1, "inertia": [0.05, 0.1, 0.12], "position": [1, 0.2, 0.1], "center_of_mass": [0.3, 0, -0.2]}],
    "joints": [
      {"name": "motor", "kind": "revolute", "first": "ground", "second": "a", "position": [0, 0, 0], "axis": [1, 0.3, 2],
       "drives": [{"law": {"expression": "0.4*sin(3*t) + 0.6*t^2 + 0.5*t^3"}}]},
      {"name": "cross", "kind": "universal", "first": "a", "second": "b", "position": [1, 0.2, 0.1], "axis": [0, 1, 0], "second_axis": [0, 0, 1]}],
    "initial_velocities": [{"of": "b", "angular_velocity": [1, 2, 2]}],
    "analysis": {"kind": "dynamic", "end_time": 1, "tolerance": 1e-12}})");
}

/// A soft beam on a driven hinge with a body at its tip; the drive starts smoothly.
inline scene::Scene driven_beam() {
  return support::scene_of(R"({
    "sections": [{"name": "soft", "stiffness": {"EA": 400, "GA2": 200, "GA3": 200, "GJ": 5, "EI2": 10, "EI3": 8},
                  "mass": {"mass_per_length": 1, "rotary": [0.02, 0.01, 0.01]}}],
    "nodes": [{"name": "root"}],
    "bodies": [{"name": "tip", "mass": 0.5, "inertia": [0.02, 0.03, 0.04], "position": [1, 0, 0], "center_of_mass": [0.1, 0.1, 0.2]}],
    "beams": [{"name": "beam", "section": "soft", "start": "root", "end": "tip", "elements": 2, "order": 2}],
    "joints": [{"name": "motor", "kind": "revolute", "first": "ground", "second": "root", "position": [0, 0, 0], "axis": [0, 1, 3],
                "drives": [{"law": {"expression": "2*t^2"}}]}],
    "analysis": {"kind": "dynamic", "end_time": 1, "tolerance": 1e-12}})");
}

}  // namespace bough::run
