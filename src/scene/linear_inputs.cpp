#include "bough/scene/linear_inputs.hpp"

#include <algorithm>
#include <optional>

#include "bough/scene/joint_kinds.hpp"
#include "bough/scene/nearest_name.hpp"

namespace bough::scene {

namespace {

template <class List>
std::optional<std::size_t> index_in(const List& list, const std::string& name) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return i;
  return std::nullopt;
}

InputPlace no_place(std::string fault, std::string hint = {}) {
  InputPlace place;
  place.fault = std::move(fault);
  place.hint = std::move(hint);
  return place;
}

/// "\"x\" or \"angle\""
std::string choice_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0 ? "\"" : k + 1 == words.size() ? " or \"" : ", \"") + words[k] + "\"";
  return text;
}

InputPlace in_motion(const Scene& scene, std::size_t index, const std::string& component) {
  const PrescribedMotion& motion = scene.motions[index];
  std::vector<std::string> has;
  std::vector<InputPlace> places;
  for (std::size_t k = 0; k < 3; ++k)
    if (motion.displacement[k] || !motion.displacement_signal[k].empty()) {
      has.emplace_back(1, "xyz"[k]);
      places.push_back({InputPlace::Kind::displacement, index, k, "m", {}, {}});
    }
  if (motion.rotation_axis) {
    has.emplace_back("angle");
    places.push_back({InputPlace::Kind::angle, index, 0, "rad", {}, {}});
  }
  if (motion.is_rate)
    return no_place("its laws are rates, to which no coordinate can be added",
                    "prescribe the coordinate itself, not its rate");
  if (has.empty()) return no_place("it prescribes no coordinate");
  if (component.empty() && has.size() == 1) return places.front();
  const auto found = std::find(has.begin(), has.end(), component);
  if (found == has.end())
    return no_place(component.empty() ? "it prescribes several components" : "it does not prescribe this component",
                    "\"component\": " + choice_of(has));
  return places[static_cast<std::size_t>(found - has.begin())];
}

InputPlace in_joint(const Scene& scene, std::size_t index, const std::string& component) {
  const Joint& joint = scene.joints[index];
  const JointType& type = type_of(joint.kind);
  std::vector<std::string> has;
  std::vector<InputPlace> places;
  bool has_rates = false;
  for (std::size_t k = 0; k < joint.drives.size(); ++k) {
    const JointCoordinate* coordinate = type.coordinate(joint.drives[k].coordinate);
    has_rates = has_rates || joint.drives[k].is_rate;
    if (coordinate == nullptr || joint.drives[k].is_rate) continue;
    has.push_back(coordinate->name);
    places.push_back({InputPlace::Kind::drive, index, k, coordinate->is_length() ? "m" : "rad", {}, {}});
  }
  for (std::size_t k = 0; k < joint.forces.size(); ++k) {
    const JointCoordinate* coordinate = type.coordinate(joint.forces[k].coordinate);
    if (coordinate == nullptr || std::find(has.begin(), has.end(), coordinate->name) != has.end()) continue;
    has.push_back(coordinate->name);
    places.push_back({InputPlace::Kind::effort, index, k, coordinate->is_length() ? "N" : "N m", {}, {}});
  }
  if (has.empty())
    return no_place(has_rates ? "its drives prescribe rates, to which no coordinate can be added"
                              : "this joint has neither a drive nor an effort",
                    has_rates ? "let the drive prescribe the coordinate itself"
                              : "give it an entry of \"forces\" with its coordinate, which may be {\"coordinate\": \"" +
                                    (type.coordinates.empty() ? "angle" : type.coordinates.front().name) + "\"}");
  if (component.empty() && has.size() == 1) return places.front();
  const auto found = std::find(has.begin(), has.end(), component);
  if (found == has.end())
    return no_place(component.empty() ? "this joint has drives or efforts along several coordinates"
                                      : "this joint has no drive or effort along this coordinate",
                    "\"component\": " + choice_of(has));
  return places[static_cast<std::size_t>(found - has.begin())];
}

/// The signal "law + u", whose law or signal is that of a part before.
class InputMaker {
 public:
  explicit InputMaker(const Scene& scene) : scene_(scene) {}

  void add(const LinearInput& input) {
    const InputPlace place = place_of(scene_, input);
    switch (place.kind) {
      case InputPlace::Kind::point_load:
        return put(input, place, scene_.point_loads[place.index].law, scene_.point_loads[place.index].signal);
      case InputPlace::Kind::line_load:
        return put(input, place, scene_.line_loads[place.index].law, scene_.line_loads[place.index].signal);
      case InputPlace::Kind::displacement: {
        PrescribedMotion& motion = scene_.motions[place.index];
        put(input, place, motion.displacement[place.part].value_or(laws::Law{}),
            motion.displacement_signal[place.part]);
        motion.displacement[place.part].emplace();
        return;
      }
      case InputPlace::Kind::angle:
        return put(input, place, scene_.motions[place.index].angle, scene_.motions[place.index].angle_signal);
      case InputPlace::Kind::drive: {
        JointDrive& drive = scene_.joints[place.index].drives[place.part];
        return put(input, place, drive.law, drive.signal);
      }
      case InputPlace::Kind::effort: {
        JointForce& force = scene_.joints[place.index].forces[place.part];
        return put(input, place, force.effort, force.signal);
      }
      case InputPlace::Kind::signal:
      case InputPlace::Kind::none:
        return;
    }
  }
  Scene scene() && { return std::move(scene_); }

 private:
  void put(const LinearInput& input, const InputPlace& place, const laws::Law& law, std::string& signal) {
    static const std::vector<std::string> terms{"law", "change"};
    const std::string name = name_of(input);
    Signal change, sum;
    change.name = name;
    change.kind = SignalKind::input;
    change.unit = place.unit.empty() ? "-" : place.unit;
    sum.name = name + " with its law";
    sum.kind = SignalKind::formula;
    sum.formula = laws::Formula("law + change", terms);
    sum.inputs = {signal, change.name};
    sum.unit = change.unit;
    if (signal.empty()) {
      Signal given;
      given.name = sum.inputs.front() = "law of " + name;
      given.kind = SignalKind::time;
      given.law = law;
      given.unit = change.unit;
      scene_.signals.push_back(std::move(given));
    }
    signal = sum.name;
    scene_.signals.push_back(std::move(change));
    scene_.signals.push_back(std::move(sum));
  }

  Scene scene_;
};

}  // namespace

InputPlace place_of(const Scene& scene, const LinearInput& input) {
  using Kind = InputPlace::Kind;
  const auto alone = [&](Kind kind, std::size_t index, std::string unit) -> InputPlace {
    if (!input.component.empty()) return no_place("this has no components", "leave out \"component\"");
    return {kind, index, 0, std::move(unit), {}, {}};
  };
  if (const auto i = index_in(scene.point_loads, input.of)) return alone(Kind::point_load, *i, "");
  if (const auto i = index_in(scene.line_loads, input.of)) return alone(Kind::line_load, *i, "");
  if (const auto i = index_in(scene.motions, input.of)) return in_motion(scene, *i, input.component);
  if (const auto i = index_in(scene.joints, input.of)) return in_joint(scene, *i, input.component);
  if (const auto i = index_in(scene.signals, input.of)) {
    if (scene.signals[*i].kind != SignalKind::input)
      return no_place("this signal is no input", "only a signal of kind \"input\" is free to be given");
    return alone(Kind::signal, *i, scene.signals[*i].unit == "-" ? "" : scene.signals[*i].unit);
  }
  std::vector<std::string> known;
  const auto add = [&](const auto& list) {
    for (const auto& item : list) known.push_back(item.name);
  };
  add(scene.point_loads);
  add(scene.line_loads);
  add(scene.motions);
  add(scene.joints);
  for (const Signal& s : scene.signals)
    if (s.kind == SignalKind::input) known.push_back(s.name);
  const std::string near = nearest_name(input.of, known);
  return no_place("no load, prescribed motion, joint or input signal has this name",
                  near.empty() ? "" : "did you mean '" + near + "'?");
}

std::string name_of(const LinearInput& input) {
  return input.of + (input.component.empty() ? "" : "." + input.component);
}

Scene with_inputs(const Scene& scene) {
  InputMaker maker(scene);
  for (const LinearInput& input : scene.analysis.linear.inputs) maker.add(input);
  return std::move(maker).scene();
}

std::vector<std::string> signals_of_inputs(const Scene& scene) {
  std::vector<std::string> names;
  for (const LinearInput& input : scene.analysis.linear.inputs) names.push_back(name_of(input));
  return names;
}

}  // namespace bough::scene
