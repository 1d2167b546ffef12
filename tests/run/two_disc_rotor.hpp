#pragma once
#include <string>
#include <utility>

#include "support/scenes.hpp"

namespace bough::verify {

/// What differs from example to example.
struct RotorVariant {
  double bearing_y = 1e6, bearing_z = 1e6;  ///< stiffnesses [N/m]
  bool is_overhung = false;                 ///< the second disc is at the end, behind its bearing, and alone
};

/// A shaft with two discs in two bearings that hold it at points, all turning about the shaft's axis. Friswell, Penny,
/// Garvey, Lees, Dynamics of Rotating Machines, 2010, examples 5.9.1 and 5.9.5.
/// speed: a number or a formula in JSON [rad/s]. more: further keys of the scene.
inline std::string two_disc_rotor(const std::string& speed, double damping, const std::string& analysis,
                                  const std::string& more = "", const RotorVariant& variant = {}) {
  using support::text;
  const double EA = 211e9 * 3.141592653589793 * 0.025 * 0.025, GA = 81.2e9 * EA / 211e9 * 0.8863063568,
               EI = EA * 0.025 * 0.025 / 4.0, GJ = 2.0 * EI * 81.2e9 / 211e9, m = 7810.0 * EA / 211e9,
               J = 7810.0 * EI / 211e9;
  const auto disc = [](const std::string& name, double x, double mass, double across, double polar) {
    return R"({"name": ")" + name + R"(", "mass": )" + text(mass) + R"(, "inertia": [)" + text(polar) + ", " +
           text(across) + ", " + text(across) + R"(], "position": [)" + text(x) + ", 0, 0]}";
  };
  const auto bearing = [&](const std::string& at, double x) {
    std::string springs;
    for (const auto& [axis, place] : {std::pair{"y", ", 10, 0]"}, std::pair{"z", ", 0, 10]"}})
      springs += std::string(springs.empty() ? "" : ", ") + R"({"name": ")" + at + " " + axis +
                 R"(", "first": {"to": "ground", "position": [)" + text(x) + place + R"(}, "second": ")" + at +
                 R"(", "stiffness": )" + text(*axis == 'y' ? variant.bearing_y : variant.bearing_z) +
                 R"(, "rest_length": 10, "damping": )" + text(damping) + "}";
    return springs;
  };
  const std::string first_disc =
      variant.is_overhung ? "" : disc("one", 0.5, 32.58972765, 0.1780892826, 0.3295636209) + ", ";
  std::string spins;
  for (const std::string of : {"left", "middle", "right", "two", "one"})
    if (of != "one" || !variant.is_overhung)
      spins += std::string(spins.empty() ? "" : ", ") + R"({"of": ")" + of + R"(", "angular_velocity": [)" + speed +
               ", 0, 0]}";
  return "{" + more + R"("sections": [{"name": "shaft", "stiffness": {"EA": )" + text(EA) + R"(, "GA2": )" + text(GA) +
         R"(, "GA3": )" + text(GA) + R"(, "GJ": )" + text(GJ) + R"(, "EI2": )" + text(EI) + R"(, "EI3": )" + text(EI) +
         R"(}, "mass": {"mass_per_length": )" + text(m) + R"(, "rotary": [)" + text(2.0 * J) + ", " + text(J) + ", " +
         text(J) + R"(]}}],
    "nodes": [{"name": "a"}, {"name": "b", "position": [0.5, 0, 0]}, {"name": "c", "position": [1, 0, 0]}, {"name": "d", "position": [1.5, 0, 0]}],
    "bodies": [)" +
         first_disc + disc("two", variant.is_overhung ? 1.5 : 1.0, 51.52526111, 0.4235805841, 0.8050822049) + R"(],
    "beams": [{"name": "left", "section": "shaft", "start": "a", "end": "b", "axis_2": [0, 1, 0], "elements": 6, "order": 3},
              {"name": "middle", "section": "shaft", "start": "b", "end": "c", "axis_2": [0, 1, 0], "elements": 6, "order": 3},
              {"name": "right", "section": "shaft", "start": "c", "end": "d", "axis_2": [0, 1, 0], "elements": 6, "order": 3}],
    "springs": [)" +
         bearing("a", 0.0) + ", " + (variant.is_overhung ? bearing("c", 1.0) : bearing("d", 1.5)) + R"(],
    "motions": [{"name": "thrust bearing", "at": "a", "x": 0}],
    "joints": [)" +
         (variant.is_overhung ? "" : R"({"name": "shrink 1", "kind": "fixed", "first": "b", "second": "one"}, )") +
         R"({"name": "shrink 2", "kind": "fixed", "first": ")" + (variant.is_overhung ? "d" : "c") +
         R"(", "second": "two"}],
    "initial_velocities": [)" +
         spins + R"(],
    "analysis": )" +
         analysis + "}";
}

}  // namespace bough::verify
