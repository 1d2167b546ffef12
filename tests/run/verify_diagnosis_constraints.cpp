/// Diagnosis corpus: too many constraints, too few.
#include "verify_diagnosis_cases.hpp"

namespace bough::verify {

namespace {

/// A block of 1 kg at the origin or elsewhere.
std::string block(const std::string& name, const std::string& position = "[0, 0, 0]") {
  return R"({"name": ")" + name + R"(", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": )" + position + "}";
}

const std::string dynamic = R"("analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01})";
const std::string statics = R"("analysis": {"kind": "static"})";
const std::string section =
    R"("sections": [{"name": "s", "stiffness": {"EA": 1e4, "GA2": 1e4, "GA3": 1e4, "GJ": 10, "EI2": 10, "EI3": 10}}])";
const std::string heavy_section =
    R"("sections": [{"name": "s", "stiffness": {"EA": 1e4, "GA2": 1e4, "GA3": 1e4, "GJ": 10, "EI2": 10, "EI3": 10},
                     "mass": {"mass_per_length": 1, "rotary": [0.02, 0.01, 0.01]}}])";
const std::string beam = R"("nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
    "beams": [{"name": "beam", "section": "s", "start": "root", "end": "tip", "elements": 4}])";
const std::string tip_load = R"("loads": [{"name": "load", "at": "tip", "force": [0, 1, 0]}])";
const std::string falling = R"("gravity": [0, -9.81, 0])";

template <class... Parts>
std::string scene_of(const std::string& first, const Parts&... rest) {
  std::string text = first;
  ((text += ", ", text += rest), ...);
  return text;
}

std::string bodies(const std::string& list) { return "\"bodies\": [" + list + "]"; }
std::string joints(const std::string& list) { return "\"joints\": [" + list + "]"; }
std::string motions(const std::string& list) { return "\"motions\": [" + list + "]"; }

std::string hinge(const std::string& name, const std::string& first, const std::string& second,
                  const std::string& position, const std::string& axis = "[0, 0, 1]", const std::string& more = "") {
  return R"({"name": ")" + name + R"(", "kind": "revolute", "first": ")" + first + R"(", "second": ")" + second +
         R"(", "position": )" + position + R"(, "axis": )" + axis + more + "}";
}
std::string weld(const std::string& name, const std::string& first, const std::string& second,
                 const std::string& position = "[0, 0, 0]") {
  return R"({"name": ")" + name + R"(", "kind": "fixed", "first": ")" + first + R"(", "second": ")" + second +
         R"(", "position": )" + position + "}";
}

/// A closed triangle of three rods in the plane: rigid.
const std::string triangle_bodies =
    bodies(block("AB", "[0.5, 0, 0]") + ", " + block("BC", "[0.5, 0.5, 0]") + ", " + block("CA", "[0, 0.5, 0]"));
const std::string triangle_hinges = hinge("B", "AB", "BC", "[1, 0, 0]") + ", " + hinge("C", "BC", "CA", "[0, 1, 0]") +
                                    ", " + hinge("A2", "AB", "CA", "[0, 0, 0]");

/// Four-bar of rigid bars with the last hinge turned by 5 degrees: locks.
const std::string tilted_bar =
    bodies(block("AB", "[0, 0.06, 0]") + ", " + block("BC", "[0.12, 0.12, 0]") + ", " + block("CD", "[0.24, 0.06, 0]"));

}  // namespace

std::vector<Diagnosis> over_constrained_cases() {
  const std::string drive = R"(, "drives": [{"law": 1, "rate": true}])";
  return {
      {"two welds between the same bodies",
       Fate::runs,
       {"depend on others", "first weld", "second weld"},
       scene_of(bodies(block("a") + ", " + block("b", "[1, 0, 0]")),
                joints(hinge("pin", "ground", "a", "[0, 0, 0]") + ", " + weld("first weld", "a", "b", "[1, 0, 0]") +
                       ", " + weld("second weld", "a", "b", "[0.5, 0, 0]")),
                falling, dynamic)},
      {"two welds in statics",
       Fate::runs,
       {"depend on others", "first weld", "second weld"},
       scene_of(section, beam,
                joints(weld("first weld", "ground", "root") + ", " + weld("second weld", "ground", "root")), tip_load,
                statics)},
      {"door on two hinges in line",
       Fate::runs,
       {"depend on others", "upper", "lower"},
       scene_of(bodies(block("door", "[0.5, 0, 0]")),
                joints(hinge("upper", "ground", "door", "[0, 0, 1]") + ", " +
                       hinge("lower", "ground", "door", "[0, 0, -1]")),
                falling, dynamic)},
      {"planar four-bar with spatial hinges",
       Fate::runs,
       {"depend on others", "'A'", "'B'", "'C'", "'D'"},
       scene_of(
           bodies(block("AB", "[0, 0.5, 0]") + ", " + block("BC", "[1, 1, 0]") + ", " + block("CD", "[2, 0.5, 0]")),
           joints(hinge("A", "ground", "AB", "[0, 0, 0]") + ", " + hinge("B", "AB", "BC", "[0, 1, 0]") + ", " +
                  hinge("C", "BC", "CD", "[2, 1, 0]") + ", " + hinge("D", "ground", "CD", "[2, 0, 0]")),
           falling, dynamic)},
      {"two drives that agree",
       Fate::runs,
       {"depend on others", "upper", "lower"},
       scene_of(bodies(block("door", "[0.5, 0, 0]")),
                joints(hinge("upper", "ground", "door", "[0, 0, 1]", "[0, 0, 1]", drive) + ", " +
                       hinge("lower", "ground", "door", "[0, 0, -1]", "[0, 0, 1]", drive)),
                dynamic)},
      {"two drives that contradict each other",
       Fate::fails,
       {"upper", "lower", "contradict"},
       scene_of(bodies(block("door", "[0.5, 0, 0]")),
                joints(hinge("upper", "ground", "door", "[0, 0, 1]", "[0, 0, 1]", drive) + ", " +
                       hinge("lower", "ground", "door", "[0, 0, -1]", "[0, 0, 1]",
                             R"(, "drives": [{"law": 2, "rate": true}])")),
                dynamic)},
      {"two drives that part later",
       Fate::fails,
       {"upper", "lower"},
       scene_of(bodies(block("door", "[0.5, 0, 0]")),
                joints(hinge("upper", "ground", "door", "[0, 0, 1]", "[0, 0, 1]",
                             R"(, "drives": [{"law": {"expression": "t^2"}}])") +
                       ", " +
                       hinge("lower", "ground", "door", "[0, 0, -1]", "[0, 0, 1]",
                             R"(, "drives": [{"law": {"expression": "2*t^2"}}])")),
                dynamic)},
      {"drive on a rigid triangle",
       Fate::fails,
       {"A"},
       scene_of(triangle_bodies,
                joints(hinge("A", "ground", "AB", "[0, 0, 0]") + ", " + triangle_hinges + ", " +
                       hinge("lock", "ground", "CA", "[0, 1, 0]", "[0, 0, 1]", drive)),
                dynamic)},
      {"rigid four-bar with a tilted hinge, driven",
       Fate::fails,
       {"hinge"},
       scene_of(
           tilted_bar,
           joints(hinge("A hinge", "ground", "AB", "[0, 0, 0]", "[0, 0, 1]",
                        R"(, "drives": [{"law": -0.6, "rate": true}])") +
                  ", " + hinge("B hinge", "AB", "BC", "[0, 0.12, 0]") + ", " +
                  hinge("C hinge", "BC", "CD", "[0.24, 0.12, 0]", "[0, -0.08715574274765817, 0.9961946980917455]") +
                  ", " + hinge("D hinge", "ground", "CD", "[0.24, 0, 0]")),
           R"("analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01})")},
      {"weld with a gap",
       Fate::refused,
       {"/joints/0", "weld", "apart"},
       scene_of(bodies(block("a")),
                R"("joints": [{"name": "weld", "kind": "fixed", "first": {"to": "ground", "position": [0, 0, 0]},
                                                   "second": {"to": "a", "position": [0.1, 0, 0]}}])",
                dynamic)},
      {"triangle whose last bar is too long",
       Fate::refused,
       {"/joints/3", "apart"},
       scene_of(triangle_bodies,
                R"("joints": [)" + hinge("A", "ground", "AB", "[0, 0, 0]") + ", " +
                    hinge("B", "AB", "BC", "[1, 0, 0]") + ", " + hinge("C", "BC", "CA", "[0, 1, 0]") +
                    R"(, {"name": "A2", "kind": "spherical", "first": {"to": "AB", "position": [-0.5, 0, 0]},
                                                           "second": {"to": "CA", "position": [0, -0.52, 0]}}])",
                dynamic)},
      {"prescribed motion against a weld",
       Fate::fails,
       {"clamp", "push"},
       scene_of(bodies(block("a")), joints(weld("clamp", "ground", "a")),
                motions(R"({"name": "push", "at": "a", "x": {"expression": "t^2"}})"), dynamic)},
      {"prescribed motion against a clamp in statics",
       Fate::fails,
       {"clamp", "push"},
       scene_of(section, beam, joints(weld("clamp", "ground", "root")),
                motions(R"({"name": "push", "at": "root", "x": {"expression": "0.1*t"}})"), statics)},
      {"two prescribed motions of one node",
       Fate::refused,
       {"/motions/1", "twice"},
       scene_of(
           section, beam, joints(weld("clamp", "ground", "root")),
           motions(
               R"({"name": "left", "at": "tip", "y": {"expression": "-0.1*t"}}, {"name": "right", "at": "tip", "y": {"expression": "0.1*t"}})"),
           statics)},
  };
}

std::vector<Diagnosis> under_constrained_cases() {
  return {
      {"beam that nothing holds, in statics",
       Fate::fails,
       {"singular", "nothing holds"},
       scene_of(section, beam, tip_load, statics)},
      {"beam on one hinge, in statics",
       Fate::fails,
       {"singular", "'beam'", "turn about the axis (0, 0, 1)", "joint 'hinge'"},
       scene_of(section, beam, joints(hinge("hinge", "ground", "root", "[0, 0, 0]")), tip_load, statics)},
      {"beam on a ball joint, in statics",
       Fate::fails,
       {"singular", "'beam'", "turn about", "joint 'ball'"},
       scene_of(
           section, beam,
           joints(
               R"({"name": "ball", "kind": "spherical", "first": "ground", "second": "root", "position": [0, 0, 0]})"),
           tip_load, statics)},
      {"support missing along the axis",
       Fate::fails,
       {"singular", "'beam'", "move along (1, 0, 0)", "joint 'slide'"},
       scene_of(
           section, beam,
           joints(
               R"({"name": "slide", "kind": "prismatic", "first": "ground", "second": "root", "position": [0, 0, 0], "axis": [1, 0, 0]})"),
           tip_load, statics)},
      {"beam cut by a hinge",
       Fate::fails,
       {"singular", "'second'", "turn about the axis (0, 0, 1) through (1, 0, 0)", "joint 'cut'"},
       scene_of(
           section,
           R"("nodes": [{"name": "root"}, {"name": "left"}, {"name": "right", "position": [1, 0, 0]}, {"name": "start", "position": [1, 0, 0]},
                                      {"name": "tip", "position": [2, 0, 0]}],
                            "beams": [{"name": "first", "section": "s", "start": "root", "end": "right", "elements": 2},
                                      {"name": "second", "section": "s", "start": "start", "end": "tip", "elements": 2}])",
           joints(weld("clamp", "ground", "root") + ", " + weld("unused", "ground", "left") + ", " +
                  hinge("cut", "right", "start", "[1, 0, 0]")),
           tip_load, statics)},
      {"two structures, one of them loose",
       Fate::fails,
       {"singular", "loose"},
       scene_of(
           section,
           R"("nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}, {"name": "a", "position": [0, 1, 0]}, {"name": "b", "position": [1, 1, 0]}],
                            "beams": [{"name": "held", "section": "s", "start": "root", "end": "tip"}, {"name": "loose", "section": "s", "start": "a", "end": "b", "elements": 2}])",
           joints(weld("clamp", "ground", "root")), tip_load, statics)},
      {"body without support, in statics",
       Fate::fails,
       {"singular", "'a'"},
       scene_of(bodies(block("a")), falling, statics)},
      {"arm on a frictionless hinge, level, in statics",
       Fate::fails,
       {"singular", "'arm'", "joint 'hinge'"},
       scene_of(bodies(block("arm", "[1, 0, 0]")), joints(hinge("hinge", "ground", "arm", "[0, 0, 0]")), falling,
                statics)},
      {"mass on two springs in a plane, in statics",
       Fate::fails,
       {"singular", "'m'"},
       scene_of(
           bodies(R"({"name": "m", "kind": "point_mass", "mass": 1, "position": [0, -1, 0]})"),
           R"("springs": [{"name": "l", "first": {"to": "ground", "position": [-1, 0, 0]}, "second": "m", "stiffness": 100, "rest_length": 1.4142135623730951},
                               {"name": "r", "first": {"to": "ground", "position": [1, 0, 0]}, "second": "m", "stiffness": 100, "rest_length": 1.4142135623730951}])",
           falling, statics)},
      {"beam without mass, in dynamics",
       Fate::refused,
       {"mass"},
       scene_of(section, beam, joints(weld("clamp", "ground", "root")), tip_load, dynamic)},
      {"body without inertia on a hinge",
       Fate::fails,
       {"'a'", "inertia"},
       scene_of(bodies(R"({"name": "a", "mass": 1, "inertia": [0, 0, 0], "position": [0, 0, 0]})"),
                joints(hinge("hinge", "ground", "a", "[0, 0, 0]")), dynamic)},
      {"massless body that moves freely",
       Fate::refused,
       {"bodies"},
       scene_of(bodies(R"({"name": "a", "mass": 0, "inertia": [0, 0, 0], "position": [0, 0, 0]})"), dynamic)},
      {"node that nothing takes",
       Fate::refused,
       {"lonely"},
       scene_of(
           heavy_section,
           R"("nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}, {"name": "lonely", "position": [5, 0, 0]}],
                                  "beams": [{"name": "beam", "section": "s", "start": "root", "end": "tip", "elements": 4}])",
           joints(weld("clamp", "ground", "root")), dynamic)},
      {"massless rod between two ball joints, free to spin",
       Fate::fails,
       {"'link'", "inertia"},
       scene_of(
           R"("nodes": [{"name": "link", "position": [0.5, 0, 0]}])", bodies(block("a", "[1, 0, 0]")),
           joints(R"({"name": "left", "kind": "spherical", "first": "ground", "second": "link", "position": [0, 0, 0]},
                          {"name": "right", "kind": "spherical", "first": "link", "second": "a", "position": [1, 0, 0]})"),
           falling, dynamic)},
      {"massless rod between a hinge and a ball joint, which hold it",
       Fate::runs,
       {},
       scene_of(
           R"("nodes": [{"name": "link", "position": [0.5, 0, 0]}])", bodies(block("a", "[1, 0, 0]")),
           joints(hinge("hinge", "ground", "link", "[0, 0, 0]") +
                  R"(, {"name": "ball", "kind": "spherical", "first": "link", "second": "a", "position": [1, 0, 0]})"),
           falling, dynamic)},
  };
}

std::vector<Diagnosis> hard_cases() {
  const std::string long_run = R"("analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.02})";
  const std::string clamp = joints(weld("clamp", "ground", "root"));
  const std::string hung = joints(hinge("hinge", "ground", "a", "[0, 0, 0]"));
  const auto load_on = [](const std::string& node, const std::string& law) {
    return R"("loads": [{"name": "load", "at": ")" + node + R"(", "force": [0, 1, 0], "law": )" + law + "}]";
  };
  return {
      {"driven rate that starts from rest",
       Fate::runs,
       {"impulses"},
       scene_of(
           bodies(block("a", "[1, 0, 0]")),
           joints(hinge("hinge", "ground", "a", "[0, 0, 0]", "[0, 0, 1]", R"(, "drives": [{"law": 3, "rate": true}])")),
           dynamic)},
      {"driven rate that jumps on the way",
       Fate::runs,
       {"impulses", "at time 0.5"},
       scene_of(
           bodies(block("a", "[1, 0, 0]")),
           joints(hinge("hinge", "ground", "a", "[0, 0, 0]", "[0, 0, 1]",
                        R"(, "drives": [{"law": {"kind": "table", "times": [0, 0.5, 1], "values": [0, 0.5, 0]}}])")),
           long_run)},
      {"driven place that jumps",
       Fate::fails,
       {"hinge", "0.5"},
       scene_of(bodies(block("a", "[1, 0, 0]")),
                joints(hinge("hinge", "ground", "a", "[0, 0, 0]", "[0, 0, 1]",
                             R"(, "drives": [{"law": {"expression": "step(t - 0.5)*1"}}])")),
                long_run)},
      {"four-bar laid flat at the start",
       Fate::runs,
       {"depend on others"},
       scene_of(
           bodies(block("AB", "[0.5, 0, 0]") + ", " + block("BC", "[2, 0, 0]") + ", " + block("CD", "[2.5, 0, 0]")),
           joints(hinge("A", "ground", "AB", "[0, 0, 0]") + ", " + hinge("B", "AB", "BC", "[1, 0, 0]") + ", " +
                  hinge("C", "BC", "CD", "[3, 0, 0]") + ", " + hinge("D", "ground", "CD", "[2, 0, 0]")),
           falling, dynamic)},
      {"joint that would flip within a step",
       Fate::fails,
       {"half a turn"},
       scene_of(bodies(block("a")), joints(hinge("hinge", "ground", "a", "[0, 0, 0]")),
                R"("initial_velocities": [{"of": "a", "angular_velocity": [0, 0, 1000]}])",
                R"("analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1, "max_cuts": 2})")},
      {"load that is soon not a number",
       Fate::refused,
       {"/loads/0/law", "not finite"},
       scene_of(bodies(block("a")), hung, load_on("a", R"({"expression": "sqrt(0.5 - t)*1"})"), long_run)},
      {"load that is not a number for a moment",
       Fate::fails,
       {"'load'", "not finite", "0.299"},
       scene_of(bodies(block("a")), hung, load_on("a", R"({"expression": "sqrt(abs(t - 0.3) - 0.001)*1"})"), long_run)},
      {"load with a pole",
       Fate::refused,
       {"/loads/0/law", "not finite"},
       scene_of(bodies(block("a")), hung, load_on("a", R"({"expression": "1/(t - 0.5)*1"})"), long_run)},
      {"drive that is not a number",
       Fate::refused,
       {"/joints/0/drives/0", "not finite"},
       scene_of(bodies(block("a")),
                joints(hinge("hinge", "ground", "a", "[0, 0, 0]", "[0, 0, 1]",
                             R"(, "drives": [{"law": {"expression": "log(0.5 - t)*1"}}])")),
                long_run)},
      {"load that grows beyond all numbers",
       Fate::refused,
       {"/loads/0/law", "not finite"},
       scene_of(bodies(block("a")), load_on("a", R"({"expression": "exp(100*t)*1e300"})"), long_run)},
      {"load beyond all numbers in statics",
       Fate::refused,
       {"/loads/0/force", "too large to be computed with"},
       scene_of(section, beam, clamp, load_on("tip", R"({"expression": "1e300*t"})"), statics)},
      {"spring without length",
       Fate::refused,
       {"/springs/0", "coincide"},
       scene_of(
           bodies(R"({"name": "m", "kind": "point_mass", "mass": 1, "position": [0, 0, 0]})"),
           R"("springs": [{"name": "spring", "first": "ground", "second": "m", "stiffness": 100, "rest_length": 1}])",
           dynamic)},
      {"arch pushed past its limit load",
       Fate::fails,
       {"no equilibrium at load factor"},
       scene_of(
           section,
           R"("nodes": [{"name": "left", "position": [-1, 0, 0]}, {"name": "crown", "position": [0, 0.2, 0]}, {"name": "right", "position": [1, 0, 0]}],
                            "beams": [{"name": "rising", "section": "s", "start": "left", "end": "crown", "elements": 4}, {"name": "falling", "section": "s", "start": "crown", "end": "right", "elements": 4}])",
           joints(hinge("left hinge", "ground", "left", "[-1, 0, 0]") + ", " +
                  hinge("right hinge", "ground", "right", "[1, 0, 0]")),
           R"("loads": [{"name": "load", "at": "crown", "force": [0, -70, 0]}], "analysis": {"kind": "static", "load_steps": 10, "max_cuts": 4})")},
      {"beam driven through half a turn an element",
       Fate::fails,
       {"beam", "half a turn"},
       scene_of(
           section,
           R"("nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}], "beams": [{"name": "beam", "section": "s", "start": "root", "end": "tip", "elements": 1}])",
           clamp,
           motions(
               R"({"name": "twist", "at": "tip", "x": 0, "y": 0, "z": 0, "rotation": {"axis": [1, 0, 0], "angle": {"expression": "3.3*t"}}})"),
           R"("analysis": {"kind": "static", "load_steps": 20})")},
      {"joint of the ground with itself",
       Fate::refused,
       {"/joints/0"},
       scene_of(bodies(block("a")), joints(hinge("hinge", "ground", "ground", "[0, 0, 0]")), dynamic)},
  };
}

}  // namespace bough::verify
