#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <span>

#include "bough/plan/sets.hpp"
#include "listed.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;
using elements::RowKind;
using motion::Vec3;

namespace {

/// Whether a joint acts on its second body by forces at the origin of its second frame alone: along axes of the first,
/// or along the line between the origins.
bool acts_at_second_origin(const elements::Joint& e) {
  const auto is_force = [](RowKind kind) {
    return kind == RowKind::along || motion::traits_of(kind).is_between_points;
  };
  return std::all_of(e.rows, e.rows + e.num_rows, [&](const auto& row) { return is_force(row.kind); }) &&
         std::all_of(e.efforts, e.efforts + e.num_efforts, [&](const auto& f) { return is_force(f.coordinate); });
}

}  // namespace

/// A point mass has no rotational inertia, so it has displacements alone if no attached part depends on its rotation.
/// If all its attachment points lie on one line through it, only the spin about this line has no effect. In dynamics it
/// then gets the inertia m d^2 about this line, with the largest distance d, so that no unknown remains undetermined.
/// This does not change any motion: no moment acts about the line, and a spin that starts at zero in the inertial frame
/// stays zero (see stop_spins). In statics inertia would not hold the spin, and it would act as a load in a rotating
/// frame.
void Builder::find_points() {
  std::vector<bool> feels(plan.nodes.size(), false);  // a part acts on the node by more than forces at points
  std::vector<std::vector<Vec3<double>>> met(plan.nodes.size());  // attachment points apart from the node
  const auto mark_port = [&](const Port& p, bool turns) {
    if (p.node == elements::ground) return;
    const auto node = static_cast<std::size_t>(p.node);
    if (turns) feels[node] = true;
    if (p.has_offset && lanes::dot(p.offset.x, p.offset.x) > 0.0) met[node].push_back(p.offset.x);
  };
  const auto mark = [&](const auto& e, bool turns) {
    for (const Port& p : e.ports) mark_port(p, turns);
  };
  for_each_array(plan.elements, [&](const auto& array) {
    using E = typename std::decay_t<decltype(array)>::value_type;
    for (const E& e : array) {
      if constexpr (E::role == elements::Role::body)
        continue;
      else if constexpr (E::role == elements::Role::load && E::num_ports == 1)
        mark(e, e.follows || lanes::dot(e.wrench, e.wrench) !=
                                 lanes::dot(lanes::linear_part(e.wrench), lanes::linear_part(e.wrench)));
      else if constexpr (E::role == elements::Role::joint) {
        // A row along an axis of the first frame turns with the first body; three such rows form a point and do not.
        const bool turns = std::any_of(e.efforts, e.efforts + e.num_efforts, [](const elements::Effort& effort) {
          return !motion::traits_of(effort.coordinate).is_between_points;
        });
        mark_port(e.ports[0], turns || !motion::joins_points(std::span(e.rows, static_cast<std::size_t>(e.num_rows))));
        mark_port(e.ports[1], !acts_at_second_origin(e));
      } else if constexpr (elements::IsCatalogued<E>) {
        mark_port(e.ports[0], !E::acts_along_line);
        mark_port(e.ports[1], !E::pulls_at_point);
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
  if (held_at_lines.size() == 1)
    plan.notes.push_back(
        "point mass " + listed(held_at_lines) +
        " is held at one line through it: nothing feels its spin about that line, which is none from start to end");
  if (held_at_lines.size() > 1)
    plan.notes.push_back("point masses " + listed(held_at_lines) +
                         " are each held at one line through them: nothing feels their spins about these lines, which "
                         "are none from start to end");
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
  held_at_lines.push_back(scene.bodies[body].name);
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

namespace {

/// The least rotation w with which points x of one rigid part have the velocities v, as nearly as they can:
///   sum_i (|r|^2 - r r^T) w = sum_i r x v,   r = x - their mean,  v less its mean.
Vec3<double> rotation_of(const std::vector<Vec3<double>>& x, const std::vector<Vec3<double>>& v) {
  Vec3<double> x_mean = Vec3<double>::zero(), v_mean = x_mean;
  for (std::size_t i = 0; i < x.size(); ++i) {
    x_mean += (1.0 / static_cast<double>(x.size())) * x[i];
    v_mean += (1.0 / static_cast<double>(x.size())) * v[i];
  }
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3<double> r = x[i] - x_mean, moment = lanes::cross(r, Vec3<double>(v[i] - v_mean));
    for (int k = 0; k < 3; ++k) {
      b[k] += moment[k];
      for (int j = 0; j < 3; ++j) A(k, j) += (k == j ? lanes::dot(r, r) : 0.0) - r[k] * r[j];
    }
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix3d> decomposition;
  decomposition.setThreshold(1e-10);
  const Eigen::Vector3d w = decomposition.compute(A).solve(b);
  return {{w[0], w[1], w[2]}};
}

}  // namespace

/// Rotations of points that no initial velocity gives: those of the rigid parts that fixed joints make of them. They are
/// given with another member of the part, or follow from the velocities of its points. All other joints let the
/// projection of initial velocities find them, in which a point resists no rotation.
void Builder::turn_points_with_their_parts() {
  std::vector<char> has_beam(plan.nodes.size(), 0);
  for (const BeamPlan& beam : plan.beams)
    for (const int node : beam.nodes) has_beam[static_cast<std::size_t>(node)] = 1;
  std::unordered_map<std::string_view, bool> is_point;
  for (const scene::Body& body : scene.bodies) is_point[body.name] = body.is_point_mass;
  std::vector<std::size_t> turning, given;  // nodes
  for (const scene::InitialVelocity& v : scene.initial_velocities) {
    const auto node = node_of.find(v.of);
    if (node == node_of.end()) continue;
    const auto id = static_cast<std::size_t>(node->second);
    const auto body = is_point.find(v.of);
    const bool turns = !v.has_angular_velocity && has_beam[id] == 0 && (body == is_point.end() || body->second);
    (turns ? turning : given).push_back(id);
  }
  if (turning.empty()) return;
  Sets rigid(plan.nodes.size());
  for (const scene::Joint& joint : scene.joints)
    if (joint.kind == scene::JointKind::fixed)
      rigid.join(rigid.index(port_at(joint.first)), rigid.index(port_at(joint.second)));
  const auto in_ground = [this](std::size_t n, const Vec3<double>& part) { return plan.nodes[n].pose.R * part; };
  for (const std::size_t n : turning) {
    Vec3<double> w = Vec3<double>::zero();
    const auto same = [&](std::size_t other) { return rigid.of(other) == rigid.of(n); };
    if (const auto known = std::find_if(given.begin(), given.end(), same); known != given.end()) {
      w = in_ground(*known, lanes::angular_part(plan.nodes[*known].twist));
    } else if (rigid.of(n) != rigid.of(rigid.ground())) {
      std::vector<Vec3<double>> x, v;
      for (const std::size_t other : turning)
        if (same(other)) {
          x.push_back(plan.nodes[other].pose.x);
          v.push_back(in_ground(other, lanes::linear_part(plan.nodes[other].twist)));
        }
      w = rotation_of(x, v);
    }
    plan.nodes[n].twist =
        lanes::join(lanes::linear_part(plan.nodes[n].twist), lanes::transpose_times(plan.nodes[n].pose.R, w));
  }
}

namespace {

/// Whether rotations that a scene has are without inertia about the mass centre of a section: about the normal of its
/// plane, or about any axis. mass: of the section, per length; normal: in the axes of the section.
bool lacks_inertia(const motion::Mat6<double>& mass, bool is_planar, const Vec3<double>& normal) {
  constexpr double least = 1e-14;  // of the largest inertia: round-off
  Eigen::Matrix3d J;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      J(i, j) = mass(3 + i, 3 + j);
      for (int k = 0; k < 3 && mass(0, 0) > 0.0; ++k) J(i, j) -= mass(3 + i, k) * mass(k, 3 + j) / mass(0, 0);
    }
  const Eigen::Vector3d n(normal[0], normal[1], normal[2]);
  const double inertia = is_planar ? n.dot(J * n) : Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(J).eigenvalues()[0];
  return inertia <= least * J.trace();
}

}  // namespace

/// In dynamics, where a node of such a beam has no body with inertia.
void Builder::find_massless_rotations() {
  const bool is_planar = plan.unknowns.motions == Motions::planar;
  if (!plan.is_dynamic || !(is_planar || plan.unknowns.motions == Motions::spatial)) return;
  const Vec3<double> normal = lanes::column(plan.axes, 2);
  std::vector<bool> has_inertia(plan.nodes.size(), false);
  for (const elements::RigidBody& e : array_of<elements::RigidBody>(plan.elements))
    if (e.ports[0].node != elements::ground &&
        !lacks_inertia(e.mass, is_planar, lanes::transpose_times(initial_pose(e.ports[0]).R, normal)))
      has_inertia[static_cast<std::size_t>(e.ports[0].node)] = true;
  const auto is_light = [&](const Port& p) {
    return p.node != elements::ground && !has_inertia[static_cast<std::size_t>(p.node)];
  };
  for_each_array(plan.elements, [&](const auto& array) {
    using E = typename std::decay_t<decltype(array)>::value_type;
    if constexpr (E::role == elements::Role::beam)
      for (const E& e : array)
        plan.has_massless_rotations =
            plan.has_massless_rotations ||
            (std::any_of(std::begin(e.ports), std::end(e.ports), is_light) &&
             lacks_inertia(e.mass, is_planar, lanes::transpose_times(initial_pose(e.ports[0]).R, normal)));
  });
}

void Builder::mark_points() {
  for (elements::RigidBody& e : array_of<elements::RigidBody>(plan.elements)) {
    e.is_point = true;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) e.is_point = e.is_point && e.mass(i, j) == (i == j && i < 3 ? e.mass(0, 0) : 0.0);
  }
}

}  // namespace bough::plan
