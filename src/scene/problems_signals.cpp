/// Checks of signals, and of what they drive.
#include <algorithm>
#include <unordered_set>

#include "bough/scene/sensor_kinds.hpp"
#include "bough/scene/signals.hpp"
#include "problem_list.hpp"

namespace bough::scene {
namespace {

/// A signal named by another one, or by what it drives.
class SignalNames {
 public:
  explicit SignalNames(ProblemList& list) : list_(list) {
    for (const Signal& s : list.scene.signals) names_.push_back(s.name);
    known_.insert(names_.begin(), names_.end());
  }
  void check(const char* section, std::size_t i, const std::string& key, const std::string& name) {
    if (name.empty() || known_.count(name) > 0 || list_.is_defective(name)) return;
    const std::string near = list_.nearest(name, names_);
    list_.add(section, i, key, name, "no signal has this name",
              !near.empty()    ? "did you mean \"" + near + "\"?"
              : names_.empty() ? "the scene has no signals"
                               : "");
  }

 private:
  ProblemList& list_;
  std::vector<std::string> names_;
  std::unordered_set<std::string> known_;
};

void check_joint_of(ProblemList& list, std::size_t i, const Signal& s) {
  if (!list.check_reference("signals", i, "joint", s.joint, list.joints, "joint")) return;
  const auto joint = std::find_if(list.scene.joints.begin(), list.scene.joints.end(),
                                  [&](const Joint& j) { return j.name == s.joint; });
  if (joint == list.scene.joints.end()) return;
  const JointType& type = type_of(joint->kind);
  if (coordinate_of(s, type) == nullptr)
    list.add("signals", i, "joint", s.joint,
             "a " + type.name + " joint has no such coordinate that a signal could read");
  else if (s.kind == SignalKind::joint_rate && s.coordinate.empty() && type.coordinates.size() > 1)
    list.add("signals", i, "joint", s.joint, "a " + type.name + " joint has two rates: name one of them as coordinate");
}

/// Signals that wait for each other without a state between them have no value that follows from the motion alone.
void check_circles(ProblemList& list) {
  const std::vector<Signal>& signals = list.scene.signals;
  const std::vector<std::size_t> order = order_of_signals(signals);
  if (order.size() == signals.size()) return;
  std::vector<bool> is_known(signals.size(), false);
  for (const std::size_t i : order) is_known[i] = true;
  const auto is_waited_for = [&](std::size_t i) {
    for (std::size_t k = 0; k < signals.size(); ++k)
      if (!is_known[k] && std::count(signals[k].inputs.begin(), signals[k].inputs.end(), signals[i].name) > 0)
        return true;
    return false;
  };
  for (bool changes = true; changes;) {  // what follows from the circle without being part of it
    changes = false;
    for (std::size_t i = 0; i < signals.size(); ++i)
      if (!is_known[i] && !is_waited_for(i)) is_known[i] = changes = true;
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

}  // namespace

void check_signals(ProblemList& list) {
  const Scene& scene = list.scene;
  SignalNames names(list);
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
    if (s.kind == SignalKind::time) list.check_law("signals", i, "law", s.law, false);
  }
  for (std::size_t i = 0; i < scene.sensors.size(); ++i)
    if (type_of(scene.sensors[i].kind).of == SensorOf::signal)
      names.check("sensors", i, "signal", scene.sensors[i].signal);
  for (std::size_t i = 0; i < scene.joints.size(); ++i)
    for (std::size_t k = 0; k < scene.joints[i].forces.size(); ++k)
      names.check("joints", i, "forces/" + std::to_string(k) + "/effort/signal", scene.joints[i].forces[k].signal);
  const auto check_loads_of = [&](const char* section, const auto& loads) {
    for (std::size_t i = 0; i < loads.size(); ++i) {
      names.check(section, i, "law/signal", loads[i].signal);
      if (!loads[i].signal.empty() && !loads[i].frame.empty() && any_frame_moves(scene))
        list.add(section, i, "frame", loads[i].frame,
                 "a load that a signal drives does not turn with a frame that moves",
                 "give it in the axes \"body\" of the part, or in those of the ground");
    }
  };
  check_loads_of("point_loads", scene.point_loads);
  check_loads_of("line_loads", scene.line_loads);
  if (list.defective.empty()) check_circles(list);
  if (scene.signals.empty()) return;
  const Analysis& a = scene.analysis;
  if (list.is_dynamic && a.integrator == Integrator::variational)
    list.add("analysis", 0, "integrator", "variational", "the variational integrator does not know signals",
             "take generalized_alpha or bdf");
  if (!list.is_dynamic && a.arc_length)
    list.add("analysis", 0, "arc_length", "", "paths by arc length do not know signals", "take load steps");
}

}  // namespace bough::scene
