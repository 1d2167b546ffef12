#include <algorithm>
#include <cmath>
#include <span>

#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;
using motion::Vec3;

/// A point mass has no rotational inertia, so it has displacements alone if no attached part depends on its rotation.
/// If all its attachment points lie on one line through it, only the spin about this line has no effect. In dynamics it
/// then gets the inertia m d^2 about this line, with the largest distance d, so that no unknown remains undetermined.
/// This does not change any motion: no moment acts about the line, and a spin that starts at zero in the inertial frame
/// stays zero (see stop_spins). In statics inertia would not hold the spin, and it would act as a load in a rotating
/// frame.
void Builder::find_points() {
  std::vector<bool> feels(plan.nodes.size(), false);  // a part acts on the node by more than forces at points
  std::vector<std::vector<Vec3<double>>> met(plan.nodes.size());  // attachment points apart from the node
  const auto mark = [&](const auto& e, bool turns) {
    for (const Port& p : e.ports) {
      if (p.node == elements::ground) continue;
      const auto node = static_cast<std::size_t>(p.node);
      if (turns) feels[node] = true;
      if (p.has_offset && lanes::dot(p.offset.x, p.offset.x) > 0.0) met[node].push_back(p.offset.x);
    }
  };
  for_each_array(plan.elements, [&](const auto& array) {
    using E = typename std::decay_t<decltype(array)>::value_type;
    for (const E& e : array) {
      if constexpr (E::role == elements::Role::body)
        continue;
      else if constexpr (E::acts_along_line)
        mark(e, false);
      else if constexpr (E::role == elements::Role::load && E::num_ports == 1)
        mark(e, e.follows || lanes::dot(e.wrench, e.wrench) !=
                                 lanes::dot(lanes::linear_part(e.wrench), lanes::linear_part(e.wrench)));
      else if constexpr (E::role == elements::Role::joint) {
        // A row along an axis of the first frame turns with the first body; three such rows form a point and do not.
        const bool turns = std::any_of(e.efforts, e.efforts + e.num_efforts, [](const elements::Effort& effort) {
          return !motion::traits_of(effort.coordinate).is_between_points;
        });
        mark(e, turns || !motion::joins_points(std::span(e.rows, static_cast<std::size_t>(e.num_rows))));
      } else
        mark(e, true);
    }
  });
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const int node = plan.bodies[b].frame.node;
    if (!scene.bodies[b].is_point_mass || feels[static_cast<std::size_t>(node)]) continue;
    if (!met[static_cast<std::size_t>(node)].empty()) {
      keep_from_spinning(b, met[static_cast<std::size_t>(node)]);
      continue;
    }
    plan.nodes[static_cast<std::size_t>(node)].is_point = true;
  }
}

void Builder::leave_out_rotations_of_points() {
  const auto is_point = [](const NodePlan& node) { return node.is_point; };
  const auto count = static_cast<std::size_t>(std::count_if(plan.nodes.begin(), plan.nodes.end(), is_point));
  const bool turns = plan.unknowns.motions == Motions::spatial || plan.unknowns.motions == Motions::planar;
  if (count > 0 && turns)
    for (const NodePlan& node : plan.nodes) plan.unknowns.is_point.push_back(is_point(node) ? 1 : 0);
  decide("no rotations of points",
         "a point mass has displacements alone. Taken where forces act at its origin only, so that nothing depends on "
         "its rotation",
         count > 0 && turns,
         count == 0 ? "there is no such point mass"
         : !turns   ? "nothing turns"
                    : std::to_string(count) + (count == 1 ? " point mass" : " point masses"));
}

void Builder::keep_from_spinning(std::size_t body, const std::vector<Vec3<double>>& met) {
  Vec3<double> line = met.front();
  for (const Vec3<double>& x : met)
    if (lanes::dot(x, x) > lanes::dot(line, line)) line = x;
  for (const Vec3<double>& x : met) {
    const Vec3<double> beside = lanes::cross(line, x);
    if (lanes::dot(beside, beside) > 1e-24 * lanes::dot(line, line) * lanes::dot(x, x))
      return;  // its attachment
               // points determine the
               // spin
  }
  if (!plan.is_dynamic) return;
  const int node = plan.bodies[body].frame.node;
  spinless.emplace_back(node, (1.0 / length_of(line)) * line);
  elements::RigidBody& e = array_of<elements::RigidBody>(plan.elements)[body];  // at this stage there is one for each
                                                                                // body of the scene
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) e.mass(3 + i, 3 + j) += e.mass(0, 0) * line[i] * line[j];
  plan.notes.push_back(
      "point mass '" + scene.bodies[body].name +
      "' is held at one line through it: nothing feels its spin about that line, which is none from start to end");
}

/// The spin of a point has no effect, except through the inertia that its node was given. The spin in the inertial
/// frame, from initial velocities and from the frame in which the analysis is described, is therefore removed.
void Builder::stop_spins() {
  for (const auto& [node, line] : spinless) {
    NodePlan& n = plan.nodes[static_cast<std::size_t>(node)];
    Vec3<double> turning = lanes::angular_part(n.twist);
    if (plan.observer >= 0)
      turning += lanes::transpose_times(n.pose.R, lanes::angular_part(start_motions.observer.twist));
    const double spin = lanes::dot(line, turning);
    for (int i = 0; i < 3; ++i) n.twist[3 + i] -= spin * line[i];
  }
}

void Builder::mark_points() {
  for (elements::RigidBody& e : array_of<elements::RigidBody>(plan.elements)) {
    e.is_point = true;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) e.is_point = e.is_point && e.mass(i, j) == (i == j && i < 3 ? e.mass(0, 0) : 0.0);
  }
}

}  // namespace bough::plan
