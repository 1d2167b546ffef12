/// Reads what signals drive and what is made of other parts of a scene: springs whose length or strength changes, and
/// gravity as weights.
#include <algorithm>
#include <cmath>
#include <map>

#include "bough/io/number_text.hpp"
#include "bough/laws/formula.hpp"
#include "bough/laws/law_error.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/scene/couplings.hpp"
#include "bough/scene/signals.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {

namespace {

using scene::SignalKind;

/// A formula with other words in the place of some names.
std::string with_words(const std::string& formula, const std::map<std::string, std::string>& words) {
  std::string made;
  std::size_t done = 0;
  for (const laws::NamePlace& place : laws::names_in(formula)) {
    const auto word = words.find(formula.substr(place.position, place.length));
    if (word == words.end()) continue;
    made.append(formula, done, place.position - done);
    made += word->second;
    done = place.position + place.length;
  }
  return made.append(formula, done, std::string::npos);
}

/// A tension as a formula of length, stretch and rate of a spring, and of signals.
struct Tension {
  std::string text;
  double rest_length = 0.0;
  std::vector<std::string> signals;  ///< those that it names
  bool has_rate = false;
  bool is_elastic = false;  ///< it is not 0 at rate 0, or depends on the length
};

/// Throws LawError where the formula cannot be read, or a name has two meanings.
Tension read_tension(const std::string& text, double rest_length, const std::unordered_set<std::string>& signals) {
  Tension t{text, rest_length, {}, false, false};
  std::vector<std::string> names{"length", "stretch", "rate"};
  const std::size_t own = names.size();
  const auto is_in = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  for (const laws::NamePlace& place : laws::names_in(text)) {
    const std::string name = text.substr(place.position, place.length);
    const bool is_own = std::find(names.begin(), names.begin() + 3, name) != names.begin() + 3;
    if (is_own && signals.count(name) > 0)
      throw laws::LawError(text, place.position, "\"" + name + "\" means the spring's own here, and a signal too");
    t.has_rate |= name == "rate";
    t.is_elastic |= is_own && name != "rate";
    if (!is_own && signals.count(name) > 0 && !is_in(names, name)) names.push_back(name);
  }
  t.signals.assign(names.begin() + static_cast<std::ptrdiff_t>(own), names.end());
  const laws::Formula formula(text, names);
  t.is_elastic |= formula(std::vector<double>(names.size(), 0.0)) != 0.0;
  return t;
}

/// Adds the force on the second end of a strut that a law of its length gives; `made` begins with the length.
template <class Named>
std::string add_elastic(const laws::Law& tension, const Named& named, std::vector<scene::Signal>& made) {
  scene::Signal force;
  force.kind = SignalKind::function;
  force.name = named("force");
  force.of = made.front().name;
  force.inputs = {force.of};
  force.law = laws::make_scaled(-1.0, tension);
  made.push_back(std::move(force));
  return made.back().name;
}

/// Adds the forces that a formula gives: that at rate 0 as a law of the length, unless it names signals, and what is
/// left.
template <class Named>
std::vector<std::string> add_tension(const Tension& tension, const std::string& strut, const Named& named,
                                     std::vector<scene::Signal>& made) {
  std::vector<std::string> efforts;
  const std::string length = made.front().name, rest = " - " + in_brackets(tension.rest_length) + ")";
  if (tension.signals.empty() && tension.is_elastic)
    efforts.push_back(add_elastic(
        laws::make_expression(with_words(tension.text, {{"length", "t"}, {"stretch", "(t" + rest}, {"rate", "(0)"}})),
        named, made));
  if (tension.signals.empty() && !tension.has_rate) return efforts;
  scene::Signal left;
  left.kind = SignalKind::formula;
  left.inputs = tension.signals;
  left.inputs.push_back(length);
  std::map<std::string, std::string> words{{"length", length}, {"stretch", "(" + length + rest}};
  if (tension.has_rate) {
    scene::Signal rate;
    rate.kind = SignalKind::joint_rate;
    rate.name = words["rate"] = named("rate");
    rate.joint = strut;
    left.inputs.push_back(rate.name);
    made.push_back(std::move(rate));
  }
  std::string text = "-(" + with_words(tension.text, words) + ")";
  for (const std::string& elastic : efforts) {
    text += " - " + elastic;
    left.inputs.push_back(elastic);
  }
  left.name = named("rest_of_force");
  left.formula = laws::Formula(text, left.inputs);
  efforts.push_back(left.name);
  made.push_back(std::move(left));
  return efforts;
}

/// A spring as a strut of its name, with efforts that signals give besides its own tension.
scene::Joint strut_of(const scene::Coupling& spring, const scene::LineForce& own,
                      const std::vector<std::string>& efforts) {
  scene::Joint strut;
  strut.name = spring.name;
  strut.kind = scene::JointKind::strut;
  strut.first = spring.first;
  strut.second = spring.second;
  for (const std::string& effort : efforts)
    strut.forces.push_back({"displacement", 0.0, own.rest_length, 0.0, {}, effort});
  if (!efforts.empty()) {
    strut.forces.front().stiffness = own.stiffness;
    strut.forces.front().damping = own.damping;
  }
  return strut;
}

}  // namespace

std::string in_brackets(double x) {
  std::string text = "(";
  append_number(text, x);
  return text + ")";
}

void Converter::need_signal(const std::string& name, const std::string& at) {
  if (known_signals_.count(name) > 0) return;
  fault(at, "no signal has this name",
        signal_names_.empty() ? "the scene has no signals" : did_you_mean(name, signal_names_));
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
  add_signal(std::move(own), at);
  return signal;
}

/// A spring with more than constants: a strut of the same name with what signals add, so that derivatives are exact.
///   tension = k (l - l_0) + c l' + added
/// rest_law, stiffness_factor: added = factor k (l - rest) - k (l - l_0), whose work is counted as that of a drive.
/// force_law: what it has at rate 0 is a law of the length, which stores its energy; work is counted for the rest.
void Converter::driven_spring(const Value& v, const std::string& at, const scene::Coupling& spring) {
  const scene::LineForce own = scene::line_force_of(spring).value();
  const std::string stem =
      (scene::is_signal_name(spring.name) ? spring.name : "spring_" + std::to_string(scene.joints.size())) + "_";
  const auto named = [this, &stem](const char* end) { return unused_signal_name(stem + end); };
  std::vector<scene::Signal> made(1);
  scene::Signal& length = made.front();
  length.kind = SignalKind::joint_displacement;
  length.name = named("length");
  length.joint = spring.name;
  std::vector<std::string> efforts;
  if (const Value* law_given = v.find("force_law")) {
    const std::string at_law = at + "/force_law";
    try {
      if (const Value* formula = law_given->is(JsonKind::object) ? law_given->find("expression") : nullptr)
        efforts = add_tension(read_tension(formula->text, own.rest_length, known_signals_), spring.name, named, made);
      else
        efforts = {add_elastic(law(*law_given, at_law), named, made)};
    } catch (const laws::LawError& e) {
      fault(at_law + "/expression", e.what(),
            "at character " + std::to_string(e.position + 1) +
                "; it names length, stretch and rate of the spring, signals and parameters");
    }
  } else {
    const Value *rest = v.find("rest_law"), *factor = v.find("stiffness_factor");
    scene::Signal force;
    force.kind = SignalKind::formula;
    force.name = named("force");
    force.inputs = {length.name};
    const auto input = [&force](const std::string& name) {
      if (std::find(force.inputs.begin(), force.inputs.end(), name) == force.inputs.end()) force.inputs.push_back(name);
      return name;
    };
    const std::string k = in_brackets(own.stiffness), rest_given = in_brackets(own.rest_length);
    const std::string of_factor =
        factor != nullptr ? input(signal_of(*factor, at + "/stiffness_factor", stem + "factor")) : "1";
    const std::string of_rest = rest != nullptr ? input(signal_of(*rest, at + "/rest_law", stem + "rest")) : rest_given;
    if (faults.size() != faults_before_) return;
    force.formula = laws::Formula(k + "*(" + length.name + " - " + rest_given + ") - " + of_factor + "*" + k + "*(" +
                                      length.name + " - " + of_rest + ")",
                                  force.inputs);
    efforts = {force.name};
    made.push_back(std::move(force));
  }
  add(scene.joints, "joints", strut_of(spring, own, efforts), at);
  for (scene::Signal& signal : made) add_signal(std::move(signal), at);
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
  std::unordered_map<std::string_view, const scene::Section*> section_of;
  for (const scene::Section& section : scene.sections) section_of.emplace(section.name, &section);
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
      const auto known = section_of.find(beam.section);
      if (known == section_of.end() || !(known->second->mass(0, 0) > 0.0)) continue;
      const scene::Section* section = known->second;
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
