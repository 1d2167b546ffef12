/// Signals of a scene: their places among the values of laws, what they read, and which elements read them.
#include "bough/scene/signals.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "bough/scene/couplings.hpp"
#include "bough/scene/joint_efforts.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using motion::Mat3;
using motion::Vec3;

namespace {

SignalRule rule_of(scene::SignalKind kind) {
  using Kind = scene::SignalKind;
  switch (kind) {
    case Kind::joint_angle:
    case Kind::joint_displacement:
    case Kind::position:
      return SignalRule::coordinate;
    case Kind::joint_rate:
    case Kind::velocity:
      return SignalRule::rate;
    case Kind::function:
      return SignalRule::function;
    case Kind::state:
      return SignalRule::state;
    case Kind::joint_effort:
    case Kind::spring_tension:
    case Kind::force:
      return SignalRule::effort;
    case Kind::surface:
      return SignalRule::surface;
    case Kind::input:
      return SignalRule::input;
    case Kind::time:
    case Kind::formula:
      break;
  }
  return SignalRule::formula;
}

/// First item of each name.
template <class T>
std::unordered_map<std::string_view, const T*> by_name(const std::vector<T>& list) {
  std::unordered_map<std::string_view, const T*> items;
  for (const T& item : list) items.emplace(item.name, &item);
  return items;
}

}  // namespace

void Builder::add_signal_laws() {
  if (scene.signals.empty()) return;
  const std::vector<std::optional<std::string>> units = scene::units_of_signals(scene);
  for (const std::size_t i : scene::order_of_signals(scene)) {
    const scene::Signal& s = scene.signals[i];
    law_of_signal[s.name] = add_law(s.law, "signal " + s.name);
    unit_of_signal[s.name] = units[i].value_or("");
    if (s.kind == scene::SignalKind::time) continue;
    plan.laws.back().law = {};  // a function's law is not one of time
    SignalPlan p;
    p.name = s.name;
    p.unit = unit_of_signal[s.name];
    p.rule = rule_of(s.kind);
    p.law = law_of_signal[s.name];
    p.start = s.start;
    p.function = s.law;
    p.formula = s.formula;
    p.surface = s.surface;
    plan.signals.push_back(std::move(p));
  }
}

/// What acts along a coordinate of a joint, or the part of it that is read: its springs and dampers are one.
EffortPlan Builder::read_effort(const scene::Joint& joint, const elements::Joint& made, motion::RowKind coordinate,
                                const std::string& of) {
  const scene::EffortParts parts = scene::effort_parts(of, joint).value();
  EffortPlan p;
  p.elastic.coordinate = coordinate;
  double moment = 0.0;
  for (int k = 0; k < made.num_efforts; ++k) {
    const elements::Effort& e = made.efforts[k];
    if (e.coordinate != coordinate || !parts.takes(joint.forces[static_cast<std::size_t>(k)])) continue;
    if (parts.spring) p.elastic.stiffness -= e.stiffness;
    if (parts.spring) moment -= e.stiffness * e.rest;
    if (parts.damper) p.elastic.damping -= e.damping;
    if (parts.effort && e.law >= 0) p.laws.push_back(e.law);
  }
  if (p.elastic.stiffness != 0.0) p.elastic.rest = moment / p.elastic.stiffness;
  for (int k = 0; k < made.num_rows && parts.drive; ++k) {
    const elements::ConstraintRow& row = made.rows[k];
    if (row.kind == coordinate && (row.law >= 0 || motion::traits_of(row.kind).is_between_points)) p.row = k;
  }
  return p;
}

void Builder::add_signals() {
  if (scene.signals.empty()) return;
  const auto given = by_name(scene.signals);
  const auto joints = by_name(scene.joints);
  const auto couplings = by_name(scene.couplings);
  const auto motions = by_name(scene.motions);
  for (SignalPlan& p : plan.signals) {
    const scene::Signal& s = *given.at(p.name);
    for (const std::string& input : s.inputs) p.inputs.push_back(law_of_signal.at(input));
    if (!p.reads_motion()) continue;
    elements::Effort& read = p.reading.efforts[0];
    p.reading.num_efforts = 1;
    if (s.kind == scene::SignalKind::joint_effort) {
      const scene::Joint* joint = joints.at(s.joint);
      if (scene::reads_reaction(s)) {
        p.joint_name = s.joint;
        p.reading.ports[0] = port_at(joint->first);
        p.reading.ports[1] = port_at(joint->second);
        p.row = scene::reaction_row(scene::type_of(joint->kind), s.coordinate)->row;
        plan.signals_read_multipliers = true;
        continue;
      }
      const auto index = static_cast<std::size_t>(joint - scene.joints.data());  // these come first in Plan::joints
      const elements::Joint& made =
          array_of<elements::Joint>(plan.elements)[static_cast<std::size_t>(plan.joints[index].element)];
      const EffortPlan effort =
          read_effort(*joint, made, scene::coordinate_of(s, scene::type_of(joint->kind))->kind, s.of);
      p.joint_name = joint->name;
      p.reading.ports[0] = made.ports[0];
      p.reading.ports[1] = made.ports[1];
      read = effort.elastic;
      p.inputs.insert(p.inputs.end(), effort.laws.begin(), effort.laws.end());
      p.row = effort.row;
      plan.signals_read_multipliers |= p.row >= 0;
      continue;
    }
    if (s.kind == scene::SignalKind::force) {
      const scene::PrescribedMotion* motion = motions.at(s.part);
      const scene::ForceRow row = scene::force_row(*motion, s.coordinate).value();
      p.joint_name = s.part;
      p.reading.ports[0] = port_at("ground", {Mat3<double>::identity(), poses.of(motion->at)->x});
      p.reading.ports[1] = port_at(motion->at);
      if (row.turns) read.coordinate = motion::RowKind::angle;
      p.row = row.row;
      plan.signals_read_multipliers = true;
      continue;
    }
    if (s.kind == scene::SignalKind::spring_tension) {
      const scene::Coupling* spring = couplings.at(s.spring);
      const scene::LineForce force = scene::line_force_of(*spring).value();
      p.reading.ports[0] = port_at(spring->first);
      p.reading.ports[1] = port_at(spring->second);
      read.coordinate = motion::RowKind::distance;
      read.stiffness = force.stiffness;
      read.rest = force.rest_length;
      read.damping = force.damping;
      continue;
    }
    (p.rule == SignalRule::rate ? read.damping : read.stiffness) = 1.0;
    read.coordinate = motion::RowKind::along;
    if (scene::reads_joint(s.kind)) {
      const scene::Joint* joint = joints.at(s.joint);
      p.joint_name = s.joint;
      p.reading.ports[0] = port_at(joint->first);
      p.reading.ports[1] = port_at(joint->second);
      read.coordinate = scene::coordinate_of(s, scene::type_of(joint->kind))->kind;
      continue;
    }
    // Displacement along axis 3 of a frame that has the axes of the one that sees the point, in another order.
    Mat3<double> axes = Mat3<double>::zero();
    for (int k = 0; k < 3; ++k) axes((s.axis + 1 + k) % 3, k) = 1.0;
    p.reading.ports[0] = port_at(s.frame, {axes, Vec3<double>::zero()});
    p.reading.ports[1] = port_at(s.at);
  }
  plan.signal_of_law.assign(plan.laws.size(), -1);
  for (std::size_t i = 0; i < plan.signals.size(); ++i)
    plan.signal_of_law[static_cast<std::size_t>(plan.signals[i].law)] = static_cast<int>(i);
  for (SignalPlan& p : plan.signals)
    for (const int law : p.inputs) {
      const int other = plan.signal_of_law[static_cast<std::size_t>(law)];
      const bool is_itself = law == p.law;
      if (other >= 0 && !is_itself && std::find(p.signals.begin(), p.signals.end(), other) == p.signals.end())
        p.signals.push_back(other);
    }
  part_signals();
}

namespace {

/// Marks the signals that elements read as laws.
std::vector<bool> read_by_elements(const Plan& plan) {
  std::vector<bool> reads(plan.laws.size(), false);
  for_each_array(plan.elements, [&](const auto& array) {
    for (const auto& e : array) {
      std::array<int, elements::max_rows + elements::max_efforts> laws;
      elements::LawLister lister{laws.data()};
      const elements::KindOf<elements::LawLister> kinds(lister);
      std::decay_t<decltype(e)>::visit_data(e, e, kinds);
      for (int k = 0; k < lister.count; ++k) reads[static_cast<std::size_t>(laws[static_cast<std::size_t>(k)])] = true;
    }
  });
  for (const TurnedLawPlan& l : plan.turned_laws) reads[static_cast<std::size_t>(l.factor)] = true;
  std::vector<bool> signals(plan.signals.size());
  for (std::size_t i = 0; i < signals.size(); ++i) signals[i] = reads[static_cast<std::size_t>(plan.signals[i].law)];
  return signals;
}

}  // namespace

void Builder::part_signals() {
  if (plan.signals.empty()) return;
  std::vector<bool> drives = read_by_elements(plan);
  // Step control keeps the errors of states within its tolerance, so that its steps follow from them.
  for (std::size_t i = 0; i < drives.size(); ++i)
    if (plan.signals[i].is_state() && scene.analysis.step_control) drives[i] = true;
  // Sensors of linearised equations see signals as they follow from inputs and motions.
  if (!scene.analysis.linear.inputs.empty()) drives.assign(drives.size(), true);
  std::vector<int> due;
  for (std::size_t i = 0; i < drives.size(); ++i)
    if (drives[i]) due.push_back(static_cast<int>(i));
  while (!due.empty()) {
    const SignalPlan& reader = plan.signals[static_cast<std::size_t>(due.back())];
    due.pop_back();
    for (const int read : reader.signals)
      if (!drives[static_cast<std::size_t>(read)]) {
        drives[static_cast<std::size_t>(read)] = true;
        due.push_back(read);
      }
  }
  std::vector<SignalPlan> parted;
  std::vector<int> place(drives.size());
  for (const bool driving : {true, false}) {
    for (std::size_t i = 0; i < drives.size(); ++i)
      if (drives[i] == driving) {
        place[i] = static_cast<int>(parted.size());
        parted.push_back(std::move(plan.signals[i]));
      }
    if (driving) plan.num_driving_signals = static_cast<int>(parted.size());
  }
  plan.signals = std::move(parted);
  for (SignalPlan& s : plan.signals)
    for (int& read : s.signals) read = place[static_cast<std::size_t>(read)];
  for (int& signal : plan.signal_of_law)
    if (signal >= 0) signal = place[static_cast<std::size_t>(signal)];
}

void Builder::list_signals_of_elements() {
  if (plan.signals.empty()) {
    plan.signal_of_law.clear();
    return;
  }
  plan.signal_of_law.resize(plan.laws.size(), -1);
  std::unordered_map<std::string_view, int> first_of,
      last_of;  // a prescribed motion has one that shifts and one that turns
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    first_of.emplace(plan.joints[j].name, static_cast<int>(j));
    last_of[plan.joints[j].name] = static_cast<int>(j);
  }
  for (SignalPlan& p : plan.signals) {
    const bool turns = motion::traits_of(p.reading.efforts[0].coordinate).has_angle;
    const auto& place_of = turns ? last_of : first_of;
    if (const auto place = place_of.find(p.joint_name); !p.joint_name.empty() && place != place_of.end())
      p.joint = place->second;
  }
  for (const elements::Joint& e : array_of<elements::Joint>(plan.elements))
    for (int k = 0; k < e.num_rows; ++k) plan.signals_drive |= e.rows[k].law >= 0 && is_signal(e.rows[k].law);
  plan.signals_of_element.resize(plan.directory.size());
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      std::array<int, elements::max_rows + elements::max_efforts> laws;
      elements::LawLister lister{laws.data()};
      const elements::KindOf<elements::LawLister> kinds(lister);
      std::decay_t<decltype(e)>::visit_data(e, e, kinds);
      std::vector<int>& read = plan.signals_of_element[id];
      for (int k = 0; k < lister.count; ++k) {
        const int s = plan.signal_of_law[static_cast<std::size_t>(laws[static_cast<std::size_t>(k)])];
        if (s >= 0 && std::find(read.begin(), read.end(), s) == read.end()) read.push_back(s);
      }
    });
  // A multiplier belongs to the element of its joint alone: that holds the entry in the row of a signal that reads it.
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.num_driving_signals); ++i) {
    SignalPlan& p = plan.signals[i];
    if (p.row < 0 || p.joint < 0) continue;
    const JointPlan& joint = plan.joints[static_cast<std::size_t>(p.joint)];
    const auto row = std::find(joint.rows.begin(), joint.rows.end(), p.row);
    if (row == joint.rows.end()) continue;
    p.row_in_block = static_cast<int>(row - joint.rows.begin());
    std::vector<int>& read = plan.signals_of_element[static_cast<std::size_t>(joint.element)];
    if (std::find(read.begin(), read.end(), static_cast<int>(i)) == read.end()) read.push_back(static_cast<int>(i));
  }
}

}  // namespace bough::plan
