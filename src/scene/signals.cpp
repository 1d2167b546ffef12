#include "bough/scene/signals.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "bough/laws/formula.hpp"

namespace bough::scene {

namespace {

constexpr std::array<std::pair<SignalKind, std::string_view>, 9> kinds{
    {{SignalKind::joint_angle, "joint_angle"},
     {SignalKind::joint_displacement, "joint_displacement"},
     {SignalKind::joint_rate, "joint_rate"},
     {SignalKind::position, "position"},
     {SignalKind::velocity, "velocity"},
     {SignalKind::time, "time"},
     {SignalKind::function, "function"},
     {SignalKind::formula, "formula"},
     {SignalKind::state, "state"}}};

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
  if (signal.kind == SignalKind::joint_rate) return &joint.coordinates.front();
  const auto length = std::find_if(joint.coordinates.begin(), joint.coordinates.end(),
                                   [](const JointCoordinate& c) { return c.is_length(); });
  return length == joint.coordinates.end() ? nullptr : &*length;
}

bool reads_joint(SignalKind kind) { return kind <= SignalKind::joint_rate; }
bool reads_point(SignalKind kind) { return kind == SignalKind::position || kind == SignalKind::velocity; }

std::vector<std::size_t> order_of_signals(const std::vector<Signal>& signals) {
  std::unordered_map<std::string_view, std::size_t> index_of;
  for (std::size_t i = 0; i < signals.size(); ++i) index_of.emplace(signals[i].name, i);
  std::vector<std::vector<std::size_t>> users(signals.size());
  std::vector<int> waits(signals.size(), 0);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i].kind != SignalKind::state)
      for (const std::string& input : signals[i].inputs)
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
