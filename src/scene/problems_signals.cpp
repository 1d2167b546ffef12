/// Checks of signals, and of what they drive.
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "bough/scene/couplings.hpp"
#include "bough/scene/joint_efforts.hpp"
#include "bough/scene/sensor_kinds.hpp"
#include "bough/scene/signals.hpp"
#include "problem_list.hpp"

namespace bough::scene {
namespace {

/// A signal named by another one, or by what it drives.
class SignalNames {
 public:
  explicit SignalNames(ProblemList& list) : list_(list) {
    for (std::size_t i = 0; i < list.scene.signals.size(); ++i) {
      names_.push_back(list.scene.signals[i].name);
      index_of_.emplace(names_.back(), i);
    }
  }
  /// The first signal of this name; nullptr if there is none.
  const Signal* find(const std::string& name) const {
    const auto known = index_of_.find(name);
    return known == index_of_.end() ? nullptr : &list_.scene.signals[known->second];
  }
  void check(const char* section, std::size_t i, const std::string& key, const std::string& name) {
    if (name.empty() || find(name) != nullptr || list_.is_defective(name)) return;
    const std::string near = list_.nearest(name, names_);
    list_.add(section, i, key, name, "no signal has this name",
              !near.empty()    ? "did you mean \"" + near + "\"?"
              : names_.empty() ? "the scene has no signals"
                               : "");
  }

 private:
  ProblemList& list_;
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::size_t> index_of_;
};

/// Whether anything of the joint belongs to the part that is read.
bool has_part(const EffortParts& part, const Joint& joint) {
  if (part.drive && (!joint.drives.empty() || !type_of(joint.kind).rows.empty())) return true;
  const auto has_effort = [](const JointForce& f) {
    const bool is_zero = f.effort.node() == nullptr || (f.effort.is_constant() && f.effort.at(0.0).value == 0.0);
    return !f.signal.empty() || !is_zero;
  };
  return std::any_of(joint.forces.begin(), joint.forces.end(), [&](const JointForce& f) {
    return part.takes(f) &&
           ((part.spring && f.stiffness != 0.0) || (part.damper && f.damping != 0.0) || (part.effort && has_effort(f)));
  });
}

void check_joint_of(ProblemList& list, std::size_t i, const Signal& s) {
  if (!list.check_reference("signals", i, "joint", s.joint, list.joints, "joint")) return;
  const JointType& type = type_of(list.scene.joints[list.poses.find(s.joint)->index].kind);
  if (reads_reaction(s)) {
    if (!reaction_row(type, s.coordinate))
      list.add(
          "signals", i, "component", s.coordinate,
          "no row of a " + type.name + " joint alone holds this component of its reaction",
          "the force or torque along a free coordinate is a signal of kind \"joint_effort\"; a sensor measures all "
          "components");
    return;
  }
  if (coordinate_of(s, type) == nullptr)
    list.add("signals", i, "joint", s.joint,
             "a " + type.name + " joint has no such coordinate that a signal could read");
  else if ((s.kind == SignalKind::joint_rate || s.kind == SignalKind::joint_effort) && s.coordinate.empty() &&
           type.coordinates.size() > 1)
    list.add("signals", i, "joint", s.joint,
             "a " + type.name + " joint has two " + (s.kind == SignalKind::joint_rate ? "rates" : "efforts") +
                 ": name one of them as coordinate");
  if (s.kind == SignalKind::joint_effort)
    check_effort_part(list, "signals", i, s.of, list.scene.joints[list.poses.find(s.joint)->index]);
}

void check_spring_of(ProblemList& list, const std::unordered_set<std::string_view>& known,
                     const std::vector<std::string>& springs, std::size_t i, const Signal& s) {
  if (known.count(s.spring) > 0 || list.is_defective(s.spring)) return;
  const std::string near = list.nearest(s.spring, springs);
  list.add("signals", i, "spring", s.spring, "no spring has this name",
           !near.empty()     ? "did you mean \"" + near + "\"?"
           : springs.empty() ? "the scene has no springs"
                             : "");
}

void check_motion_of(ProblemList& list, std::size_t i, const Signal& s) {
  std::vector<std::string> names;
  for (const PrescribedMotion& m : list.scene.motions) names.push_back(m.name);
  if (!list.check_known("signals", i, "of", s.part, names, "prescribed motion")) return;
  const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), s.part) - names.begin());
  if (!force_row(list.scene.motions[index], s.coordinate))
    list.add("signals", i, "component", s.coordinate, "no row of this prescribed motion alone holds this component",
             "a sensor of kind \"force\" measures all components");
}

/// Signals and sensors read a force by its name, which is no word of another meaning.
void check_force_name(ProblemList& list, std::size_t i, std::size_t k) {
  const std::vector<JointForce>& forces = list.scene.joints[i].forces;
  const std::string &name = forces[k].name, key = "forces/" + std::to_string(k) + "/name";
  if (name.empty()) return;
  const std::vector<std::string>& words = effort_words();
  if (std::find(words.begin(), words.end(), name) != words.end())
    list.add("joints", i, key, name, "this word names a part of all efforts along a coordinate", "take another name");
  for (std::size_t before = 0; before < k; ++before)
    if (forces[before].name == name) list.add("joints", i, key, name, "another force of the joint has this name");
}

/// Two signals that read one effort are one number twice.
void check_twin_efforts(ProblemList& list) {
  std::unordered_map<std::string, std::size_t> first_of;
  const std::vector<Signal>& signals = list.scene.signals;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i].kind != SignalKind::joint_effort) continue;
    const auto [first, is_new] =
        first_of.emplace(signals[i].joint + '/' + signals[i].coordinate + '/' + signals[i].of, i);  // names have no /
    if (!is_new)
      list.add("signals", i, "joint", signals[i].joint,
               "signal '" + signals[first->second].name + "' is this effort already", "take its name");
  }
}

/// Signals that wait for each other without a state between them have no value that follows from the motion alone.
void check_circles(ProblemList& list) {
  const std::vector<Signal>& signals = list.scene.signals;
  const std::vector<std::size_t> order = order_of_signals(list.scene);
  if (order.size() == signals.size()) return;
  std::vector<bool> is_known(signals.size(), false);
  for (const std::size_t i : order) is_known[i] = true;
  const std::vector<std::vector<std::size_t>> inputs = present_inputs(list.scene);
  std::vector<std::size_t> waiting(signals.size(), 0);  // for each signal: how many of the others that are not known
  for (std::size_t k = 0; k < signals.size(); ++k)
    for (const std::size_t input : inputs[k]) waiting[input] += is_known[k] ? 0 : 1;
  std::vector<std::size_t> leaves;  // what follows from the circle without being part of it
  for (std::size_t i = 0; i < signals.size(); ++i)
    if (!is_known[i] && waiting[i] == 0) leaves.push_back(i);
  while (!leaves.empty()) {
    const std::size_t leaf = leaves.back();
    leaves.pop_back();
    is_known[leaf] = true;
    for (const std::size_t input : inputs[leaf])
      if (--waiting[input] == 0 && !is_known[input]) leaves.push_back(input);
  }
  std::string names;
  std::size_t first = signals.size();
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (is_known[i]) continue;
    first = std::min(first, i);
    names += (names.empty() ? "" : ", ") + signals[i].name;
  }
  list.add("signals", first, "", names, "these signals follow from each other in a circle",
           "let one of them be a state: a lag, an integrator");
}

bool any_frame_moves(const Scene& scene) {
  return std::any_of(scene.frames.begin(), scene.frames.end(), [](const FrameDef& f) { return f.motion.has_value(); });
}

/// What signals may drive, by what they follow from. A row needs the rate and the acceleration of its law before those
/// of the motion are known; an effort needs its value before the forces of constraints are.
class SignalLevels {
 public:
  explicit SignalLevels(ProblemList& list) : list_(list), levels_(levels_of_signals(list.scene)) {
    for (std::size_t i = 0; i < list.scene.signals.size(); ++i) index_of_.emplace(list.scene.signals[i].name, i);
  }
  void check_row(const char* section, std::size_t i, const std::string& key, const std::string& name) {
    const int level = level_of(name);
    if (level < 0) return;
    const char* const what[] = {"where parts are", "how fast they move", "forces of constraints"};
    const std::string states = level == 0 ? "a state that follows it, x' = (" + name + " - x)/lag"
                                          : std::to_string(level + 1) + " states in a row that follow it";
    list_.add(section, i, key, name,
              std::string("this signal follows from ") + what[level] +
                  " at the same instant, so that it has no acceleration that a drive could prescribe",
              "drive by " + states + "; or let an effort follow it");
  }
  void check_effort(const char* section, std::size_t i, const std::string& key, const std::string& name) {
    if (level_of(name) < 2) return;
    list_.add(section, i, key, name,
              "this signal follows from the force of a drive or of a rod, which would follow from itself",
              "let a state follow it, x' = (" + name + " - x)/lag, as a sensor does");
  }

 private:
  int level_of(const std::string& name) const {
    const auto known = index_of_.find(name);
    return known == index_of_.end() ? -1 : levels_[known->second];
  }
  ProblemList& list_;
  std::vector<int> levels_;
  std::unordered_map<std::string, std::size_t> index_of_;
};

/// A row that starts away from the state that drives it is closed at the start, which moves parts.
void check_start(ProblemList& list, const SignalNames& names, const char* section, std::size_t i,
                 const std::string& key, const std::string& name, double stands, double scale, bool turns) {
  const Signal* s = names.find(name);
  if (s == nullptr || s->kind != SignalKind::state || !list.is_dynamic ||
      list.scene.analysis.start == StartKind::equilibrium)
    return;
  const double jump = s->start - stands;
  if (std::abs(turns ? std::remainder(jump, 2.0 * 3.14159265358979323846) : jump / scale) > 1e-9)
    list.warn(section, i, key, name,
              "the state starts at " + text_of(s->start) + ", and what it drives at " + text_of(stands),
              "let it start there");
}

/// Drives of joints and prescribed motions.
void check_driven_rows(ProblemList& list, SignalNames& names, SignalLevels& levels) {
  const Scene& scene = list.scene;
  const auto check = [&](const char* section, std::size_t i, const std::string& key, const std::string& name,
                         bool is_rate) {
    if (name.empty()) return;
    names.check(section, i, key + "/signal", name);
    if (is_rate)
      list.add(section, i, key + "/signal", name, "a signal is the coordinate itself, not its rate",
               "drive by a state x with x' = " + name + ", without \"rate\"");
    else
      levels.check_row(section, i, key + "/signal", name);
  };
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const Joint& joint = scene.joints[i];
    for (std::size_t k = 0; k < joint.drives.size(); ++k) {
      const JointDrive& drive = joint.drives[k];
      const std::string key = "drives/" + std::to_string(k) + "/law";
      check("joints", i, key, drive.signal, drive.is_rate);
      const JointCoordinate* coordinate = type_of(joint.kind).coordinate(drive.coordinate);
      const auto a = list.poses.of(joint.first), b = list.poses.of(joint.second);
      if (!drive.signal.empty() && a && b && coordinate != nullptr)
        check_start(list, names, "joints", i, key + "/signal", drive.signal,
                    eval_row({coordinate->kind}, joint.pitch, motion::relative(*a, *b)).value, list.size,
                    !coordinate->is_length());
    }
  }
  const char* const axes[3] = {"x", "y", "z"};
  for (std::size_t i = 0; i < scene.motions.size(); ++i) {
    const PrescribedMotion& m = scene.motions[i];
    for (int k = 0; k < 3; ++k) {
      check("motions", i, axes[k], m.displacement_signal[k], m.is_rate);
      check_start(list, names, "motions", i, std::string(axes[k]) + "/signal", m.displacement_signal[k], 0.0, list.size,
                  false);
    }
    check("motions", i, "rotation/angle", m.angle_signal, m.is_rate);
    check_start(list, names, "motions", i, "rotation/angle/signal", m.angle_signal, 0.0, 1.0, true);
  }
}

/// The variational integrator evaluates signals in the middle of a step, where its multipliers are those with which the
/// step begins.
void check_variational(ProblemList& list) {
  const Scene& scene = list.scene;
  if (!list.is_dynamic || scene.analysis.integrator != Integrator::variational) return;
  const std::vector<bool> of_rows = read_rows(scene);
  for (std::size_t i = 0; i < scene.signals.size(); ++i)
    if (of_rows[i])
      list.add("signals", i, "", scene.signals[i].name,
               "with the variational integrator no signal reads the force of a drive or of what a joint holds: in the "
               "middle of a step, where signals are, it is known to first order only",
               "give /analysis/integrator as generalized_alpha or bdf");
}

}  // namespace

void check_effort_part(ProblemList& list, const char* section, std::size_t i, const std::string& of,
                       const Joint& joint) {
  if (const auto part = effort_parts(of, joint)) {
    if (!of.empty() && !has_part(*part, joint))
      list.warn(section, i, "of", of, "the joint has no such part, so this is 0",
                "leave \"of\" out to read all that acts along the coordinate");
    return;
  }
  std::vector<std::string> words = effort_words();
  std::string known =
      "it is \"all\", \"drive\", \"spring\", \"damper\", \"effort\" or the name of a force of the joint";
  for (const JointForce& f : joint.forces)
    if (!f.name.empty()) words.push_back(f.name);
  std::string near = list.nearest(of, words);
  if (near.empty()) near = effort_word_meant(of);
  if (near == "effort" && of != near)
    known = "friction, limits and servos are efforts; \"name\" in a force of the joint makes it one to be read alone";
  list.add(section, i, "of", of, "no part of the effort along a coordinate has this name",
           near.empty() ? known : "did you mean \"" + near + "\"? " + known);
}

void check_signals(ProblemList& list) {
  const Scene& scene = list.scene;
  SignalNames names(list);
  SignalLevels levels(list);
  std::vector<std::string> springs;
  for (const Coupling& c : scene.couplings)
    if (line_force_of(c)) springs.push_back(c.name);
  const std::unordered_set<std::string_view> spring_of(springs.begin(), springs.end());
  check_twin_efforts(list);
  for (std::size_t i = 0; i < scene.signals.size(); ++i) {
    const Signal& s = scene.signals[i];
    if (!is_signal_name(s.name))
      list.add("signals", i, "name", s.name, "formulas cannot call a signal by this name",
               "a letter or _, then letters, digits and _; not pi, e, t or a function");
    if (reads_joint(s.kind)) check_joint_of(list, i, s);
    if (reads_point(s.kind)) {
      list.check_place("signals", i, "at", s.at.to, false);
      if (!s.frame.empty()) list.check_place("signals", i, "frame", s.frame, true);
      if (!s.frame.empty() && s.frame == s.at.to)
        list.add("signals", i, "frame", s.frame, "a point does not move as seen from its own part");
    }
    if (s.kind == SignalKind::function) names.check("signals", i, "of", s.of);
    if (s.kind == SignalKind::surface)
      for (std::size_t k = 0; k < s.inputs.size(); ++k)
        names.check("signals", i, "of/" + std::to_string(k), s.inputs[k]);
    if (s.kind == SignalKind::spring_tension) check_spring_of(list, spring_of, springs, i, s);
    if (s.kind == SignalKind::force) check_motion_of(list, i, s);
    if (s.kind == SignalKind::time) list.check_law("signals", i, "law", s.law, false);
  }
  for (std::size_t i = 0; i < scene.sensors.size(); ++i)
    if (type_of(scene.sensors[i].kind).of == SensorOf::signal)
      names.check("sensors", i, "signal", scene.sensors[i].signal);
  for (std::size_t i = 0; i < scene.joints.size(); ++i)
    for (std::size_t k = 0; k < scene.joints[i].forces.size(); ++k) {
      check_force_name(list, i, k);
      const std::string key = "forces/" + std::to_string(k) + "/effort/signal";
      names.check("joints", i, key, scene.joints[i].forces[k].signal);
      levels.check_effort("joints", i, key, scene.joints[i].forces[k].signal);
    }
  for (std::size_t i = 0; i < scene.couplings.size(); ++i)
    for_each_field(scene.couplings[i], [&](const CouplingField& field, std::span<const double>, const Factor* given) {
      if (given == nullptr) return;
      const std::string key = std::string(field.name) + "/signal";
      names.check("couplings", i, key, given->signal);
      levels.check_effort("couplings", i, key, given->signal);
    });
  check_driven_rows(list, names, levels);
  const auto check_loads_of = [&](const char* section, const auto& loads) {
    for (std::size_t i = 0; i < loads.size(); ++i) {
      names.check(section, i, "law/signal", loads[i].signal);
      levels.check_effort(section, i, "law/signal", loads[i].signal);
      if (!loads[i].signal.empty() && !loads[i].frame.empty() && any_frame_moves(scene))
        list.add(section, i, "frame", loads[i].frame,
                 "a load that a signal drives does not turn with a frame that moves",
                 "give it in the axes \"body\" of the part, or in those of the ground");
    }
  };
  check_loads_of("point_loads", scene.point_loads);
  check_loads_of("line_loads", scene.line_loads);
  if (list.defective.empty()) check_circles(list);
  check_variational(list);
}

}  // namespace bough::scene
