#include "bough/scene/signals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "bough/laws/formula.hpp"
#include "bough/scene/couplings.hpp"
#include "bough/scene/joint_efforts.hpp"

namespace bough::scene {

namespace {

/// The first part of each name.
template <class Part>
class Named {
 public:
  explicit Named(const std::vector<Part>& parts) {
    for (const Part& part : parts) of_.emplace(part.name, &part);
  }
  /// nullptr if there is none.
  const Part* find(const std::string& name) const {
    const auto part = of_.find(name);
    return part == of_.end() ? nullptr : part->second;
  }

 private:
  std::unordered_map<std::string_view, const Part*> of_;
};

/// Parts that signals read.
struct PartsRead {
  explicit PartsRead(const Scene& scene) : joints(scene.joints), couplings(scene.couplings) {}
  Named<Joint> joints;
  Named<Coupling> couplings;
};

}  // namespace

const std::vector<SignalType>& signal_types() {
  using Field = SignalField;
  using Kind = SignalKind;
  using Reads = SignalReads;
  static const std::vector<SignalType> types = {
      {Kind::joint_angle, "joint_angle", Reads::joint, 0, {Field::joint}, "rad", "Angle of a joint, counting turns."},
      {Kind::joint_displacement,
       "joint_displacement",
       Reads::joint,
       0,
       {Field::joint},
       "m",
       "Displacement of a joint."},
      {Kind::joint_rate,
       "joint_rate",
       Reads::joint,
       1,
       {Field::joint, Field::coordinate},
       "rad/s or m/s",
       "Rate of a joint's coordinate; in statics 0."},
      {Kind::joint_effort,
       "joint_effort",
       Reads::joint,
       2,
       {Field::joint, Field::coordinate, Field::effort_part},
       "N m or N",
       "Torque or force on the second along a coordinate: of all that acts along it, or of one part of that."},
      {Kind::spring_tension,
       "spring_tension",
       Reads::spring,
       1,
       {Field::spring},
       "N",
       "Tension of a spring, with its damper and all else that it has."},
      {Kind::position,
       "position",
       Reads::point,
       0,
       {Field::point, Field::frame},
       "m",
       "Component of a point's position, seen from a frame."},
      {Kind::velocity,
       "velocity",
       Reads::point,
       1,
       {Field::point, Field::frame},
       "m/s",
       "Component of a point's velocity, seen from a frame; in statics 0."},
      {Kind::time, "time", Reads::nothing, -1, {Field::law, Field::unit}, "of the law", "A law of time."},
      {Kind::function,
       "function",
       Reads::nothing,
       -1,
       {Field::of, Field::law, Field::unit},
       "of the law",
       "A law with another signal in the place of time: a table, a ramp."},
      {Kind::surface,
       "surface",
       Reads::nothing,
       -1,
       {Field::table, Field::unit},
       "of the values",
       "A table of two signals, bilinear between its points; outside the value of the nearest point."},
      {Kind::formula,
       "formula",
       Reads::nothing,
       -1,
       {Field::expression, Field::unit},
       "of the formula",
       "A formula of other signals and of parameters, as laws have, but without t."},
      {Kind::state,
       "state",
       Reads::nothing,
       -1,
       {Field::expression, Field::start, Field::nominal, Field::unit},
       "of the formula, times s",
       "x' = formula of signals, x included: integrators, lags, bristles. Integrated with the motion, to the same "
       "order. In statics, and in the equilibrium at a start, x' = 0."},
      {Kind::input,
       "input",
       Reads::nothing,
       -1,
       {Field::start, Field::unit},
       "its own",
       "A number that a program sets between steps (Simulation::set_input); where none does, as in `bough run`, it "
       "keeps its start."},
      {Kind::force,
       "force",
       Reads::motion,
       2,
       {Field::part},
       "N or N m",
       "Component of the force of a prescribed motion on its part, about the place and in the axes of the ground; or "
       "of a "
       "load, in the axes in which it is given, at its present size."},
      {Kind::joint_effort,
       "joint_reaction",
       Reads::joint,
       2,
       {Field::joint, Field::component},
       "N or N m",
       "Component of the reaction of the first on the second in what the joint holds, about the second's joint frame "
       "and in the axes of the first's."}};
  return types;
}

const SignalType& type_of(SignalKind kind) { return signal_types().at(static_cast<std::size_t>(kind)); }

std::string to_string(SignalKind kind) { return std::string(type_of(kind).name); }

std::optional<SignalKind> signal_kind_named(std::string_view name) {
  for (const SignalType& type : signal_types())
    if (type.name == name) return type.kind;
  return std::nullopt;
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

std::optional<ForceRow> force_row(const PrescribedMotion& motion, std::string_view component) {
  const int k = static_cast<int>(std::find(components.begin(), components.end(), component) - components.begin());
  if (k < 3) {
    if (!motion.displacement[k]) return std::nullopt;
    int row = 0;
    for (int i = 0; i < k; ++i) row += motion.displacement[i] ? 1 : 0;
    return ForceRow{false, row, -1.0};
  }
  if (k >= 6) return std::nullopt;
  if (motion.hold_rotation) return ForceRow{true, (k - 2) % 3, 1.0};  // e_i . R e_{i+1} = 0 holds axis i + 2
  if (!motion.rotation_axis) return std::nullopt;
  const double along = (*motion.rotation_axis)[k - 3],
               length = std::sqrt(dot(*motion.rotation_axis, *motion.rotation_axis));
  if (std::abs(along) < (1.0 - 1e-12) * length) return std::nullopt;
  return ForceRow{true, 2, along > 0.0 ? -1.0 : 1.0};
}

bool reads_joint(SignalKind kind) { return type_of(kind).reads == SignalReads::joint; }
bool reads_point(SignalKind kind) { return type_of(kind).reads == SignalReads::point; }

namespace {

/// Names of the signals of whose present values a signal is made.
std::vector<std::string> names_of_present_inputs(const PartsRead& parts, const Signal& signal) {
  if (signal.kind == SignalKind::state) return {};
  if (signal.kind != SignalKind::joint_effort) return signal.inputs;
  std::vector<std::string> names;
  const Joint* joint = parts.joints.find(signal.joint);
  if (joint == nullptr) return names;
  const JointType& type = type_of(joint->kind);
  const JointCoordinate* coordinate = coordinate_of(signal, type);
  const auto read = effort_parts(signal.of, *joint);
  if (coordinate == nullptr || !read || !read->effort) return names;
  for (const JointForce& f : joint->forces)
    if (!f.signal.empty() && read->takes(f) && acts_along(f.coordinate, type, *coordinate)) names.push_back(f.signal);
  return names;
}

/// The signals of each list of names, as indices; names that no signal has are left out.
template <class NamesOf>
std::vector<std::vector<std::size_t>> indices_of(const std::vector<Signal>& signals, NamesOf&& names_of) {
  std::unordered_map<std::string_view, std::size_t> index_of;
  for (std::size_t i = 0; i < signals.size(); ++i) index_of.emplace(signals[i].name, i);
  std::vector<std::vector<std::size_t>> indices(signals.size());
  for (std::size_t i = 0; i < signals.size(); ++i)
    for (const std::string& name : names_of(signals[i]))
      if (const auto known = index_of.find(name); known != index_of.end()) indices[i].push_back(known->second);
  return indices;
}

std::vector<std::vector<std::size_t>> users_of(const std::vector<std::vector<std::size_t>>& inputs) {
  std::vector<std::vector<std::size_t>> users(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i)
    for (const std::size_t input : inputs[i]) users[input].push_back(i);
  return users;
}

/// The level of what a signal reads itself, without its inputs.
int level_of_reading(const PartsRead& parts, const Signal& s) {
  if (s.kind == SignalKind::spring_tension) {
    const Coupling* spring = parts.couplings.find(s.spring);
    const auto force = spring == nullptr ? std::nullopt : line_force_of(*spring);
    return force && force->damping != 0.0 ? 1 : 0;
  }
  if (s.kind != SignalKind::joint_effort) return type_of(s.kind).level;
  if (reads_reaction(s)) return 2;
  const Joint* joint = parts.joints.find(s.joint);
  const JointType* type = joint == nullptr ? nullptr : &type_of(joint->kind);
  const JointCoordinate* coordinate = type == nullptr ? nullptr : coordinate_of(s, *type);
  const auto read = joint == nullptr ? std::nullopt : effort_parts(s.of, *joint);
  if (coordinate == nullptr || !read) return -1;
  int level = read->drive && type->holds(*coordinate) ? 2 : -1;
  for (const JointDrive& d : joint->drives)
    if (read->drive && acts_along(d.coordinate, *type, *coordinate)) level = 2;
  for (const JointForce& f : joint->forces) {
    if (!read->takes(f) || !acts_along(f.coordinate, *type, *coordinate)) continue;
    if (read->damper && f.damping != 0.0) level = std::max(level, 1);
    if (read->spring && f.stiffness != 0.0) level = std::max(level, 0);
  }
  return level;
}

}  // namespace

std::vector<std::vector<std::size_t>> present_inputs(const Scene& scene) {
  const PartsRead parts(scene);
  return indices_of(scene.signals, [&](const Signal& s) { return names_of_present_inputs(parts, s); });
}

std::vector<bool> read_rows(const Scene& scene) {
  const PartsRead parts(scene);
  std::vector<bool> of_rows;
  for (const Signal& s : scene.signals) of_rows.push_back(level_of_reading(parts, s) == 2);
  return of_rows;
}

std::vector<int> levels_of_signals(const Scene& scene) {
  const std::vector<Signal>& signals = scene.signals;
  const PartsRead parts(scene);
  std::vector<int> levels;
  for (const Signal& s : signals) levels.push_back(level_of_reading(parts, s));
  const auto users = users_of(indices_of(signals, [&](const Signal& s) {
    return s.kind == SignalKind::state ? s.inputs : names_of_present_inputs(parts, s);
  }));
  std::vector<std::size_t> grown(signals.size());
  std::iota(grown.begin(), grown.end(), std::size_t{0});
  while (!grown.empty()) {  // levels only grow, and end at 2
    const std::size_t input = grown.back();
    grown.pop_back();
    for (const std::size_t user : users[input]) {
      const int level = levels[input] - (signals[user].kind == SignalKind::state ? 1 : 0);
      if (level <= levels[user]) continue;
      levels[user] = level;
      grown.push_back(user);
    }
  }
  return levels;
}

std::vector<std::size_t> order_of_signals(const Scene& scene) {
  const std::vector<std::vector<std::size_t>> inputs = present_inputs(scene), users = users_of(inputs);
  std::vector<std::size_t> waits, order;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    waits.push_back(inputs[i].size());
    if (waits[i] == 0) order.push_back(i);
  }
  for (std::size_t k = 0; k < order.size(); ++k)
    for (const std::size_t user : users[order[k]])
      if (--waits[user] == 0) order.push_back(user);
  return order;
}

}  // namespace bough::scene
