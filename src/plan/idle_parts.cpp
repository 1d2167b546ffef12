/// Finds parts of a scene that are never moved or cannot move, and notes them, since they cost as much as others.
#include <algorithm>
#include <cmath>

#include "bough/plan/sets.hpp"
#include "listed.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

namespace {

bool is_zero(const motion::Vec6<double>& v) { return lanes::dot(v, v) == 0.0; }

/// Whether six rows connect two frames rigidly, none of them driven.
bool is_rigid(const elements::Joint& e) {
  int held = 0;
  for (int k = 0; k < e.num_rows; ++k) held += e.rows[k].law < 0 && e.rows[k].kind != elements::RowKind::screw ? 1 : 0;
  return held == 6;
}

}  // namespace

/// What a signal reads and what it drives interact, also through signals that are made of it.
void Builder::join_by_signals(Sets& parts) const {
  if (plan.signals.empty()) return;
  Sets made(plan.signals.size());
  for (std::size_t i = 0; i < plan.signals.size(); ++i)
    for (const int other : plan.signals[i].signals) made.join(i, static_cast<std::size_t>(other));
  std::vector<std::size_t> first(plan.signals.size(), parts.ground());
  const auto touch = [&](std::size_t signal, const elements::Port& p) {
    if (p.node == elements::ground) return;
    std::size_t& known = first[made.of(signal)];
    const auto node = static_cast<std::size_t>(p.node);
    if (known != parts.ground()) parts.join(node, known);
    known = node;
  };
  for (std::size_t i = 0; i < plan.signals.size(); ++i)
    if (plan.signals[i].reads_motion())
      for (const elements::Port& p : plan.signals[i].reading.ports) touch(i, p);
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      for (const int s : signals_of(plan, id))
        for (const elements::Port& p : e.ports) touch(static_cast<std::size_t>(s), p);
    });
}

void Builder::say_idle_parts() {
  const std::size_t count = plan.nodes.size();
  Sets parts(count), rigid(count);
  join_by_signals(parts);
  std::vector<bool> is_moved(count + 1, false);  // moved by a load, a spring under tension, a drive, its weight, or an
                                                 // initial velocity
  const bool has_gravity = lanes::dot(plan.gravity, plan.gravity) > 0.0;
  for_each_array(plan.elements, [&](const auto& array) {
    using E = typename std::decay_t<decltype(array)>::value_type;
    for (const E& e : array) {
      std::size_t first = parts.ground();
      bool moves = false;
      if constexpr (elements::has_mass_matrix<E>) moves = has_gravity;
      if constexpr (E::role == elements::Role::load) moves = !is_zero(e.wrench);
      // A coupling may push, which its data do not tell, unless it is without strain at the start.
      if constexpr (elements::IsCatalogued<E>) moves = E::start == scene::CouplingStart::apart;
      if constexpr (E::acts_along_line) {
        const motion::Vec3<double> r = initial_pose(e.ports[1]).x - initial_pose(e.ports[0]).x;
        moves = std::abs(length_of(r) - e.rest_length) > 1e-12 * plan.length_scale;
      }
      if constexpr (E::role == elements::Role::joint) {
        for (int k = 0; k < e.num_rows; ++k) moves |= e.rows[k].law >= 0;
        for (int k = 0; k < e.num_efforts; ++k) moves |= e.efforts[k].stiffness != 0.0 || e.efforts[k].law >= 0;
        if (is_rigid(e) && e.ports[0].carrier < 0 && e.ports[1].carrier < 0)
          rigid.join(rigid.index(e.ports[0]), rigid.index(e.ports[1]));
      }
      for (const elements::Port& p : e.ports) {
        if (p.carrier >= 0) moves = true;
        if (p.node == elements::ground) continue;
        const auto node = static_cast<std::size_t>(p.node);
        if (first != parts.ground()) parts.join(node, first);
        first = node;
        is_moved[node] = is_moved[node] || moves;
      }
    }
  });
  for (std::size_t n = 0; n < count; ++n)
    if (!is_zero(plan.nodes[n].twist) || plan.observer >= 0) is_moved[n] = true;
  std::map<std::size_t, std::vector<std::size_t>> members;
  for (std::size_t n = 0; n < count; ++n) members[parts.of(n)].push_back(n);
  std::map<std::size_t, std::vector<std::string>> welded_to;  // by rigid part, names of the parts that were welded to
                                                              // it
  for (const auto& [name, offset] : part_offset)
    if (name.find('.') == std::string::npos)  // sections of beams are no parts
      welded_to[parts.of(static_cast<std::size_t>(node_of.at(name)))].push_back(name);
  for (const auto& [part, nodes] : members)
    if (std::none_of(nodes.begin(), nodes.end(), [&](std::size_t n) { return is_moved[n]; })) {
      std::vector<std::string> names;
      for (std::size_t n : nodes) names.push_back(plan.nodes[n].name);
      const std::vector<std::string>& others = welded_to[part];
      names.insert(names.end(), others.begin(), others.end());
      plan.notes.push_back(
          listed(names) + (names.size() == 1 ? ": nothing moves it" : ": nothing moves them") +
          " (no load, weight, drive, tension or initial velocity): left out of the scene, the rest would "
          "be the same");
    }
  std::vector<std::string> held;
  for (const BodyPlan& body : plan.bodies)  // bodies only: a clamped node of a beam is its normal support
    if (rigid.of(static_cast<std::size_t>(body.frame.node)) == rigid.of(rigid.ground())) held.push_back(body.name);
  if (members.size() > 1)
    plan.notes.push_back("the scene falls into " + std::to_string(members.size()) +
                         " parts that do not feel each other");
  if (!held.empty())
    plan.notes.push_back(listed(held) + (held.size() == 1 ? " cannot move: it is" : " cannot move: they are") +
                         " fixed to the ground; beams and joints may take hold of the ground itself");
}

}  // namespace bough::plan
