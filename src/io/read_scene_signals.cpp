/// Reads signals: numbers that change with the motion.
#include <algorithm>
#include <optional>
#include <utility>

#include "bough/elements/coupling_kinds.hpp"
#include "bough/io/number_text.hpp"
#include "bough/laws/formula.hpp"
#include "bough/laws/law_error.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/scene/signals.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {

namespace {

using scene::SignalKind;

/// Calls visit(name) for the names of a list of the document.
template <class Visit>
void for_each_name(const JsonValue* list, const Visit& visit) {
  if (list == nullptr || !list->is(JsonKind::array)) return;
  for (const JsonValue& item : list->items)
    if (const JsonValue* name = item.is(JsonKind::object) ? item.find("name") : nullptr;
        name != nullptr && name->is(JsonKind::string))
      visit(name->text.str());
}

}  // namespace

/// Names of all signals of the document that formulas can call, and those of springs.
void Converter::find_signal_names() {
  for (const char* key : {"signals", "actuators"})
    for_each_name(root_.find(key), [this](const std::string& name) {
      if (scene::is_signal_name(name)) signal_names_.push_back(name);
    });
  known_signals_.insert(signal_names_.begin(), signal_names_.end());
  taken_signal_names_ = known_signals_;
  for (const scene::CouplingKind* kind : elements::coupling_kinds())
    if (kind->acts_along_line)
      for_each_name(root_.find(kind->list), [this](const std::string& name) { springs_.insert(name); });
}

/// The first joint of this name among those read so far; nullptr if there is none.
scene::Joint* Converter::joint_named(const std::string& name) {
  for (; num_joints_indexed_ < scene.joints.size(); ++num_joints_indexed_)
    joint_of_.emplace(scene.joints[num_joints_indexed_].name, num_joints_indexed_);
  const auto joint = joint_of_.find(name);
  return joint == joint_of_.end() ? nullptr : &scene.joints[joint->second];
}

/// Whether an item of this name was left out.
bool Converter::is_defective(const std::string& name) {
  for (; num_defective_indexed_ < defective.size(); ++num_defective_indexed_)
    defective_names_.insert(defective[num_defective_indexed_]);
  return defective_names_.count(name) > 0;
}

void Converter::add_signal(scene::Signal signal, const std::string& at) {
  const std::size_t before = scene.signals.size();
  add(scene.signals, "signals", std::move(signal), at);
  if (scene.signals.size() == before) return;
  if (const scene::Signal& s = scene.signals.back(); s.kind == SignalKind::joint_effort && s.of.empty())
    effort_of_.emplace(s.joint, s.name);
}

/// The formula of a signal, in the values of those signals that it names.
void Converter::signal_formula(const Value& v, const std::string& at, scene::Signal& s) {
  const std::string text = v.find("expression")->text;
  for (const laws::NamePlace& place : laws::names_in(text)) {
    const std::string name = text.substr(place.position, place.length);
    if (known_signals_.count(name) > 0 && std::find(s.inputs.begin(), s.inputs.end(), name) == s.inputs.end())
      s.inputs.push_back(name);
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
  while (!taken_signal_names_.insert(name).second) name += "_";
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
  in_units.unit = "-";
  s.kind = SignalKind::formula;
  s.inputs = {in_units.name};
  s.formula = laws::Formula(unit + "*" + in_units.name, s.inputs);
  s.start = 0.0;
  add_signal(std::move(in_units), at);
}

/// A component of a reaction is the multiplier of a row with the sign changed, as an effort is; where its own sign is
/// the other one, a formula turns it.
void Converter::reaction(const Value& component, const std::string& at, scene::Signal s) {
  s.kind = SignalKind::joint_effort;
  s.coordinate = component.text;
  const scene::Joint* joint = joint_named(s.joint);
  const auto row = joint == nullptr ? std::nullopt : scene::reaction_row(scene::type_of(joint->kind), s.coordinate);
  add_turned(std::move(s), row ? row->sign : -1.0, at);
}

/// Adds a signal that reads a multiplier with its sign changed, as an effort is; sign: of the component times the
/// multiplier.
void Converter::add_turned(scene::Signal s, double sign, const std::string& at) {
  if (sign > 0.0) {
    scene::Signal turned;
    turned.name = std::exchange(s.name, unused_signal_name(s.name + "_turned"));
    turned.inputs = {s.name};
    turned.formula = laws::Formula("-" + s.name, turned.inputs);
    add_signal(std::move(turned), at);
  }
  add_signal(std::move(s), at);
}

/// A component of the force of a prescribed motion, or of a load: that has the factor of its law or signal.
void Converter::force(const Value& v, const std::string& at, scene::Signal s) {
  s.part = v.find("of")->text;
  s.coordinate = v.find("component")->text;
  const auto named = [&s](const auto& part) { return part.name == s.part; };
  const auto motion = std::find_if(scene.motions.begin(), scene.motions.end(), named);
  const auto load = std::find_if(scene.point_loads.begin(), scene.point_loads.end(), named);
  s.kind = SignalKind::force;
  if (motion != scene.motions.end()) {
    const auto row = scene::force_row(*motion, s.coordinate);
    return add_turned(std::move(s), row ? row->sign : -1.0, at);
  }
  if (load == scene.point_loads.end()) {
    left_out_ |= is_defective(s.part);
    if (left_out_) return;
    std::vector<std::string> names;
    for (const scene::PrescribedMotion& m : scene.motions) names.push_back(m.name);
    for (const scene::PointLoad& l : scene.point_loads) names.push_back(l.name);
    return fault(at + "/of", "no prescribed motion or load at a point has this name", did_you_mean(s.part, names));
  }
  const int k = s.coordinate.back() - 'x';
  const double size = s.coordinate.front() == 'f' ? load->force[k] : load->moment[k];
  s.unit = s.coordinate.front() == 'f' ? "N" : "N m";
  s.part.clear();
  s.coordinate.clear();
  if (!load->signal.empty()) {
    s.kind = SignalKind::formula;
    s.inputs = {load->signal};
    s.formula = laws::Formula(in_brackets(size) + "*" + load->signal, s.inputs);
  } else {
    s.kind = SignalKind::time;
    const bool grows = is_static_ && load->law.node() == nullptr;  // with the load factor
    s.law = grows                         ? laws::make_expression(in_brackets(size) + "*t")
            : load->law.node() == nullptr ? laws::make_constant(size)
                                          : laws::make_scaled(size, load->law);
  }
  add_signal(std::move(s), at);
}

/// `of` of a signal or sensor that reads an effort; empty: all of it.
std::string Converter::effort_part(const Value& v) const {
  std::string of = text_or(v, "of");
  return of == "all" ? std::string() : of;
}

/// The unit that a signal declares, for people.
std::string Converter::unit_of(const Value& v, const std::string& at) {
  const std::string unit = text_or(v, "unit");
  constexpr std::size_t most = 30;
  const bool has_controls =
      std::any_of(unit.begin(), unit.end(), [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7f; });
  if (unit.size() > most || has_controls)
    fault(at + "/unit", "is no unit",
          "a unit is a word of at most " + std::to_string(most) + " characters, as Pa or m^3/s");
  return unit;
}

void Converter::signal(const Value& v, const std::string& at) {
  scene::Signal s;
  s.name = v.find("name")->text;
  if (const Value* numbers = root_.find("parameters"); numbers != nullptr && numbers->find(s.name) != nullptr)
    fault(at + "/name", "a parameter has this name, and formulas would take its number");
  s.joint = text_or(v, "joint");
  if (v.find("kind")->text == "force") return force(v, at, std::move(s));
  if (const Value* component = v.find("component")) return reaction(*component, at, std::move(s));
  s.kind = scene::signal_kind_named(v.find("kind")->text.str()).value();  // the schema takes no other names
  s.coordinate = text_or(v, "coordinate");
  s.spring = text_or(v, "spring");
  if (s.kind == SignalKind::surface)
    signal_surface(v, at, s);
  else
    s.of = s.kind == SignalKind::joint_effort ? effort_part(v) : text_or(v, "of");
  s.start = number_or(v, "start", 0.0);
  s.unit = unit_of(v, at);
  if (const Value* where = v.find("at")) {
    s.at = attachment(*where, at + "/at");
    s.axis = v.find("axis")->text.str().front() - 'x';
    s.frame = frame_name(v);
  }
  if (s.kind == SignalKind::spring_tension && springs_.count(s.spring) > 0 && joint_named(s.spring) != nullptr) {
    // A spring with more than constants: its tension is minus all that acts along its strut.
    const auto known = effort_of_.find(s.spring);
    scene::Signal effort;
    effort.kind = SignalKind::joint_effort;
    effort.joint = s.spring;
    effort.name = known != effort_of_.end() ? known->second : unused_signal_name(s.name + "_effort");
    s.kind = SignalKind::formula;
    s.spring.clear();
    s.inputs = {effort.name};
    s.formula = laws::Formula("-" + effort.name, s.inputs);
    if (known == effort_of_.end()) add_signal(std::move(effort), at);
    return add_signal(std::move(s), at);
  }
  if (const Value* given = v.find("law")) s.law = law(*given, at + "/law");
  if (s.kind == SignalKind::formula || s.kind == SignalKind::state) signal_formula(v, at, s);
  if (s.kind == SignalKind::function) s.inputs.assign(1, s.of);
  if (const double nominal = number_or(v, "nominal", 1.0); nominal != 1.0 && faults.size() == faults_before_)
    take_in_units(v, at, nominal, s);
  add_signal(std::move(s), at);
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
