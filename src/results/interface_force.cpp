#include "bough/results/interface_force.hpp"

#include <algorithm>
#include <array>

#include "bough/elements/evaluate.hpp"
#include "bough/step/linear_solution.hpp"
#include "observe_parts.hpp"

namespace bough::results {

using elements::Field;
using elements::Port;
using motion::Frame;
using motion::Vec3;
using motion::Vec6;

namespace {

constexpr std::size_t most = 24 + elements::max_rows;  ///< unknowns of an element: of four nodes, or of a joint

/// Nodes of the interface, ascending.
std::vector<int> nodes_of(const step::System& system, const tree::Subdomain& subdomain) {
  const tree::Tree& tree = system.linear().tree();
  std::vector<int> nodes;
  for (const int block : tree.boundary_blocks(tree.fronts[static_cast<std::size_t>(subdomain.top())]))
    if (const int node = system.linear().owners().node(block); node >= 0) nodes.push_back(node);
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// Residual of an element in six components a node, with the first-order change of statics.
template <class E>
void eval_residual_at(const E& e, const Field& field, const double* multipliers, double turns, const step::State& state,
                      double* residual) {
  if (state.unsettled.empty()) {
    elements::evaluate(e, field, multipliers, turns, residual, nullptr);
    return;
  }
  std::array<double, most * most> K;
  elements::evaluate(e, field, multipliers, turns, residual, K.data());
  const auto lacking = [&](int node) { return state.unsettled[static_cast<std::size_t>(node)]; };
  elements::add_tangent_times(e, K.data(), 0, elements::num_unknowns(e), lacking, residual);
}

}  // namespace

tree::SubdomainId subdomain_at(const tree::Tree& tree, std::span<const int> path) {
  tree::SubdomainId s = tree.root();
  for (const int child : path) {
    const std::span<const tree::SubdomainId> children = tree.children(tree.subdomains[static_cast<std::size_t>(s)]);
    if (child < 0 || child >= static_cast<int>(children.size())) return tree::none;
    s = children[static_cast<std::size_t>(child)];
  }
  return s;
}

std::vector<InterfaceForce> eval_interface_forces(const step::System& system, const step::State& state,
                                                  const Field& field, tree::SubdomainId subdomain) {
  const plan::Plan& plan = system.plan();
  const tree::Tree& tree = system.linear().tree();
  const tree::Subdomain& sub = tree.subdomains[static_cast<std::size_t>(subdomain)];
  std::vector<InterfaceForce> forces;
  for (const int node : nodes_of(system, sub)) forces.push_back({.node = node});
  const auto place_of = [&forces](const Port& p) {
    const auto at = std::lower_bound(forces.begin(), forces.end(), p.node,
                                     [](const InterfaceForce& f, int node) { return f.node < node; });
    return p.node != elements::ground && at != forces.end() && at->node == p.node ? &*at : nullptr;
  };
  for (const int element : tree.elements(sub)) {
    const auto id = static_cast<std::size_t>(element);
    if (id >= plan.directory.size()) continue;  // the equation of a signal
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      if (std::none_of(std::begin(e.ports), std::end(e.ports), place_of)) return;
      const int joint = plan.joint_of_element[id];
      const double* multipliers =
          joint < 0 ? nullptr
                    : state.multipliers.data() + plan.joints[static_cast<std::size_t>(joint)].multiplier_begin;
      std::array<double, most> residual;
      eval_residual_at(e, field, multipliers, joint < 0 ? 0.0 : state.turns[static_cast<std::size_t>(joint)], state,
                       residual.data());
      const double* wrench = residual.data();
      for (const Port& port : e.ports) {
        if (port.node == elements::ground) continue;
        if (InterfaceForce* const to = place_of(port)) {
          const motion::Mat3<double>& R = field.nodes[port.node].R;
          to->wrench += lanes::join(Vec3<double>(R * Vec3<double>{{wrench[0], wrench[1], wrench[2]}}),
                                    Vec3<double>(R * Vec3<double>{{wrench[3], wrench[4], wrench[5]}}));
        }
        wrench += 6;
      }
    });
  }
  return forces;
}

Vec6<double> resultant_of(std::span<const InterfaceForce> forces, const Field& field) {
  const auto place_of = [&field](int node) {
    const auto& x = field.nodes[node].x;
    return Vec3<double>(x.hi + x.lo);
  };
  Vec3<double> middle = Vec3<double>::zero(), force = middle, moment = middle;
  for (const InterfaceForce& f : forces) middle += (1.0 / static_cast<double>(forces.size())) * place_of(f.node);
  for (const InterfaceForce& f : forces) {
    const Vec3<double> part = lanes::linear_part(f.wrench);
    force += part;
    moment += lanes::angular_part(f.wrench) + lanes::cross(Vec3<double>(place_of(f.node) - middle), part);
  }
  return lanes::join(force, moment);
}

namespace {

/// Wrench in the ground about a place, as minus the residual at one port of an element.
Vec6<double> wrench_on(const Port& port, const double* residual, const Field& field, const Vec3<double>& about) {
  const elements::NodeMotion& node = field.nodes[port.node];
  const Vec3<double> f = node.R * Vec3<double>{{-residual[0], -residual[1], -residual[2]}};
  const Vec3<double> m = node.R * Vec3<double>{{-residual[3], -residual[4], -residual[5]}};
  return lanes::join(f, Vec3<double>(m + lanes::cross(Vec3<double>(node.x.hi + node.x.lo - about), f)));
}

/// Adds the wrench of one element: of a load on all its nodes, of a connection on its second.
template <class E>
void add_force(const E& e, const double* residual, const Field& field, PartForce& force,
               std::optional<Vec3<double>>& about) {
  const auto pose_of = [&field](const Port& port) { return motion_of_port(port, field).pose; };
  constexpr bool is_load = E::role == elements::Role::load;
  const Port& place = is_load ? *std::begin(e.ports) : *std::prev(std::end(e.ports));
  const Frame<double> pose = pose_of(place);
  if (!about) {
    about = pose.x;
    force.axes = pose.R;
  }
  const double sign = is_load || place.node != elements::ground ? 1.0 : -1.0;
  const double* own = residual;
  for (const Port& port : e.ports) {
    if (port.node == elements::ground) continue;
    if (is_load || &port == &place || sign < 0.0) force.wrench += sign * wrench_on(port, own, field, *about);
    own += 6;
  }
}

}  // namespace

PartForce eval_part_force(const step::System& system, const step::State& state, const Field& field,
                          std::span<const int> part) {
  const plan::Plan& plan = system.plan();
  PartForce force;
  std::optional<Vec3<double>> about;
  for (const int element : part) {
    const auto id = static_cast<std::size_t>(element);
    const int joint = plan.joint_of_element[id];
    const double* multipliers =
        joint < 0 ? nullptr : state.multipliers.data() + plan.joints[static_cast<std::size_t>(joint)].multiplier_begin;
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      std::array<double, most> residual;
      eval_residual_at(e, field, multipliers, joint < 0 ? 0.0 : state.turns[static_cast<std::size_t>(joint)], state,
                       residual.data());
      add_force(e, residual.data(), field, force, about);
    });
  }
  return force;
}

namespace {

/// What is wrong with the place of a sensor at the interface of its sub-domain; empty: nothing is.
std::string no_place_at(const step::System& system, const plan::SensorPlan& s, tree::SubdomainId subdomain) {
  const tree::Tree& tree = system.linear().tree();
  if (s.sensor.at.to.empty() || subdomain == tree.root()) return "";
  const std::vector<int> nodes = nodes_of(system, tree.subdomains[static_cast<std::size_t>(subdomain)]);
  if (std::binary_search(nodes.begin(), nodes.end(), s.port.node)) return "";
  constexpr std::size_t most_named = 8;
  std::string names;
  for (std::size_t k = 0; k < std::min(nodes.size(), most_named); ++k)
    names += (k == 0 ? "'" : ", '") + system.plan().nodes[static_cast<std::size_t>(nodes[k])].name + "'";
  if (nodes.size() > most_named) names += " and " + std::to_string(nodes.size() - most_named) + " more";
  return "'" + s.sensor.at.to + "' is not at the interface of sub-domain " + s.sensor.subdomain +
         ", which has the node" + (nodes.size() == 1 ? " " : "s ") + names;
}

}  // namespace

std::optional<std::string> unknown_subdomain(const step::System& system) {
  const tree::Tree& tree = system.linear().tree();
  for (const plan::SensorPlan& s : system.plan().sensors) {
    if (s.subdomain.empty()) continue;
    if (const tree::SubdomainId found = subdomain_at(tree, s.subdomain); found != tree::none) {
      if (const std::string wrong = no_place_at(system, s, found); !wrong.empty())
        return "sensor '" + s.sensor.name + "': " + wrong;
      continue;
    }
    std::span<const int> known = s.subdomain;
    while (subdomain_at(tree, known) == tree::none) known = known.first(known.size() - 1);
    std::string path;
    for (const int child : known) path += (path.empty() ? "" : ".") + std::to_string(child);
    const auto children = tree.children(tree.subdomains[static_cast<std::size_t>(subdomain_at(tree, known))]).size();
    return "sensor '" + s.sensor.name + "': the tree of the solver has no sub-domain " + s.sensor.subdomain +
           ", since " + (path.empty() ? std::string("its root") : "sub-domain " + path) + " has " +
           (children == 0 ? "no children" : std::to_string(children) + " children, counted from 0") +
           ": name another, or set /solver/depth or /solver/leaf_size";
  }
  return std::nullopt;
}

}  // namespace bough::results
