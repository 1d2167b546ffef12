#pragma once
/// Columns, strips and frames that lose stability at loads known in closed form.
#include <string>

#include "support/scenes.hpp"

namespace bough::verify {

/// Section of L/h = 20 with EI = 1 and L = 1, as in the table of critical loads: EA = 12 (L/h)^2 EI / L^2, GA = EA /
/// 3.12.
inline std::string column_section(double slenderness, double EI2 = 1.0, double EI3 = 1.0, double GJ = 1.0) {
  const double EA = 12.0 * slenderness * slenderness, GA = EA / 3.12;
  return R"("sections": [{"name": "bar", "stiffness": {"EA": )" + support::text(EA) + R"(, "GA2": )" +
         support::text(GA) + R"(, "GA3": )" + support::text(GA) + R"(, "GJ": )" + support::text(GJ) + R"(, "EI2": )" +
         support::text(EI2) + R"(, "EI3": )" + support::text(EI3) + "}}],";
}

/// A column of length 1 along x, clamped at 0, pressed by `load` at its free end, and by `side` times that along y.
inline scene::Scene clamped_column(double load, const std::string& analysis, double side = 0.0,
                                   const std::string& more_load = "") {
  return support::scene_of("{" + column_section(20.0) + R"(
    "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
    "beams": [{"name": "column", "section": "bar", "start": "root", "end": "tip", "elements": 8, "order": 2}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
    "loads": [{"name": "press", "at": "tip", "force": [)" +
                           support::text(-load) + ", " + support::text(side * load) + ", 0]" + more_load + R"(}],
    "sensors": [{"name": "tip", "kind": "position", "at": "tip"}],
    "analysis": {"kind": "static", )" +
                           analysis + "}}");
}

/// The same on a hinge at 0 and a hinge at its pressed end that slides along x.
inline scene::Scene hinged_column(double load, const std::string& analysis, const std::string& more_load = "") {
  return support::scene_of("{" + column_section(20.0) + R"(
    "nodes": [{"name": "foot"}, {"name": "head", "position": [1, 0, 0]}],
    "bodies": [{"name": "slider", "position": [1, 0, 0], "mass": 1, "inertia": [1, 1, 1]}],
    "beams": [{"name": "column", "section": "bar", "start": "foot", "end": "head", "elements": 8, "order": 2}],
    "joints": [{"name": "lower", "kind": "revolute", "first": "ground", "second": "foot", "axis": [0, 0, 1]},
               {"name": "upper", "kind": "revolute", "first": "slider", "second": "head", "axis": [0, 0, 1]},
               {"name": "guide", "kind": "prismatic", "first": "ground", "second": "slider", "axis": [1, 0, 0]}],
    "loads": [{"name": "press", "at": "head", "force": [)" +
                           support::text(-load) + ", 0, 0]" + more_load + R"(}],
    "sensors": [{"name": "head", "kind": "position", "at": "head"}],
    "analysis": {"kind": "static", )" +
                           analysis + "}}");
}

/// A strip of length 1 along x, clamped at 0, EI = 1 about z and `strong` about y, GJ = 1; `load` along -z at its end,
/// and `side` times that along y.
inline scene::Scene strip(double load, double strong, const std::string& analysis, double side = 0.0) {
  return support::scene_of("{" + column_section(1000.0, strong, 1.0, 1.0) + R"(
    "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
    "beams": [{"name": "strip", "section": "bar", "start": "root", "end": "tip", "elements": 8, "order": 2}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
    "loads": [{"name": "weight", "at": "tip", "force": [0, )" +
                           support::text(side * load) + ", " + support::text(-load) + R"(]}],
    "sensors": [{"name": "tip", "kind": "position", "at": "tip"}],
    "analysis": {"kind": "static", )" +
                           analysis + "}}");
}

/// Two legs of length 240 along x and y, clamped at the origin, of a strip 30 by 0.6 (E = 71240, nu = 0.31) that is
/// high in the frame's plane; `load` in that plane at the end, and `side` times that out of it.
inline scene::Scene right_angle_frame(double load, double side, const std::string& analysis) {
  return support::scene_of(R"({
    "sections": [{"name": "strip", "stiffness": {"EA": 1282320, "GA2": 407875, "GA3": 407875, "GJ": 58750,
                                                 "EI2": 38470, "EI3": 96174000}}],
    "nodes": [{"name": "root"}, {"name": "corner", "position": [240, 0, 0]},
              {"name": "tip", "position": [240, -240, 0]}],
    "beams": [{"name": "first", "section": "strip", "start": "root", "end": "corner", "axis_2": [0, 1, 0],
               "elements": 6, "order": 2},
              {"name": "second", "section": "strip", "start": "corner", "end": "tip", "axis_2": [1, 0, 0],
               "elements": 6, "order": 2}],
    "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
    "loads": [{"name": "pull", "at": "tip", "force": [)" +
                           support::text(load) + ", 0, " + support::text(side * load) + R"(]}],
    "sensors": [{"name": "tip", "kind": "position", "at": "tip"}],
    "analysis": {"kind": "static", )" +
                           analysis + "}}");
}

}  // namespace bough::verify
