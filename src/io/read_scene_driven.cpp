/// Reads what signals drive and what is made of other parts of a scene: springs whose length or strength changes, and
/// gravity as weights.
#include <algorithm>

#include "bough/io/number_text.hpp"
#include "bough/laws/formula.hpp"
#include "bough/scene/nearest_name.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {

namespace {

using scene::SignalKind;

/// A number with all its digits, in brackets.
std::string in_brackets(double x) {
  std::string text = "(";
  append_number(text, x);
  return text + ")";
}

}  // namespace

void Converter::need_signal(const std::string& name, const std::string& at) {
  if (std::find(signal_names_.begin(), signal_names_.end(), name) != signal_names_.end()) return;
  const std::string near = scene::nearest_name(name, signal_names_);
  fault(at, "no signal has this name",
        !near.empty()           ? "did you mean \"" + near + "\"?"
        : signal_names_.empty() ? "the scene has no signals"
                                : "");
}

/// The signal that a law or the name of one stands for; for a law, one of its own.
std::string Converter::signal_of(const Value& v, const std::string& at, const std::string& name) {
  std::string signal;
  scene::Signal own;
  own.law = law_or_signal(v, at, signal);
  if (!signal.empty()) {
    need_signal(signal, at + "/signal");
    return signal;
  }
  own.kind = SignalKind::time;
  own.name = unused_signal_name(name);
  signal = own.name;
  add(scene.signals, "signals", std::move(own), at);
  return signal;
}

/// A spring whose tension is factor k (l - rest) + c l', with a factor or a rest length that a signal gives: a strut of
/// the same name. Its own spring has the stiffness k and the rest length of the start; the effort is what is left,
///   k (l - l_0) - factor k (l - rest),
/// a signal, so that its derivatives are exact and its work is counted as that of a drive.
void Converter::driven_spring(const Value& v, const std::string& at, const scene::Spring& s) {
  const std::string stem = "spring_" + std::to_string(scene.joints.size()) + "_";
  const Value *rest = v.find("rest_law"), *factor = v.find("stiffness_factor");
  const std::string at_rest = at + "/rest_law", at_factor = at + "/stiffness_factor";
  scene::Signal length, force;
  length.kind = SignalKind::joint_displacement;
  length.name = unused_signal_name(stem + "length");
  length.joint = s.name;
  force.kind = SignalKind::formula;
  force.name = unused_signal_name(stem + "force");
  force.inputs = {length.name};
  const auto input = [&force](const std::string& name) {
    if (std::find(force.inputs.begin(), force.inputs.end(), name) == force.inputs.end()) force.inputs.push_back(name);
    return name;
  };
  const std::string k = in_brackets(s.stiffness);
  std::string of_factor = factor != nullptr ? input(signal_of(*factor, at_factor, stem + "factor")) : "1";
  std::string of_rest = rest != nullptr ? input(signal_of(*rest, at_rest, stem + "rest")) : in_brackets(s.rest_length);
  if (faults.size() != faults_before_) return;
  force.formula = laws::Formula(k + "*(" + length.name + " - " + in_brackets(s.rest_length) + ") - " + of_factor + "*" +
                                    k + "*(" + length.name + " - " + of_rest + ")",
                                force.inputs);
  scene::JointForce of_strut;
  of_strut.coordinate = "displacement";
  of_strut.stiffness = s.stiffness;
  of_strut.rest = s.rest_length;
  of_strut.damping = s.damping;
  of_strut.signal = force.name;
  scene::Joint strut;
  strut.name = s.name;
  strut.kind = scene::JointKind::strut;
  strut.first = s.first;
  strut.second = s.second;
  strut.forces.push_back(std::move(of_strut));
  add(scene.joints, "joints", std::move(strut), at);
  add(scene.signals, "signals", std::move(length), at);
  add(scene.signals, "signals", std::move(force), at);
}

/// Gravity whose factor or components signals give: it is made of weights (weigh).
void Converter::driven_gravity(const Value& v) {
  const char* const axes[] = {"x", "y", "z"};
  const std::size_t before = faults.size();
  if (const Value* whole = v.find("vector")) {
    Weight weight{"", vector(*whole), {}, {}};
    weight.law = law_or_signal(*v.find("law"), "/gravity/law", weight.signal);
    need_signal(weight.signal, "/gravity/law/signal");
    weights_.push_back(std::move(weight));
  }
  const Value* components = v.find("components");
  for (int k = 0; components != nullptr && k < 3; ++k) {
    const Value& component = components->items[static_cast<std::size_t>(k)];
    if (component.is(JsonKind::number) && component.number == 0.0) continue;
    const std::string at = "/gravity/components/" + std::to_string(k);
    Weight weight{std::string(" along ") + axes[k], scene::Vec3::unit(k), {}, {}};
    weight.law = law_or_signal(component, at, weight.signal);
    if (!weight.signal.empty()) need_signal(weight.signal, at + "/signal");
    weights_.push_back(std::move(weight));
  }
  const Value* analysis = root_.find("analysis");
  if (analysis != nullptr && analysis->is(JsonKind::object) && analysis->find("frame") != nullptr)
    fault("/gravity", "as weights that change it belongs to the ground, and the analysis is described in a frame",
          "leave out /analysis/frame, or give gravity as a vector with a law of time");
  if (faults.size() != before) weights_.clear();
}

/// The weights of all bodies at their centres of mass, and of all beams along their axes: dead loads.
void Converter::weigh() {
  faults_before_ = faults.size();
  left_out_ = false;
  for (const Weight& w : weights_) {
    for (const scene::Body& body : scene.bodies) {
      if (!(body.mass > 0.0)) continue;
      scene::PointLoad load;
      load.name = "weight of " + body.name + w.along;
      load.at.to = body.name;
      load.at.offset.x = body.center_of_mass;
      load.force = body.mass * w.direction;
      load.law = w.law;
      load.signal = w.signal;
      add(scene.point_loads, "point_loads", std::move(load), "/gravity");
    }
    for (const scene::Beam& beam : scene.beams) {
      const auto section = std::find_if(scene.sections.begin(), scene.sections.end(),
                                        [&](const scene::Section& s) { return s.name == beam.section; });
      if (section == scene.sections.end() || !(section->mass(0, 0) > 0.0)) continue;
      for (int i = 0; i < 3; ++i)
        for (int j = 3; j < 6; ++j)
          if (section->mass(i, j) != 0.0 && faults.size() == faults_before_)
            fault("/gravity",
                  "as weights that change it acts on the axes of beams, and the mass of section '" + section->name +
                      "' lies beside it",
                  "put the axis through the centre of mass, or give gravity as a vector with a law of time");
      scene::LineLoad load;
      load.name = "weight of " + beam.name + w.along;
      load.beam = beam.name;
      load.force = section->mass(0, 0) * w.direction;
      load.law = w.law;
      load.signal = w.signal;
      add(scene.line_loads, "line_loads", std::move(load), "/gravity");
    }
  }
}

}  // namespace bough::io
