/// Reads signals: numbers that change with the motion.
#include <algorithm>
#include <optional>
#include <utility>

#include "bough/io/number_text.hpp"
#include "bough/laws/formula.hpp"
#include "bough/laws/law_error.hpp"
#include "bough/scene/signals.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {

namespace {

using scene::SignalKind;

bool has_item_named(const JsonValue* list, const std::string& name) {
  return list != nullptr && list->is(JsonKind::array) &&
         std::any_of(list->items.begin(), list->items.end(), [&name](const JsonValue& item) {
           const JsonValue* of_item = item.is(JsonKind::object) ? item.find("name") : nullptr;
           return of_item != nullptr && of_item->is(JsonKind::string) && of_item->text.str() == name;
         });
}

}  // namespace

/// Names of all signals of the document that formulas can call.
void Converter::find_signal_names() {
  for (const char* key : {"signals", "actuators"}) {
    const Value* list = root_.find(key);
    if (list == nullptr || !list->is(JsonKind::array)) continue;
    for (const Value& item : list->items)
      if (const Value* name = item.is(JsonKind::object) ? item.find("name") : nullptr;
          name != nullptr && name->is(JsonKind::string) && scene::is_signal_name(name->text.str()))
        signal_names_.push_back(name->text);
  }
}

/// The formula of a signal, in the values of those signals that it names.
void Converter::signal_formula(const Value& v, const std::string& at, scene::Signal& s) {
  const std::string text = v.find("expression")->text;
  for (const laws::NamePlace& place : laws::names_in(text)) {
    const std::string name = text.substr(place.position, place.length);
    const bool is_signal = std::find(signal_names_.begin(), signal_names_.end(), name) != signal_names_.end();
    if (is_signal && std::find(s.inputs.begin(), s.inputs.end(), name) == s.inputs.end()) s.inputs.push_back(name);
  }
  try {
    s.formula = laws::Formula(text, s.inputs);
  } catch (const laws::LawError& e) {
    const std::string where = "at character " + std::to_string(e.position + 1) + ": " +
                              shown_in_quotes(text.substr(std::min(e.position, text.size())), 20);
    fault(at + "/expression", e.what(),
          where + "; a formula names signals and parameters, and a signal of kind \"time\" brings in t");
  }
}

/// A table of two signals.
void Converter::signal_surface(const Value& v, const std::string& at, scene::Signal& s) {
  for (const Value& name : v.find("of")->items) s.inputs.push_back(name.text);
  const auto numbers = [&v](const char* key) {
    std::vector<double> list;
    for (const Value& x : v.find(key)->items) list.push_back(x.number);
    return list;
  };
  const std::vector<double> ys = numbers("y");
  std::vector<double> values;
  const Value& rows = *v.find("values");
  for (std::size_t i = 0; i < rows.items.size(); ++i) {
    for (const Value& x : rows.items[i].items) values.push_back(x.number);
    if (rows.items[i].items.size() != ys.size())
      fault(at + "/values/" + std::to_string(i), "a row needs one value per y: " + std::to_string(ys.size()));
  }
  const std::vector<double> xs = numbers("x");
  if (rows.items.size() != xs.size())
    return fault(at + "/values", "the table needs one row per x: " + std::to_string(xs.size()));
  if (values.size() != xs.size() * ys.size()) return;  // told above
  try {
    s.surface = laws::Surface(xs, ys, std::move(values));
  } catch (const laws::LawError& e) {
    fault(at, e.what());
  }
}

/// A word that no signal of the document has.
std::string Converter::unused_signal_name(std::string name) {
  const auto is_in = [&name](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  while (is_in(signal_names_) || is_in(own_signal_names_)) name += "_";
  own_signal_names_.push_back(name);
  return name;
}

/// Makes a state x a multiple of a state in units of its nominal size, y' = f/nominal, whose errors count as they are.
void Converter::take_in_units(const Value& v, const std::string& at, double nominal, scene::Signal& s) {
  std::string unit = "(";
  append_number(unit, nominal);
  unit += ")";
  scene::Signal in_units = s;
  in_units.name = unused_signal_name(s.name + "_of_nominal");
  in_units.formula = laws::Formula("(" + v.find("expression")->text.str() + ")/" + unit, s.inputs);
  in_units.start = s.start / nominal;
  s.kind = SignalKind::formula;
  s.inputs = {in_units.name};
  s.formula = laws::Formula(unit + "*" + in_units.name, s.inputs);
  s.start = 0.0;
  add(scene.signals, "signals", std::move(in_units), at);
}

/// A component of a reaction is the multiplier of a row with the sign changed, as an effort is; where its own sign is
/// the other one, a formula turns it.
void Converter::reaction(const Value& component, const std::string& at, scene::Signal s) {
  s.kind = SignalKind::joint_effort;
  s.coordinate = component.text;
  const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [&s](const scene::Joint& other) { return other.name == s.joint; });
  const auto row =
      joint == scene.joints.end() ? std::nullopt : scene::reaction_row(scene::type_of(joint->kind), s.coordinate);
  if (row && row->sign > 0.0) {
    scene::Signal turned;
    turned.name = std::exchange(s.name, unused_signal_name(s.name + "_turned"));
    turned.inputs = {s.name};
    turned.formula = laws::Formula("-" + s.name, turned.inputs);
    add(scene.signals, "signals", std::move(turned), at);
  }
  add(scene.signals, "signals", std::move(s), at);
}

void Converter::signal(const Value& v, const std::string& at) {
  scene::Signal s;
  s.name = v.find("name")->text;
  if (const Value* numbers = root_.find("parameters"); numbers != nullptr && numbers->find(s.name) != nullptr)
    fault(at + "/name", "a parameter has this name, and formulas would take its number");
  s.joint = text_or(v, "joint");
  if (const Value* component = v.find("component")) return reaction(*component, at, std::move(s));
  s.kind = scene::signal_kind_named(v.find("kind")->text.str()).value();  // the schema takes no other names
  s.coordinate = text_or(v, "coordinate");
  s.spring = text_or(v, "spring");
  if (s.kind == SignalKind::surface)
    signal_surface(v, at, s);
  else
    s.of = text_or(v, "of");
  s.start = number_or(v, "start", 0.0);
  if (const Value* where = v.find("at")) {
    s.at = attachment(*where, at + "/at");
    s.axis = v.find("axis")->text.str().front() - 'x';
    s.frame = frame_name(v);
  }
  const auto is_strut_of_spring = [&s](const scene::Joint& joint) { return joint.name == s.spring; };
  if (s.kind == SignalKind::spring_tension && has_item_named(root_.find("springs"), s.spring) &&
      std::any_of(scene.joints.begin(), scene.joints.end(), is_strut_of_spring)) {
    // A spring with more than constants: its tension is minus all that acts along its strut.
    const auto known = std::find_if(scene.signals.begin(), scene.signals.end(), [&s](const scene::Signal& other) {
      return other.kind == SignalKind::joint_effort && other.joint == s.spring;
    });
    scene::Signal effort;
    effort.kind = SignalKind::joint_effort;
    effort.joint = s.spring;
    effort.name = known != scene.signals.end() ? known->name : unused_signal_name(s.name + "_effort");
    s.kind = SignalKind::formula;
    s.spring.clear();
    s.inputs = {effort.name};
    s.formula = laws::Formula("-" + effort.name, s.inputs);
    if (known == scene.signals.end()) add(scene.signals, "signals", std::move(effort), at);
    return add(scene.signals, "signals", std::move(s), at);
  }
  if (const Value* given = v.find("law")) s.law = law(*given, at + "/law");
  if (s.kind == SignalKind::formula || s.kind == SignalKind::state) signal_formula(v, at, s);
  if (!s.of.empty()) s.inputs.assign(1, s.of);
  if (const double nominal = number_or(v, "nominal", 1.0); nominal != 1.0 && faults.size() == faults_before_)
    take_in_units(v, at, nominal, s);
  add(scene.signals, "signals", std::move(s), at);
}

/// The law of a drive, an effort or a load, unless a signal is named in its place.
laws::Law Converter::law_or_signal(const Value& v, const std::string& at, std::string& signal) {
  if (const Value* name = v.is(JsonKind::object) ? v.find("signal") : nullptr) {
    signal = name->text;
    return {};
  }
  return law(v, at);
}

}  // namespace bough::io
