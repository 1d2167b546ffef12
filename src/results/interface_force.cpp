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

Vec6<double> eval_interface_force(const step::System& system, const step::State& state, const Field& field,
                                  tree::SubdomainId subdomain) {
  const plan::Plan& plan = system.plan();
  const tree::Tree& tree = system.linear().tree();
  const tree::Subdomain& sub = tree.subdomains[static_cast<std::size_t>(subdomain)];
  const std::vector<int> interface = nodes_of(system, sub);
  const auto is_in_interface = [&](const Port& p) {
    return p.node != elements::ground && std::binary_search(interface.begin(), interface.end(), p.node);
  };
  const auto place_of = [&](int node) {
    const auto& x = field.nodes[node].x;
    return Vec3<double>(x.hi + x.lo);
  };
  Vec3<double> middle = Vec3<double>::zero();
  for (const int node : interface) middle += (1.0 / static_cast<double>(interface.size())) * place_of(node);
  Vec3<double> force = Vec3<double>::zero(), moment = force;
  for (const int element : tree.elements(sub)) {
    const auto id = static_cast<std::size_t>(element);
    if (id >= plan.directory.size()) continue;  // the equation of a signal
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      if (std::none_of(std::begin(e.ports), std::end(e.ports), is_in_interface)) return;
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
        if (is_in_interface(port)) {
          const motion::Mat3<double>& R = field.nodes[port.node].R;
          const Vec3<double> f = R * Vec3<double>{{wrench[0], wrench[1], wrench[2]}};
          force += f;
          moment += R * Vec3<double>{{wrench[3], wrench[4], wrench[5]}} +
                    lanes::cross(Vec3<double>(place_of(port.node) - middle), f);
        }
        wrench += 6;
      }
    });
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

std::optional<std::string> unknown_subdomain(const step::System& system) {
  const tree::Tree& tree = system.linear().tree();
  for (const plan::SensorPlan& s : system.plan().sensors) {
    if (s.subdomain.empty() || subdomain_at(tree, s.subdomain) != tree::none) continue;
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
