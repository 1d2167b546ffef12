#include <algorithm>
#include <cmath>
#include <numeric>

#include "bough/scene/analysis_kinds.hpp"
#include "bough/scene/joint_efforts.hpp"
#include "bough/scene/linear_inputs.hpp"
#include "bough/scene/moving_frame.hpp"
#include "bough/scene/nearest_name.hpp"
#include "bough/scene/spin.hpp"
#include "problem_list.hpp"

namespace bough::scene {
namespace {

std::string list_of(const std::vector<std::string>& words) {
  std::string r;
  for (const std::string& w : words) r += (r.empty() ? "" : ", ") + w;
  return r;
}

/// Checks the frames of an acceleration split: each moves in the previous one, so none may occur twice, nor the ground
/// at all.
void check_chain(ProblemList& list, std::size_t i) {
  const Sensor& s = list.scene.sensors[i];
  std::unordered_set<std::string> before;
  for (std::size_t k = 0; k < s.chain.size(); ++k) {
    const std::string key = "frames/" + std::to_string(k);
    if (!before.insert(s.chain[k]).second)
      list.add("sensors", i, key, s.chain[k], "this frame stands in the chain already");
    else if (s.chain[k].empty() || s.chain[k] == "ground")
      list.add("sensors", i, key, "ground", "has to be a frame, a node or a body, not the ground",
               "the chain starts in the inertial frame by itself");
    else
      list.check_place("sensors", i, key, s.chain[k], true);
  }
}

/// Checks that a joint has the coordinate that is measured; if it has several, the sensor has to name one.
void check_coordinate(ProblemList& list, std::size_t i, const JointType& joint) {
  const Sensor& s = list.scene.sensors[i];
  const std::string& wanted = type_of(s.kind).coordinate;
  const auto& known = joint.coordinates;
  if (!wanted.empty()) {
    if (joint.coordinate(wanted) == nullptr)
      list.add("sensors", i, "joint", s.joint, "a " + joint.name + " joint has no " + wanted);
  } else if (known.empty()) {
    list.add(
        "sensors", i, "joint", s.joint,
        "a " + joint.name + " joint has no coordinate" +
            (s.kind == SensorKind::joint_effort ? " along which an effort could act" : " whose rate could be taken"));
  } else if (s.coordinate.empty() && known.size() > 1) {
    list.add("sensors", i, "", s.name,
             "a " + joint.name + " joint has two " + (s.kind == SensorKind::joint_effort ? "efforts" : "rates") +
                 ": say of which coordinate",
             "write \"coordinate\": \"" + known[0].name + "\" or \"coordinate\": \"" + known[1].name + "\"");
  } else if (!s.coordinate.empty() && joint.coordinate(s.coordinate) == nullptr) {
    list.add("sensors", i, "coordinate", s.coordinate,
             "a " + joint.name + " joint has the coordinate \"" + known[0].name + "\" only");
  }
}

/// Names of prescribed motions, couplings and loads. A spring with laws of its own is a strut.
std::vector<std::string> parts_with_forces(const Scene& scene) {
  std::vector<std::string> names;
  const auto add_names = [&names](const auto& items) {
    for (const auto& item : items) names.push_back(item.name);
  };
  add_names(scene.motions);
  add_names(scene.couplings);
  add_names(scene.point_loads);
  add_names(scene.line_loads);
  for (const Joint& j : scene.joints)
    if (j.kind == JointKind::strut) names.push_back(j.name);
  return names;
}

void check_sensor(ProblemList& list, std::size_t i) {
  const Sensor& s = list.scene.sensors[i];
  const SensorType& type = type_of(s.kind);
  if (!type.takes(SensorField::axes_of))
    list.check_frame("sensors", i, s.frame);
  else if (!s.frame.empty())
    list.check_place("sensors", i, "frame", s.frame, true);
  if (type.takes(SensorField::chain)) check_chain(list, i);
  if (type.of == SensorOf::whole || type.of == SensorOf::signal) return;
  if (type.of == SensorOf::subdomain) {
    if (!read_path(s.subdomain))
      list.add("sensors", i, "subdomain", s.subdomain, "is no path in the tree of sub-domains",
               "write the number of the child at each level, as \"0\" or \"0.1\"");
    if (!s.at.to.empty()) list.check_place("sensors", i, "at", s.at.to, true);
    if (s.at.to.empty() && s.axes == LoadAxes::body)
      list.add("sensors", i, "axes", "body", "the resultant of an interface belongs to no body",
               "give the node with \"at\", or leave \"axes\" out");
    return;
  }
  if (type.of == SensorOf::point && s.beam.empty()) {
    list.check_place("sensors", i, "at", s.at.to, true);
    return;
  }
  if (type.of == SensorOf::point || type.of == SensorOf::section || type.of == SensorOf::beam) {
    list.check_reference("sensors", i, "beam", s.beam, list.beams, "beam");
    if (!(s.station >= 0.0 && s.station <= 1.0))
      list.add("sensors", i, "station", text_of(s.station), "a station is a fraction of the beam's length, 0 to 1");
    return;
  }
  const bool is_of_part = type.of == SensorOf::part;
  if ((type.of == SensorOf::reaction || is_of_part) && !s.frame.empty() && s.axes == LoadAxes::body)
    list.add("sensors", i, "frame", s.frame, "a reaction is given in the axes of the body or of a frame, not of both",
             "leave one of \"axes\" and \"frame\" out");
  if (is_of_part) {
    list.check_known("sensors", i, "of", s.part, parts_with_forces(list.scene),
                     "motion, spring, bushing, coupling or load");
    return;
  }
  const bool exists = list.check_reference("sensors", i, "joint", s.joint, list.joints, "joint");
  if (!exists || type.of != SensorOf::coordinate) return;
  const Joint& joint = list.scene.joints[list.poses.find(s.joint)->index];
  check_coordinate(list, i, type_of(joint.kind));
  if (type.takes(SensorField::effort_part)) check_effort_part(list, "sensors", i, s.of, joint);
}

/// Finds tolerances that no result could meet.
void check_tolerance(ProblemList& list, const char* part, std::size_t i, const Expected& e) {
  if (e.tolerance == 0.0 && e.relative_tolerance == 0.0)
    list.add(part, i, "", "", "needs a tolerance", "give \"tolerance\", \"relative_tolerance\" or both");
  else if (!(e.allowed() > 0.0))
    list.add(part, i, "relative_tolerance", text_of(e.relative_tolerance), "is a part of the value, which is 0",
             "give a \"tolerance\", which is absolute");
}

/// Finds members that contradict each other.
void check_figure(ProblemList& list, std::size_t i) {
  const Expected& e = list.scene.expected[i];
  const std::string figure = to_string(e.figure);
  const bool is_static = !type_of(list.scene.analysis.kind).is_in_time;
  if (e.time && e.figure != FigureKind::value)
    list.add("expected", i, "time", text_of(*e.time), "a " + figure + " is one of the whole run, not of a time",
             "leave out \"time\", or take the figure \"value\"");
  if (e.level && e.figure != FigureKind::period)
    list.add("expected", i, "level", text_of(*e.level), "a level goes with the figure \"period\" alone");
  if (is_static && e.figure == FigureKind::period)
    list.add("expected", i, "figure", figure, "a period is one of time, and the analysis is static");
  check_tolerance(list, "expected", i, e);
  // A dynamic run may be shortened below the time of a figure, which is then reported as not reached. In statics the
  // load factor always ends at 1.
  if (!e.time || !(*e.time > list.last_time * (1.0 + 1e-12))) return;
  const std::string rule = "the analysis ends at " + text_of(list.last_time);
  if (is_static)
    list.add("expected", i, "time", text_of(*e.time), rule);
  else
    list.warn("expected", i, "time", text_of(*e.time), rule + ", so this figure is not reached");
}

/// "<sensor>.<component>", or "<sensor>" of one without components.
void check_quantity(ProblemList& list, const char* section, std::size_t i, const std::string& key,
                    const std::string& quantity) {
  const std::size_t dot_at = quantity.find('.');
  const std::string name = quantity.substr(0, dot_at);
  if (!list.check_reference(section, i, key, name, list.sensors, "sensor")) return;
  const auto known = components_of(list.scene.sensors[list.sensor_of.at(name)].kind);
  if (dot_at == std::string::npos) {
    if (!known.empty())
      list.add(section, i, key, quantity, "this sensor has the components " + list_of(known),
               "write \"" + name + "." + known[0] + "\"");
    return;
  }
  const std::string component = quantity.substr(dot_at + 1);
  if (std::find(known.begin(), known.end(), component) != known.end()) return;
  const std::string near = nearest_name(component, known);
  list.add(section, i, key, quantity,
           known.empty() ? "this sensor is one number without components"
                         : "this sensor has the components " + list_of(known),
           known.empty()  ? "write \"" + name + "\""
           : near.empty() ? ""
                          : "did you mean \"" + name + "." + near + "\"?");
}

/// The part of the run that a measure is taken from.
void check_window(ProblemList& list, std::size_t i, const Measure& m) {
  const Analysis& analysis = list.scene.analysis;
  const bool is_static = analysis.kind == AnalysisKind::statics;
  const double end = is_static ? 1.0 : analysis.end_time, from = m.from.value_or(0.0), to = m.to.value_or(end);
  const char* const key = m.from ? "from" : "to";
  if (m.is_of_measures)
    list.add("measures", i, key, text_of(m.from ? from : to),
             "a formula of other measures is taken from no part of the run", "give it to the measures in \"of\"");
  else if (analysis.arc_length)
    list.add("measures", i, key, text_of(m.from ? from : to),
             "along a path by arc length a load factor can come twice");
  else if (to > end)
    list.add("measures", i, "to", text_of(to), "the run ends before, at " + text_of(end));
  else if (!(from < to))
    list.add("measures", i, key, text_of(m.from ? from : to),
             "the part of the run from " + text_of(from) + " to " + text_of(to) + " is empty");
}

void check_measure(ProblemList& list, std::size_t i) {
  const Measure& m = list.scene.measures[i];
  if (m.expression.empty()) check_quantity(list, "measures", i, "quantity", m.quantity);
  if (!m.is_of_measures)
    for (const auto& [name, quantity] : m.names) check_quantity(list, "measures", i, "of/" + name, quantity);
  const std::string figure = to_string(m.kind);
  const bool is_static = !type_of(list.scene.analysis.kind).is_in_time;
  const bool is_of_time = m.kind == MeasureKind::period || m.kind == MeasureKind::dominant_frequency ||
                          m.kind == MeasureKind::settling_time;
  if (is_static && is_of_time)
    list.add("measures", i, "figure", figure, "this is a figure of time, and the analysis is static");
  if (m.kind == MeasureKind::equivalent_range && is_static && !m.cycles)
    list.add("measures", i, "", "", "needs the key \"cycles\": a static analysis has no seconds to count cycles in");
  if (m.from || m.to) check_window(list, i, m);
  if (m.time && m.kind != MeasureKind::value)
    list.add("measures", i, "time", text_of(*m.time), "a " + figure + " is one of the whole run, not of a time");
}

/// Sets of things that are joined, by union and find over the places; the last one is the ground.
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

/// Number of a place: nodes, then bodies, then beams, then the ground.
std::size_t place_number(const ProblemList& list, const std::string& name) {
  const Scene& s = list.scene;
  const std::size_t ground = s.nodes.size() + s.bodies.size() + s.beams.size();
  auto thing = list.poses.find(name);
  if (!thing && name.rfind('.') != std::string::npos) thing = list.poses.find(name.substr(0, name.rfind('.')));
  if (!thing) return ground;
  switch (thing->kind) {
    case ThingKind::node:
      return thing->index;
    case ThingKind::body:
      return s.nodes.size() + thing->index;
    case ThingKind::beam:
      return s.nodes.size() + s.bodies.size() + thing->index;
    default:
      return ground;
  }
}

/// Checks that the number of steps of `size` [s] (key `key` of the analysis) up to `end_time` is small enough for
/// consecutive times to differ in double precision.
void check_number_of_steps(ProblemList& list, double end_time, double size, const char* key) {
  constexpr double most_steps = 1e15, many_steps = 1e8;
  if (!(size > 0.0)) return;
  const double steps = end_time / size;
  if (!(steps <= most_steps))
    list.add("analysis", 0, key, text_of(size),
             "this makes " + text_of(steps) + " steps up to end_time = " + text_of(end_time) +
                 " s; more than 1e15 cannot be counted in time",
             "take a larger step or an earlier end");
  else if (steps > many_steps)
    list.warn("analysis", 0, key, text_of(size), "this makes " + text_of(steps) + " steps");
}

/// True for a joint that holds a part at rest in the ground: its constraint forces cannot oscillate.
bool is_clamp(const Joint& j) {
  const auto is_ground = [](const std::string& name) { return name.empty() || name == "ground"; };
  return j.kind == JointKind::fixed && (is_ground(j.first.to) || is_ground(j.second.to));
}

}  // namespace

void check_sensors(ProblemList& list) {
  for (std::size_t i = 0; i < list.scene.sensors.size(); ++i) check_sensor(list, i);
  for (std::size_t i = 0; i < list.scene.expected.size(); ++i) {
    check_figure(list, i);
    check_quantity(list, "expected", i, "quantity", list.scene.expected[i].quantity);
  }
  for (std::size_t i = 0; i < list.scene.measures.size(); ++i) {
    check_measure(list, i);
    if (const std::optional<Expected>& e = list.scene.measures[i].expected) check_tolerance(list, "measures", i, *e);
  }
}

namespace {

/// In an equilibrium of the start all frames but those that carry the analysis are at rest, or all that move turn as one
/// about a fixed axis: what they carry is then in equilibrium relative to them.
void check_start(ProblemList& list) {
  if (list.scene.analysis.start != StartKind::equilibrium) return;
  const auto velocities = velocities_of_frames(list.scene, list.poses);
  if (velocities && list.scene.analysis.frame.empty() && spin_of(*velocities)) return;
  const std::vector<std::size_t>& carrying = list.poses.frames().above_ground();
  for (std::size_t i = 0; i < list.scene.frames.size(); ++i) {
    const FrameDef& f = list.scene.frames[i];
    if (!f.motion || std::find(carrying.begin(), carrying.end(), i) != carrying.end()) continue;
    const motion::FrameMotion m = motion_at(*f.motion, 0.0);
    if (lanes::dot(m.velocity, m.velocity) > 0.0 || lanes::dot(m.angular_velocity, m.angular_velocity) > 0.0)
      list.add(
          "analysis", 0, type_of(list.scene.analysis.kind).is_of_instant ? "about" : "start", "equilibrium",
          "frame '" + f.name + "' moves at time 0, so what it carries is at rest in no equilibrium",
          "name that frame as `frame` of the analysis, let all frames that move turn as one about a fixed axis, let it "
          "start from rest, or leave out start");
  }
}

void check_accuracy(ProblemList& list) {
  const Scene& s = list.scene;
  if (!s.analysis.accuracy) return;
  const Accuracy& a = *s.analysis.accuracy;
  if (!(a.relative > 0.0) && !(a.absolute > 0.0))
    list.add("analysis", 0, "accuracy", "", "it asks for nothing", "give relative or absolute");
  std::vector<std::string> known;
  for (const Sensor& sensor : s.sensors) known.push_back(sensor.name);
  for (const Measure& measure : s.measures) known.push_back(measure.name);
  if (known.empty()) list.add("analysis", 0, "accuracy", "", "there is no sensor whose error it could be");
  for (std::size_t k = 0; k < a.of.size(); ++k) {
    const std::string& name = a.of[k];
    const auto is_known = [&](const std::string& of) {
      return std::find(known.begin(), known.end(), of) != known.end();
    };
    if (is_known(name) || is_known(name.substr(0, name.rfind('.')))) continue;
    const std::string near = nearest_name(name, known);
    list.add("analysis", 0, "accuracy/of/" + std::to_string(k), name, "no sensor, column or measure has this name",
             near.empty() ? "" : "did you mean '" + near + "'?");
  }
}

void check_campbell(ProblemList& list) {
  const CampbellAsked& asked = list.scene.analysis.campbell;
  if (!asked.parameter.empty() && asked.parameter.front() != '/')
    list.add("analysis", 0, "parameter", asked.parameter, "a JSON pointer begins with '/'",
             "for instance \"/parameters/speed\"");
  for (std::size_t k = 1; k < asked.values.size(); ++k)
    if (!(asked.values[k] > asked.values[k - 1])) {
      list.add("analysis", 0, "values", text_of(asked.values[k]), "values have to ascend");
      break;
    }
}

void check_linear(ProblemList& list) {
  const LinearAsked& asked = list.scene.analysis.linear;
  for (std::size_t k = 0; k < asked.inputs.size(); ++k) {
    const LinearInput& input = asked.inputs[k];
    const std::string key = "inputs/" + std::to_string(k);
    if (list.is_defective(input.of)) continue;
    const InputPlace place = place_of(list.scene, input);
    const bool is_of_component = place.hint.find("component") != std::string::npos;
    if (place.kind == InputPlace::Kind::none)
      list.add("analysis", 0, key + (is_of_component && !input.component.empty() ? "/component" : "/of"),
               is_of_component && !input.component.empty() ? input.component : input.of, place.fault, place.hint);
    for (std::size_t j = 0; j < k; ++j)
      if (name_of(asked.inputs[j]) == name_of(input))
        list.add("analysis", 0, key, name_of(input), "this input is named twice");
    for (std::size_t i = 1; i < input.spectrum.size(); ++i)
      if (!(input.spectrum[i].first > input.spectrum[i - 1].first))
        list.add("analysis", 0, key + "/spectrum/" + std::to_string(i), text_of(input.spectrum[i].first),
                 "frequencies of a spectrum have to ascend");
  }
  for (std::size_t k = 0; k < asked.outputs.size(); ++k)
    list.check_reference("analysis", 0, "outputs/" + std::to_string(k), asked.outputs[k], list.sensors, "sensor");
  if (!asked.inputs.empty() && list.scene.sensors.empty())
    list.add("analysis", 0, "outputs", "", "there is no sensor that could be an output",
             "add what is asked for to \"sensors\"");
  for (std::size_t k = 1; k < asked.frequencies.size(); ++k)
    if (!(asked.frequencies[k] > asked.frequencies[k - 1])) {
      list.add("analysis", 0, "frequencies/" + std::to_string(k), text_of(asked.frequencies[k]),
               "frequencies have to ascend");
      break;
    }
}

}  // namespace

void check_analysis(ProblemList& list) {
  const Scene& s = list.scene;
  const Analysis& a = s.analysis;
  if (s.nodes.empty() && s.bodies.empty() && list.defective.empty())
    list.add("scene", 0, "", "", "nothing here can move", "add nodes and beams, or bodies");
  if (!list.is_dynamic && a.arc_length && a.newton == Newton::single)
    list.add("analysis", 0, "newton", "single", "points of a path by arc length are solved to convergence",
             "leave out newton or arc_length");
  if (!list.is_dynamic && a.arc_length &&
      std::any_of(s.frames.begin(), s.frames.end(), [](const FrameDef& f) { return f.motion.has_value(); }))
    list.add("analysis", 0, "arc_length", "", "paths by arc length do not know frames that move",
             "inertial loads grow with the square of the speed and have no negative factor: take load_steps");
  check_accuracy(list);
  check_linear(list);
  check_campbell(list);
  if (a.arc_length && a.accuracy)
    list.add("analysis", 0, "accuracy", "", "the steps along a path are free, so that paths cannot be compared",
             "leave out accuracy or arc_length");
  if (!list.is_dynamic) return;  // no dynamics, or the analysis itself is at fault
  check_start(list);
  if (type_of(a.kind).is_of_instant) return;
  if (!(a.end_time > 0.0)) list.add("analysis", 0, "end_time", text_of(a.end_time), "has to be above 0");
  if (!(a.step_size > 0.0)) list.add("analysis", 0, "step_size", text_of(a.step_size), "has to be above 0");
  if (a.step_size > a.end_time)
    list.add("analysis", 0, "step_size", text_of(a.step_size), "the step is longer than the whole analysis");
  check_number_of_steps(list, a.end_time, a.step_size, "step_size");
  if (a.step_control && a.step_control->largest_step > 0.0)
    check_number_of_steps(list, a.end_time, a.step_control->largest_step, "step_control/largest_step");
  const bool is_variational = a.integrator == Integrator::variational;
  if (is_variational && a.newton == Newton::single)
    list.add("analysis", 0, "newton", "single",
             "the variational integrator keeps momentum and energy of solved steps only",
             "leave out newton, or take the generalized_alpha integrator");
  if (is_variational && a.step_control)
    list.add("analysis", 0, "step_control", "",
             "the variational integrator keeps energy within a bound where its steps are equal",
             "leave out step_control, or take the generalized_alpha integrator");
  const bool is_bdf = a.integrator == Integrator::bdf;
  if (is_bdf && a.step_control)
    list.add("analysis", 0, "step_control", "", "the bdf integrator takes steps of equal size",
             "leave out step_control, or take the generalized_alpha integrator");
  if (is_bdf && a.newton == Newton::single)
    list.add("analysis", 0, "newton", "single", "the bdf integrator solves its steps to convergence",
             "leave out newton, or take the generalized_alpha integrator");
  if (a.step_control && a.newton == Newton::single)
    list.add("analysis", 0, "newton", "single", "errors of steps are known only where these are solved to convergence",
             "leave out newton or step_control");
  if (a.step_control && a.errors.any())
    list.add("analysis", 0, "errors", "", "twins are compared with runs of equal steps, at equal times",
             "leave out errors or step_control");
  if (a.step_control && a.accuracy)
    list.add("analysis", 0, "accuracy", "", "it is reached by steps of equal size",
             "leave out accuracy or step_control");
  const auto frame_moves = [](const FrameDef& f) { return f.motion.has_value(); };
  if (is_variational && std::any_of(s.frames.begin(), s.frames.end(), frame_moves))
    list.add("analysis", 0, "integrator", "variational", "the variational integrator does not know frames that move",
             "take the generalized_alpha integrator");
  const bool has_motion_in_joints =
      std::any_of(s.joints.begin(), s.joints.end(), [](const Joint& j) { return !is_clamp(j); });
  if (!is_variational && !is_bdf && a.spectral_radius == 1.0 && (has_motion_in_joints || !s.motions.empty()))
    list.add("analysis", 0, "spectral_radius", "1",
             "with joints other than clamps, or prescribed motions, the spectral radius has to be below 1",
             "the constraint forces would oscillate undamped; 0.9 is nearly free of damping");
  const bool has_mass = std::any_of(s.bodies.begin(), s.bodies.end(),
                                    [](const Body& b) { return b.mass > 0.0 || !(b.inertia(0, 0) == 0.0); }) ||
                        std::any_of(s.beams.begin(), s.beams.end(), [&](const Beam& b) {
                          const auto section = list.section_of.find(b.section);
                          return section != list.section_of.end() && !is_zero(s.sections[section->second].mass.m);
                        });
  if (!has_mass && list.defective.empty() && !(s.nodes.empty() && s.bodies.empty()))
    list.add("analysis", 0, "kind", std::string(type_of(a.kind).name),
             "nothing in the scene has mass, neither '" + (s.bodies.empty() ? s.nodes[0].name : s.bodies[0].name) +
                 "' nor anything else",
             "give the material a density, the section a mass or the bodies a mass");
}

void check_holding(ProblemList& list) {
  const Scene& s = list.scene;
  const std::size_t ground = s.nodes.size() + s.bodies.size() + s.beams.size();
  Groups groups(ground + 1);
  std::vector<char> used(ground + 1, 0);
  const auto join = [&](const std::string& a, const std::string& b, bool holds) {
    const std::size_t i = place_number(list, a), j = place_number(list, b);
    groups.join(i, j);
    if (holds) used[i] = used[j] = 1;
  };
  for (const Beam& b : s.beams) {
    join(b.name, b.start, true);
    join(b.name, b.end, true);
  }
  for (const Joint& j : s.joints) join(j.first.to, j.second.to, true);
  for (const Coupling& c : s.couplings)
    join(c.first.to, c.second.to, c.kind != nullptr && c.kind->start == CouplingStart::frame);
  for (const PrescribedMotion& m : s.motions) join(m.at.to, "ground", true);
  for (std::size_t i = 0; i < s.nodes.size(); ++i)
    if (used[i] == 0)
      list.add("nodes", i, "name", s.nodes[i].name,
               "no beam, joint, bushing or prescribed motion takes this node, so nothing holds it and it has no mass",
               "remove it, or use a fixed frame where only a place is meant");
  if (list.is_dynamic) return;
  std::vector<char> told(ground + 1, 0);
  for (std::size_t i = 0; i < s.nodes.size() + s.bodies.size(); ++i) {
    const std::size_t g = groups.find(i);
    if (g == groups.find(ground) || told[g] != 0) continue;
    told[g] = 1;
    const bool is_node = i < s.nodes.size();
    const std::size_t k = is_node ? i : i - s.nodes.size();
    list.warn(is_node ? "nodes" : "bodies", k, "name", is_node ? s.nodes[k].name : s.bodies[k].name,
              "nothing joins this and what hangs on it to the ground, and the analysis is static");
  }
}

}  // namespace bough::scene
