/// Units of signals: declared, of what they read, of their formulas, or of what they drive.
#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "bough/scene/signals.hpp"

namespace bough::scene {

namespace {

using Unit = std::optional<std::string>;

/// Unit of a sum over time: "rad/s" gives "rad", "N/m" gives "N s/m".
std::string times_seconds(const std::string& unit) {
  if (unit.empty()) return "s";
  if (unit.find('(') != std::string::npos) return unit + " s";
  const std::size_t over = unit.find('/');
  if (over == std::string::npos) return unit + " s";
  const std::string above = unit.substr(0, over), below = unit.substr(over + 1);
  if (below == "s^2") return above + "/s";
  if (below == "s") return above == "1" ? "" : above;
  return (above == "1" ? "s" : above + " s") + "/" + below;
}

class SignalUnits {
 public:
  explicit SignalUnits(const Scene& scene)
      : scene_(scene), units_(scene.signals.size()), users_(scene.signals.size()), driven_(scene.signals.size()) {
    for (const Joint& joint : scene.joints) joint_of_.emplace(joint.name, &joint);
    for (std::size_t i = 0; i < scene.signals.size(); ++i) index_of_.emplace(scene.signals[i].name, i);
    for (std::size_t i = 0; i < scene.signals.size(); ++i)
      for (const std::string& input : scene.signals[i].inputs)
        if (const auto known = index_of_.find(input); known != index_of_.end()) users_[known->second].push_back(i);
  }

  std::vector<Unit> find() {
    for (std::size_t i = 0; i < units_.size(); ++i) {
      set(i, own_unit(scene_.signals[i]));
      set(i, unit_of_formula(scene_.signals[i]));
    }
    follow();
    list_driven();
    for (std::size_t i = 0; i < units_.size(); ++i)
      if (!driven_[i].is_mixed) set(i, driven_[i].unit);
    follow();
    return units_;
  }

 private:
  struct Driven {
    Unit unit;
    bool is_mixed = false;  ///< it drives numbers of several units
  };

  /// A unit, once found, stays.
  void set(std::size_t i, Unit unit) {
    if (units_[i] || !unit) return;
    units_[i] = std::move(unit);
    found_.push_back(i);
  }
  /// Formulas of signals whose units were found.
  void follow() {
    while (!found_.empty()) {
      const std::size_t i = found_.back();
      found_.pop_back();
      for (const std::size_t user : users_[i])
        if (!units_[user]) set(user, unit_of_formula(scene_.signals[user]));
    }
  }

  /// Declared, or that of what the signal reads.
  Unit own_unit(const Signal& s) const {
    if (!s.unit.empty()) return s.unit == "-" ? std::string() : s.unit;
    switch (s.kind) {
      case SignalKind::joint_rate:
      case SignalKind::joint_effort:
        return unit_of_joint(s);
      case SignalKind::force:
        return std::string(!s.coordinate.empty() && s.coordinate.front() == 'm' ? "N m" : "N");
      case SignalKind::joint_angle:
      case SignalKind::joint_displacement:
      case SignalKind::spring_tension:
      case SignalKind::position:
      case SignalKind::velocity:
        return std::string(type_of(s.kind).unit);
      case SignalKind::time:
      case SignalKind::function:
      case SignalKind::surface:
      case SignalKind::formula:
      case SignalKind::state:
      case SignalKind::input:
        break;
    }
    return std::nullopt;
  }
  Unit unit_of_joint(const Signal& s) const {
    if (reads_reaction(s)) return std::string(s.coordinate.front() == 'f' ? "N" : "N m");
    const auto joint = joint_of_.find(s.joint);
    const JointCoordinate* coordinate =
        joint == joint_of_.end() ? nullptr : coordinate_of(s, type_of(joint->second->kind));
    if (coordinate == nullptr) return std::nullopt;
    if (s.kind == SignalKind::joint_rate) return std::string(coordinate->is_length() ? "m/s" : "rad/s");
    return std::string(coordinate->is_length() ? "N" : "N m");
  }

  Unit unit_of_formula(const Signal& s) const {
    if (s.kind != SignalKind::formula && s.kind != SignalKind::state) return std::nullopt;
    std::vector<Unit> units;
    for (const std::string& input : s.inputs) {
      const auto known = index_of_.find(input);
      units.push_back(known == index_of_.end() ? std::nullopt : units_[known->second]);
    }
    Unit unit = s.formula.unit_if_known(units);
    if (unit && s.kind == SignalKind::state) unit = times_seconds(*unit);
    return unit;
  }

  void drive(const std::string& signal, const char* unit) {
    const auto known = signal.empty() ? index_of_.end() : index_of_.find(signal);
    if (known == index_of_.end()) return;
    Driven& driven = driven_[known->second];
    driven.is_mixed |= driven.unit && *driven.unit != unit;
    driven.unit = unit;
  }
  void list_driven() {
    for (const Joint& joint : scene_.joints) {
      const JointType& type = type_of(joint.kind);
      const auto is_length = [&type](const std::string& name) {
        const JointCoordinate* c = type.coordinates.size() == 1 ? &type.coordinates.front() : type.coordinate(name);
        return c != nullptr && c->is_length();
      };
      for (const JointForce& force : joint.forces) drive(force.signal, is_length(force.coordinate) ? "N" : "N m");
      for (const JointDrive& d : joint.drives) drive(d.signal, is_length(d.coordinate) ? "m" : "rad");
    }
    for (const PrescribedMotion& motion : scene_.motions) {
      for (const std::string& signal : motion.displacement_signal) drive(signal, "m");
      drive(motion.angle_signal, "rad");
    }
  }

  const Scene& scene_;
  std::vector<Unit> units_;
  std::vector<std::vector<std::size_t>> users_;
  std::vector<Driven> driven_;
  std::vector<std::size_t> found_;
  std::unordered_map<std::string_view, const Joint*> joint_of_;
  std::unordered_map<std::string_view, std::size_t> index_of_;
};

}  // namespace

std::vector<std::optional<std::string>> units_of_signals(const Scene& scene) { return SignalUnits(scene).find(); }

}  // namespace bough::scene
