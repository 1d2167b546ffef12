/// Reads servos: efforts along a coordinate of a joint by gains, limits and lags, made of signals.
#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "bough/laws/formula.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/scene/signals.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {

using scene::SignalKind;

/// The joint of this name, which was read before; nullptr, told, if there is none.
scene::Joint* Converter::joint_to_drive(const std::string& name, const std::string& at) {
  if (scene::Joint* joint = joint_named(name)) return joint;
  left_out_ |= is_defective(name);
  if (left_out_) return nullptr;
  std::vector<std::string> names;
  if (!search_.is_spent())
    for (const scene::Joint& joint : scene.joints) names.push_back(joint.name);
  fault(at, "no joint has this name", did_you_mean(name, names));
  return nullptr;
}

bool Converter::find_coordinate(const Value& v, const std::string& at, Servo& servo) {
  const scene::JointType& type = scene::type_of(servo.joint->kind);
  servo.coordinate = text_or(v, "coordinate");
  if (servo.coordinate.empty() && type.coordinates.size() == 1) servo.coordinate = type.coordinates.front().name;
  if (const scene::JointCoordinate* along = type.coordinate(servo.coordinate)) {
    servo.is_length = along->is_length();
    return true;
  }
  std::string known;
  for (const scene::JointCoordinate& c : type.coordinates) known += (known.empty() ? "" : " or ") + c.name;
  fault(at + (v.find("coordinate") == nullptr ? "/joint" : "/coordinate"),
        "a " + type.name + " joint has no such coordinate that a servo could drive",
        known.empty() ? "" : "\"coordinate\" is " + known);
  return false;
}

std::string Converter::add_time(const laws::Law& law, const std::string& name, const std::string& at) {
  scene::Signal made;
  made.kind = SignalKind::time;
  made.name = unused_signal_name(name);
  made.law = law;
  const std::string known = made.name;
  add_signal(std::move(made), at);
  return known;
}

/// The signal that is the rate of a target, a law or the name of a signal; "0" where it does not change.
std::string Converter::rate_of(const Value& target, const std::string& at, const std::string& name) {
  std::string signal;
  const laws::Law law = law_or_signal(target, at, signal);
  if (!signal.empty()) return rate_of_signal(signal, at, name);
  return law.is_constant() || faults.size() != faults_before_ ? "0" : add_time(laws::make_rate(law), name, at);
}

/// The rate of a law of time is a law of time; what joints and points do is read as a rate; that of a state is its
/// formula. Inputs change in steps. Of the rest a program would have to give it, and a hint says so.
std::string Converter::rate_of_signal(const std::string& signal, const std::string& at, const std::string& name) {
  const Value* list = root_.find("signals");
  if (given_signals_.empty() && list != nullptr && list->is(JsonKind::array))
    for (const Value& item : list->items)
      if (item.sound && item.is(JsonKind::object))
        if (const Value* own = item.find("name"); own != nullptr) given_signals_.emplace(own->text.str(), &item);
  const auto place = given_signals_.find(signal);
  const Value* given = place == given_signals_.end() ? nullptr : place->second;
  const Value* kind_name = given == nullptr ? nullptr : given->find("kind");
  const auto kind = kind_name == nullptr ? std::nullopt : scene::signal_kind_named(kind_name->text.str());
  if (kind == SignalKind::input) return "0";
  if (kind == SignalKind::time) {
    const laws::Law of_time = law(*given->find("law"), at);
    return of_time.is_constant() ? "0" : add_time(laws::make_rate(of_time), name, at);
  }
  scene::Signal rate;
  rate.name = unused_signal_name(name);
  const std::string known = rate.name;
  if (kind == SignalKind::joint_angle || kind == SignalKind::joint_displacement) {
    rate.kind = SignalKind::joint_rate;
    rate.joint = text_or(*given, "joint");
    rate.coordinate = kind == SignalKind::joint_angle ? "angle" : "displacement";
  } else if (kind == SignalKind::position) {
    rate.kind = SignalKind::velocity;
    rate.at = attachment(*given->find("at"), at);
    rate.axis = given->find("axis")->text.str().front() - 'x';
    rate.frame = frame_name(*given);
  } else if (kind == SignalKind::state) {
    rate.kind = SignalKind::formula;
    signal_formula(*given, at, rate);
  } else {
    if (given != nullptr)
      warnings.push_back({at, "\"" + signal + "\"",
                          "the rate of this signal does not follow by itself: it is taken as 0",
                          "give \"target_rate\", as a law or a signal, or 0"});
    return "0";
  }
  add_signal(std::move(rate), at);
  return known;
}

/// T = limited(wanted), behind a lag as a state: in units of the limit, so that its errors count relative to that,
///   lag y' = limited(wanted / limit) - y,   |limited| <= 1,   T = limit y.
/// y stays within its limits, so that nothing winds up.
void Converter::add_effort(const Value& v, const Servo& servo, const std::string& wanted,
                           std::vector<std::string> inputs, const std::string& at) {
  const std::string unit = servo.limit ? in_brackets(*servo.limit) : "(1)";
  const std::string limited = servo.limit ? "min(max((" + wanted + ")/" + unit + ", -1), 1)" : "(" + wanted + ")";
  scene::Signal effort;
  effort.name = servo.name;
  if (!servo.lag) {
    effort.inputs = std::move(inputs);
    effort.formula = laws::Formula(unit + "*" + limited, effort.inputs);
    return add_signal(std::move(effort), at);
  }
  scene::Signal state;
  state.kind = SignalKind::state;
  state.name = unused_signal_name(servo.stem + (servo.limit ? "of_limit" : "lagging"));
  inputs.insert(inputs.begin(), state.name);
  state.inputs = std::move(inputs);
  state.formula = laws::Formula("(" + limited + " - " + state.name + ")/" + in_brackets(*servo.lag), state.inputs);
  state.start = v.find("start")->number / servo.limit.value_or(1.0);
  state.unit = servo.limit ? "-" : servo.is_length ? "N" : "N m";
  effort.inputs = {state.name};
  effort.formula = laws::Formula(unit + "*" + state.name, effort.inputs);
  add_signal(std::move(state), at);
  add_signal(std::move(effort), at);
}

/// A servo: wanted = position_gain (target - q) + rate_gain (target_rate - q') along a coordinate q of a joint.
void Converter::actuator(const Value& v, const std::string& at) {
  Servo servo;
  servo.name = v.find("name")->text;
  if (!laws::is_formula_name(servo.name))  // its formulas are made of it
    return fault(at + "/name", "formulas cannot call a signal by this name",
                 "an actuator is also a signal: a letter or _, then letters, digits and _");
  servo.stem = servo.name + "_";
  servo.joint = joint_to_drive(v.find("joint")->text, at + "/joint");
  if (servo.joint == nullptr || !find_coordinate(v, at, servo)) return;
  constexpr std::size_t most_forces = 4;
  if (servo.joint->forces.size() == most_forces)
    return fault(at + "/joint", "the joint has " + std::to_string(most_forces) + " forces already, and takes no more",
                 "put springs or efforts along one coordinate together");
  if (const Value* limit = v.find("limit")) servo.limit = limit->number;
  if (const Value* lag = v.find("lag")) servo.lag = lag->number;
  const double start = v.find("start")->number;
  if (servo.limit && std::abs(start) > *servo.limit)
    fault(at + "/start", "lies beyond the limit of " + rounded_text(*servo.limit, 6));
  if (!servo.lag && start != 0.0)
    fault(at + "/start", "without a lag the effort has no start of its own", "give a \"lag\", or leave \"start\" out");
  scene::Signal way, rate;
  const auto reading = [&](scene::Signal& s, SignalKind kind, const char* end) {
    s.kind = kind;
    s.name = unused_signal_name(servo.stem + end);
    s.joint = servo.joint->name;
    s.coordinate = servo.coordinate;
  };
  reading(way, servo.is_length ? SignalKind::joint_displacement : SignalKind::joint_angle, "coordinate");
  reading(rate, SignalKind::joint_rate, "rate");
  const Value *wanted_place = v.find("target"), *wanted_rate = v.find("target_rate");
  const std::string target = signal_of(*wanted_place, at + "/target", servo.stem + "target");
  const bool feels_rate = v.find("rate_gain")->number != 0.0;
  const std::string target_rate = wanted_rate != nullptr
                                      ? signal_of(*wanted_rate, at + "/target_rate", servo.stem + "target_rate")
                                  : feels_rate ? rate_of(*wanted_place, at + "/target", servo.stem + "target_rate")
                                               : "0";
  if (faults.size() != faults_before_) return;
  std::vector<std::string> inputs{way.name, rate.name, target};
  if (target_rate != target && target_rate != "0") inputs.push_back(target_rate);
  const auto given = [&v](const char* key) { return in_brackets(v.find(key)->number); };
  const std::string wanted = given("position_gain") + "*(" + target + " - " + way.name + ") + " + given("rate_gain") +
                             "*(" + target_rate + " - " + rate.name + ")";
  servo.joint->forces.push_back({servo.coordinate, 0.0, 0.0, 0.0, {}, servo.name});
  for (scene::Signal* signal : {&way, &rate}) add_signal(std::move(*signal), at);
  add_effort(v, servo, wanted, std::move(inputs), at);
}

}  // namespace bough::io
