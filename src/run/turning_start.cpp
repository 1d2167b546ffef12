#include "turning_start.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bough/laws/make_law.hpp"
#include "bough/scene/joint_kinds.hpp"
#include "bough/schedule/serial.hpp"

namespace bough::run {

namespace {

using motion::Frame;
using motion::Vec3;
using motion::Vec6;
using scene::PlaceVelocity;

constexpr double same = 1e-6;  ///< relative difference of velocities that are one rotation

bool is_fixed_place(const scene::Poses& poses, const std::string& place) {
  if (place.empty() || place == "ground") return true;
  const auto thing = poses.find(place);
  return thing && thing->kind == scene::ThingKind::frame && !poses.is_moving(place);
}

/// Rates that drives give to coordinates of joints to the ground at time 0, as velocities of their second sides.
void append_driven(const scene::Scene& scene, const scene::Poses& poses, std::vector<PlaceVelocity>& velocities) {
  for (const scene::Joint& j : scene.joints)
    for (const scene::JointDrive& d : j.drives) {
      const scene::JointCoordinate* coordinate = scene::type_of(j.kind).coordinate(d.coordinate);
      const auto H = poses.of(j.first);
      if (!is_fixed_place(poses, j.first.to) || coordinate == nullptr || coordinate->is_length() || !H) continue;
      const laws::LawValue law = d.law.at(0.0);
      const double rate = d.is_rate ? law.value : law.rate;
      if (d.signal.empty() && rate != 0.0)
        velocities.push_back({H->x, Vec3<double>::zero(), rate * (H->R * Vec3<double>::unit(2))});
    }
}

/// Whether a rotation is among the motions that a joint of the ground allows, a driven coordinate apart.
bool allows(const scene::Joint& j, const scene::Poses& poses, const scene::Spin& spin) {
  const bool first = is_fixed_place(poses, j.first.to), second = is_fixed_place(poses, j.second.to);
  if (first == second) return true;
  const auto H_a = poses.of(j.first), H_b = poses.of(j.second);
  if (!H_a || !H_b) return true;
  const PlaceVelocity v = spin.at(H_b->x);
  const Vec6<double> twist = (first ? 1.0 : -1.0) * lanes::join(lanes::transpose_times(H_b->R, v.linear),
                                                                lanes::transpose_times(H_b->R, v.angular));
  const double reach = length_of(Vec3<double>(H_b->x - spin.point));
  const auto& rows = scene::type_of(j.kind).rows;
  return std::all_of(rows.begin(), rows.end(), [&](const scene::JointRow& row) {
    const double rate = lanes::dot(scene::eval_row(row, j.pitch, motion::relative(*H_a, *H_b)).gradient, twist);
    return std::abs(rate) <= same * spin.rate * (motion::traits_of(row.kind).is_length ? reach : 1.0);
  });
}

/// Whether nothing but joints that allow the rotation connects the structure with the ground.
bool is_free_to_turn(const scene::Scene& scene, const scene::Poses& poses, const scene::Spin& spin) {
  const auto to_ground = [&](const auto& item) {
    return is_fixed_place(poses, item.first.to) != is_fixed_place(poses, item.second.to);
  };
  return scene.motions.empty() && std::none_of(scene.couplings.begin(), scene.couplings.end(), to_ground) &&
         std::all_of(scene.joints.begin(), scene.joints.end(),
                     [&](const scene::Joint& j) { return allows(j, poses, spin); });
}

/// Whether all nodes take part: each is given the rotation, or elements connect it with one that a moving frame or a
/// driven joint of the ground carries. What is neither may be at rest.
bool takes_all(const plan::Plan& plan, bool is_carried) {
  std::vector<std::size_t> set_of(plan.nodes.size() + 1);  // the last: what carries
  for (std::size_t n = 0; n < set_of.size(); ++n) set_of[n] = n;
  const auto find = [&set_of](std::size_t n) {
    while (set_of[n] != n) n = set_of[n] = set_of[set_of[n]];
    return n;
  };
  const auto join = [&](std::size_t a, std::size_t b) { set_of[find(a)] = find(b); };
  const std::size_t carrier = plan.nodes.size();
  for (const plan::GivenVelocity& given : plan.given_velocities) join(static_cast<std::size_t>(given.node), carrier);
  for (std::size_t id = 0; id < plan.directory.size() && is_carried; ++id)
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      using E = std::decay_t<decltype(e)>;
      std::size_t first = carrier;
      bool carries =
          std::any_of(std::begin(e.ports), std::end(e.ports), [](const elements::Port& p) { return p.carrier >= 0; });
      if constexpr (E::role == elements::Role::joint)
        carries = carries || std::any_of(e.rows, e.rows + e.num_rows, [](const auto& row) { return row.law >= 0; });
      for (const elements::Port& p : e.ports) {
        if (p.node == elements::ground) continue;
        if (first != carrier || carries) join(static_cast<std::size_t>(p.node), first);
        first = static_cast<std::size_t>(p.node);
      }
    });
  for (std::size_t n = 0; n < carrier; ++n)
    if (find(n) != find(carrier)) return false;
  return true;
}

/// A frame on the ground's axes at time 0, with the rotation:  R = exp(rate t axis),  x = point - R point.
scene::FrameDef turning_frame(const scene::Spin& spin, const std::string& name) {
  scene::FrameDef frame;
  frame.name = name;
  scene::MovingFrame moving;
  moving.name = name;
  const Vec3<double> along = lanes::dot(spin.axis, spin.point) * spin.axis, out = spin.point - along,
                     side = lanes::cross(spin.axis, out);
  for (int k = 0; k < 3; ++k)
    moving.position[k] = laws::make_sum(
        {laws::make_harmonic(-out[k], spin.rate, std::acos(0.0), out[k]), laws::make_harmonic(-side[k], spin.rate)});
  moving.turns.push_back({spin.axis, laws::make_scaled(spin.rate, laws::make_expression("t"))});
  frame.motion = std::move(moving);
  return frame;
}

/// Holds the angle of the first joint of the ground that lets the structure turn, unless one is driven: every angle is an
/// equilibrium, and the scene gives one.
void hold_azimuth(scene::Scene& seen, const scene::Poses& poses) {
  scene::Joint* axle = nullptr;
  std::string name;
  for (scene::Joint& j : seen.joints) {
    if (is_fixed_place(poses, j.first.to) == is_fixed_place(poses, j.second.to)) continue;
    if (!j.drives.empty()) return;
    for (const scene::JointCoordinate& c : scene::type_of(j.kind).coordinates)
      if (axle == nullptr && !c.is_length()) {
        axle = &j;
        name = c.name;
      }
  }
  if (axle == nullptr) return;
  const auto H_a = poses.of(axle->first), H_b = poses.of(axle->second);
  const scene::JointRow row{scene::type_of(axle->kind).coordinate(name)->kind};
  scene::JointDrive hold;
  hold.coordinate = name;
  hold.law = laws::make_constant(H_a && H_b ? scene::eval_row(row, 0.0, motion::relative(*H_a, *H_b)).value : 0.0);
  axle->drives.push_back(std::move(hold));
}

/// The scene as it is seen from the turning frame, at rest; decisions that `plan` has not taken are barred, so that the
/// nodes are the same.
scene::Scene seen_from_the_frame(const scene::Scene& scene, const plan::Plan& plan, const scene::Spin& spin) {
  scene::Scene seen = scene;
  const scene::Poses poses(scene);
  std::string name = "turning";
  while (poses.find(name)) name += "_";
  for (std::size_t i = 0; i < seen.frames.size(); ++i)
    if (seen.frames[i].motion) {
      seen.frames[i].placement.pose = poses.frames().pose(i).value_or(Frame<double>::identity());
      seen.frames[i].placement.frame.clear();
      seen.frames[i].motion.reset();
    }
  seen.frames.push_back(turning_frame(spin, name));
  seen.analysis.frame = name;
  for (scene::Joint& j : seen.joints)
    for (scene::JointDrive& d : j.drives)
      if (d.signal.empty()) d.law = laws::make_constant(d.is_rate ? 0.0 : d.law.at(0.0).value);
  hold_azimuth(seen, poses);
  seen.initial_velocities.clear();
  seen.sensors.clear();
  seen.expected.clear();
  seen.measures.clear();
  for (const char* decision : {"welded", "held"})
    if (!plan.took(decision)) seen.without.emplace_back(decision);
  return seen;
}

}  // namespace

std::optional<scene::Spin> spin_at_start(const scene::Scene& scene, const plan::Plan& plan) {
  if (!scene.analysis.frame.empty()) return std::nullopt;
  const scene::Poses poses(scene);
  auto velocities = scene::velocities_of_frames(scene, poses);
  if (!velocities) return std::nullopt;
  append_driven(scene, poses, *velocities);
  if (!takes_all(plan, !velocities->empty())) return std::nullopt;
  for (const plan::GivenVelocity& given : plan.given_velocities) {
    const plan::NodePlan& node = plan.nodes[static_cast<std::size_t>(given.node)];
    velocities->push_back(
        {node.pose.x, node.pose.R * lanes::linear_part(node.twist), node.pose.R * lanes::angular_part(node.twist)});
  }
  const auto spin = scene::spin_of(*velocities);
  return spin && is_free_to_turn(scene, poses, *spin) ? spin : std::nullopt;
}

step::EquilibriumReport find_turning_equilibrium(const scene::Scene& scene, const plan::Plan& plan,
                                                 const scene::Spin& spin, const step::StepOptions& options,
                                                 step::State& state) {
  const scene::Scene seen = seen_from_the_frame(scene, plan, spin);
  const plan::Plan other = plan::make_plan(seen);
  step::EquilibriumReport report;
  if (other.nodes.size() != plan.nodes.size()) {
    report.cause = "the structure turns as one, and its parts are not the same in the frame that turns with it";
    return report;
  }
  step::System system(other, seen.solver, schedule::make_serial_walker());
  step::State at_rest = step::make_initial_state(other);
  report = step::find_equilibrium(system, at_rest, options, scene.analysis.step_size);
  if (!report.found) return report;
  const std::vector<elements::NodeMotion> from = step::nodes_in_space(plan, state),
                                          to = step::nodes_in_space(other, at_rest);
  const auto pose_of = [](const elements::NodeMotion& n) { return Frame<double>{n.R, Vec3<double>(n.x.hi + n.x.lo)}; };
  for (std::size_t n = 0; n < from.size(); ++n) {
    const Frame<double> H = pose_of(to[n]);
    step::move_node(plan, state, n, motion::Se3::log(motion::relative(pose_of(from[n]), H)));
    const PlaceVelocity v = spin.at(H.x);
    step::set_velocity(plan, state, n,
                       lanes::join(lanes::transpose_times(H.R, v.linear), lanes::transpose_times(H.R, v.angular)));
  }
  return report;
}

}  // namespace bough::run
