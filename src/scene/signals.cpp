#include "bough/scene/signals.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "bough/laws/formula.hpp"

namespace bough::scene {

namespace {

constexpr std::array<std::pair<SignalKind, std::string_view>, 13> kinds{
    {{SignalKind::joint_angle, "joint_angle"},
     {SignalKind::joint_displacement, "joint_displacement"},
     {SignalKind::joint_rate, "joint_rate"},
     {SignalKind::joint_effort, "joint_effort"},
     {SignalKind::spring_tension, "spring_tension"},
     {SignalKind::position, "position"},
     {SignalKind::velocity, "velocity"},
     {SignalKind::time, "time"},
     {SignalKind::function, "function"},
     {SignalKind::surface, "surface"},
     {SignalKind::formula, "formula"},
     {SignalKind::state, "state"},
     {SignalKind::input, "input"}}};

/// The joint of this name; nullptr if there is none.
const Joint* joint_named(const Scene& scene, const std::string& name) {
  const auto joint =
      std::find_if(scene.joints.begin(), scene.joints.end(), [&](const Joint& j) { return j.name == name; });
  return joint == scene.joints.end() ? nullptr : &*joint;
}

/// Whether a drive or a force of a joint is along the coordinate that a signal reads.
template <class Along>
bool acts_along(const Along& given, const JointType& type, const JointCoordinate& coordinate) {
  const JointCoordinate* own = type.coordinates.size() == 1 ? &type.coordinates[0] : type.coordinate(given.coordinate);
  return own != nullptr && own->kind == coordinate.kind;
}

}  // namespace

std::string to_string(SignalKind kind) {
  return std::string(
      std::find_if(kinds.begin(), kinds.end(), [kind](const auto& entry) { return entry.first == kind; })->second);
}

std::optional<SignalKind> signal_kind_named(std::string_view name) {
  const auto* const entry =
      std::find_if(kinds.begin(), kinds.end(), [name](const auto& e) { return e.second == name; });
  if (entry == kinds.end()) return std::nullopt;
  return entry->first;
}

bool is_signal_name(std::string_view name) {
  const std::vector<std::string>& words = laws::formula_words();
  return laws::is_formula_name(name) && std::find(words.begin(), words.end(), name) == words.end();
}

const JointCoordinate* coordinate_of(const Signal& signal, const JointType& joint) {
  if (signal.kind == SignalKind::joint_angle) return joint.coordinate("angle");
  if (joint.coordinates.empty()) return nullptr;
  if (!signal.coordinate.empty()) return joint.coordinate(signal.coordinate);
  if (signal.kind != SignalKind::joint_displacement) return &joint.coordinates.front();
  const auto length = std::find_if(joint.coordinates.begin(), joint.coordinates.end(),
                                   [](const JointCoordinate& c) { return c.is_length(); });
  return length == joint.coordinates.end() ? nullptr : &*length;
}

namespace {

constexpr std::array<std::string_view, 6> components{"fx", "fy", "fz", "mx", "my", "mz"};

/// Whether axis j of the second frame keeps the direction of that of the first: two rows hold it, or all axes are held.
bool is_aligned(const JointType& joint, int j) {
  int of_axis = 0, all = 0;
  for (const JointRow& row : joint.rows)
    if (row.kind == motion::RowKind::across) {
      of_axis += row.axes.j == j ? 1 : 0;
      ++all;
    }
  return of_axis == 2 || all == 3;
}

}  // namespace

bool reads_reaction(const Signal& signal) {
  return signal.kind == SignalKind::joint_effort &&
         std::find(components.begin(), components.end(), signal.coordinate) != components.end();
}

std::optional<ReactionRow> reaction_row(const JointType& joint, std::string_view component) {
  const auto* const at = std::find(components.begin(), components.end(), component);
  const int k = static_cast<int>(at - components.begin());
  for (std::size_t r = 0; r < joint.rows.size(); ++r) {
    const JointRow& row = joint.rows[r];
    const int i = row.axes.i, j = row.axes.j;
    if (row.kind == motion::RowKind::along && i == k) return ReactionRow{static_cast<int>(r), -1.0};
    if (row.kind != motion::RowKind::across || k != 6 - i - j || !is_aligned(joint, j)) continue;
    return ReactionRow{static_cast<int>(r), (j + 1) % 3 == i ? -1.0 : 1.0};  // e_j x e_i = e_k or -e_k
  }
  return std::nullopt;
}

bool reads_joint(SignalKind kind) { return kind <= SignalKind::joint_effort; }
bool reads_point(SignalKind kind) { return kind == SignalKind::position || kind == SignalKind::velocity; }

std::vector<std::string> present_inputs(const Scene& scene, const Signal& signal) {
  if (signal.kind == SignalKind::state) return {};
  if (signal.kind != SignalKind::joint_effort) return signal.inputs;
  std::vector<std::string> names;
  const Joint* joint = joint_named(scene, signal.joint);
  if (joint == nullptr) return names;
  const JointType& type = type_of(joint->kind);
  const JointCoordinate* coordinate = coordinate_of(signal, type);
  for (const JointForce& f : joint->forces)
    if (coordinate != nullptr && !f.signal.empty() && acts_along(f, type, *coordinate)) names.push_back(f.signal);
  return names;
}

namespace {

/// The level of what a signal reads itself, without its inputs.
int level_of_reading(const Scene& scene, const Signal& s) {
  switch (s.kind) {
    case SignalKind::joint_angle:
    case SignalKind::joint_displacement:
    case SignalKind::position:
      return 0;
    case SignalKind::joint_rate:
    case SignalKind::velocity:
      return 1;
    case SignalKind::spring_tension:
      for (const Spring& spring : scene.springs)
        if (spring.name == s.spring && spring.damping != 0.0) return 1;
      return 0;
    case SignalKind::joint_effort:
      break;
    default:
      return -1;
  }
  if (reads_reaction(s)) return 2;
  const Joint* joint = joint_named(scene, s.joint);
  const JointType* type = joint == nullptr ? nullptr : &type_of(joint->kind);
  const JointCoordinate* coordinate = type == nullptr ? nullptr : coordinate_of(s, *type);
  if (coordinate == nullptr) return -1;
  int level = type->holds(*coordinate) ? 2 : -1;
  for (const JointDrive& d : joint->drives)
    if (acts_along(d, *type, *coordinate)) level = 2;
  for (const JointForce& f : joint->forces)
    if (acts_along(f, *type, *coordinate)) level = std::max(level, f.damping != 0.0 ? 1 : f.stiffness != 0.0 ? 0 : -1);
  return level;
}

}  // namespace

std::vector<int> levels_of_signals(const Scene& scene) {
  const std::vector<Signal>& signals = scene.signals;
  std::unordered_map<std::string_view, std::size_t> index_of;
  std::vector<std::vector<std::size_t>> inputs(signals.size());
  std::vector<int> levels;
  for (std::size_t i = 0; i < signals.size(); ++i) index_of.emplace(signals[i].name, i);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    levels.push_back(level_of_reading(scene, signals[i]));
    for (const std::string& input :
         signals[i].kind == SignalKind::state ? signals[i].inputs : present_inputs(scene, signals[i]))
      if (const auto known = index_of.find(input); known != index_of.end()) inputs[i].push_back(known->second);
  }
  for (bool grows = true; grows;) {  // levels only grow, and end at 2
    grows = false;
    for (std::size_t i = 0; i < signals.size(); ++i)
      for (const std::size_t input : inputs[i]) {
        const int level = levels[input] - (signals[i].kind == SignalKind::state ? 1 : 0);
        if (level > levels[i]) {
          levels[i] = level;
          grows = true;
        }
      }
  }
  return levels;
}

std::vector<std::size_t> order_of_signals(const Scene& scene) {
  const std::vector<Signal>& signals = scene.signals;
  std::unordered_map<std::string_view, std::size_t> index_of;
  for (std::size_t i = 0; i < signals.size(); ++i) index_of.emplace(signals[i].name, i);
  std::vector<std::vector<std::size_t>> users(signals.size());
  std::vector<int> waits(signals.size(), 0);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    for (const std::string& input : present_inputs(scene, signals[i]))
      if (const auto known = index_of.find(input); known != index_of.end()) {
        users[known->second].push_back(i);
        ++waits[i];
      }
    if (waits[i] == 0) order.push_back(i);
  }
  for (std::size_t k = 0; k < order.size(); ++k)
    for (const std::size_t user : users[order[k]])
      if (--waits[user] == 0) order.push_back(user);
  return order;
}

}  // namespace bough::scene
