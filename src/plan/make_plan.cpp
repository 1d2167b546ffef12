#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "bough/elements/rows.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/motion/norm.hpp"
#include "bough/plan/plan.hpp"
#include "bough/plan/stores.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "bough/scene/components.hpp"
#include "bough/scene/part_lengths.hpp"
#include "bough/scene/poses.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;
using motion::Frame;
using motion::Mat3;
using motion::Mat6;
using motion::Vec3;
using motion::Vec6;

Builder::Builder(const scene::Scene& s) : scene(s), poses(s) {
  plan.scene_name = s.name;
  plan.is_dynamic = scene::type_of(s.analysis.kind).is_in_time;
}

int Builder::add_law(const laws::Law& law, const std::string& user) {
  plan.laws.push_back({law, user});
  return static_cast<int>(plan.laws.size()) - 1;
}

/// The factor of a load without a law: 1 from the start in dynamics, the load factor in statics.
int Builder::add_factor(const laws::Law& law, const std::string& user) {
  if (law.node() != nullptr) return add_law(law, user);
  if (plan.is_dynamic) return add_law(laws::make_constant(1.0), user);
  // On a path followed by arc length, the load factor may be negative or above 1, and structures buckle at any.
  const bool ends_at_one = !scene.analysis.arc_length && scene.analysis.kind != scene::AnalysisKind::buckling;
  return add_law(ends_at_one ? laws::make_ramp(0.0, 1.0, 0.0, 1.0) : laws::make_expression("t"), user);
}

int Builder::add_factor(const laws::Law& law, const std::string& signal, const std::string& user) {
  return signal.empty() ? add_factor(law, user) : law_of_signal.at(signal);
}

int Builder::add_node(const std::string& name, const Frame<double>& pose) {
  plan.nodes.push_back({name, pose, Vec6<double>::zero()});
  const int id = static_cast<int>(plan.nodes.size()) - 1;
  node_of[name] = id;
  return id;
}

void Builder::add_bodies() {
  std::size_t inner = 0;
  for (const scene::Beam& b : scene.beams) inner += static_cast<std::size_t>(b.elements * b.order - 1);
  plan.nodes.reserve(scene.nodes.size() + scene.bodies.size() + inner);
  node_of.reserve(plan.nodes.capacity());
  array_of<elements::RigidBody>(plan.elements).reserve(scene.bodies.size());
  for (const scene::Node& n : scene.nodes) add_node(n.name, poses.of(n.placement).value_or(n.placement.pose));
  for (const scene::Body& b : scene.bodies) {
    const int id = add_node(b.name, poses.of(b.placement).value_or(b.placement.pose));
    elements::RigidBody body;
    body.ports[0].node = id;
    body.mass = elements::make_mass_matrix(b.mass, b.center_of_mass, b.inertia);
    add(body, b.name);
    plan.bodies.push_back({b.name, body.ports[0], b.center_of_mass, {}});
  }
}

namespace {

elements::ConstraintRow& add_row(elements::Joint& j, elements::RowKind kind, int i, int k = 0, int law = -1) {
  elements::ConstraintRow& row = j.rows[j.num_rows++];
  row.kind = kind;
  row.i = i;
  row.j = k;
  row.law = law;
  return row;
}

}  // namespace

int Builder::add_joint(elements::Joint& j, const std::string& name, const std::string& what) {
  JointPlan p;
  p.name = name;
  p.what = what;
  p.element = add(j, name);
  p.multiplier_begin = plan.num_multipliers;
  for (int k = 0; k < j.num_rows; ++k) p.rows.push_back(k);
  plan.num_multipliers += j.num_rows;
  plan.joints.push_back(p);
  return static_cast<int>(plan.joints.size()) - 1;
}

/// A drive that prescribes a rate gets the integral of its law from the coordinate's initial value.
int Builder::add_drive(const laws::Law& law, const std::string& signal, bool is_rate, double initial,
                       const std::string& user) {
  if (!signal.empty()) return law_of_signal.at(signal);
  if (!is_rate) return add_law(law, user);
  return add_law(laws::make_sum({law.integral(0.0), laws::make_constant(initial)}), user);
}

void Builder::add_joints() {
  array_of<elements::Joint>(plan.elements).reserve(scene.joints.size());
  plan.joints.reserve(scene.joints.size());
  for (const scene::Joint& given : scene.joints) {
    elements::Joint j;
    j.ports[0] = port_at(given.first);
    j.ports[1] = port_at(given.second);
    const scene::JointType& type = scene::type_of(given.kind);
    const Frame<double> H = motion::relative(initial_pose(j.ports[0]), initial_pose(j.ports[1]));
    for (const scene::JointRow& row : type.rows)
      add_row(j, row.kind, row.axes.i, row.axes.j).constant = motion::traits_of(row.kind).is_between_points
                                                                  ? scene::eval_row(row, 0.0, H).value
                                                                  : scene::pitch_per_radian(given.pitch);
    for (const scene::JointDrive& d : given.drives) {
      const scene::JointRow coordinate{type.coordinate(d.coordinate)->kind};
      const int law = add_drive(d.law, d.signal, d.is_rate, scene::eval_row(coordinate, 0.0, H).value, given.name);
      const auto end = j.rows + type.rows.size();
      const auto held = std::find_if(j.rows, end, [&](const auto& row) { return row.kind == coordinate.kind; });
      if (held != end && motion::traits_of(held->kind).is_between_points) {
        held->constant = 0.0;
        held->law = law;
      } else {
        add_row(j, coordinate.kind, 2, 0, law);
      }
    }
    for (const scene::JointForce& f : given.forces) {
      elements::Effort& e = j.efforts[j.num_efforts++];
      e.coordinate = type.coordinate(f.coordinate)->kind;
      e.stiffness = f.stiffness;
      e.rest = f.rest;
      e.damping = f.damping;
      if (!f.signal.empty())
        e.law = law_of_signal.at(f.signal);
      else if (f.effort.node() != nullptr)
        e.law = add_law(f.effort, given.name);
    }
    add_joint(j, given.name, "joint");
  }
}

void Builder::add_motions() {
  for (const scene::PrescribedMotion& m : scene.motions) {
    const Port moving = port_at(m.at);
    const Frame<double> start = initial_pose(moving);
    elements::Joint shift;  // the ground's axes at the initial place
    shift.ports[0] = port_at("ground", {Mat3<double>::identity(), start.x});
    shift.ports[1] = moving;
    for (int i = 0; i < 3; ++i)
      if (m.displacement[i])
        add_row(shift, elements::RowKind::along, i, 0,
                add_drive(*m.displacement[i], m.displacement_signal[i], m.is_rate, 0.0, m.name));
    if (shift.num_rows > 0) add_joint(shift, m.name, "prescribed motion");
    if (!m.rotation_axis && !m.hold_rotation) continue;
    elements::Joint turn;  // both frames along the axis of rotation, equal at the start
    const Mat3<double> axes =
        m.rotation_axis ? scene::axes_from(3, *m.rotation_axis, scene::default_axis_2(*m.rotation_axis)).value()
                        : Mat3<double>::identity();
    turn.ports[0] = port_at("ground", {axes, start.x});
    turn.ports[1] = moving;
    turn.ports[1].offset = motion::compose(turn.ports[1].has_offset ? moving.offset : Frame<double>::identity(),
                                           {lanes::transpose(start.R) * axes, Vec3<double>::zero()});
    turn.ports[1].has_offset = true;
    if (m.rotation_axis) {
      for (int i = 0; i < 2; ++i) add_row(turn, elements::RowKind::across, i, 2);
      add_row(turn, elements::RowKind::angle, 2, 0, add_drive(m.angle, m.angle_signal, m.is_rate, 0.0, m.name));
    } else {
      for (int i = 0; i < 3; ++i) add_row(turn, elements::RowKind::across, i, (i + 1) % 3);
    }
    add_joint(turn, m.name, "prescribed motion");
  }
}

/// Makes two frames of a coupling equal at the start: the second gets the axes of the first, and the first the place of
/// the second if frames are to be equal as a whole. Their relative motion is then that of the second's origin and of its
/// rotation as seen from the first, in the first's axes, wherever the second's axes are drawn and however far the origins
/// are apart.
void Builder::align_at_start(scene::CouplingStart start, Port& first, Port& second) const {
  if (start == scene::CouplingStart::apart) return;
  constexpr double round_off = 1e-14;
  const Frame<double> at_second = initial_pose(second), apart = motion::relative(initial_pose(first), at_second);
  const auto place = [](Port& port, const Frame<double>& within) {
    port.offset = motion::compose(port.offset, within);
    port.has_offset = true;
  };
  if (start == scene::CouplingStart::frame && motion::norm(apart.x) > round_off * motion::norm(at_second.x))
    place(first, {Mat3<double>::identity(), apart.x});
  const Vec3<double> turn = motion::log_so3(apart.R);
  if (motion::norm(turn) > round_off) place(second, {lanes::transpose(apart.R), Vec3<double>::zero()});
}

void Builder::add_couplings() {
  for (const scene::Coupling& c : scene.couplings) {
    std::vector<int> laws;
    for (const scene::Factor& f : c.factors) laws.push_back(f.is_given() ? add_factor(f.law, f.signal, c.name) : -1);
    elements::for_each_catalogued([&]<class E>() {
      if (c.kind != &elements::kind_of<E>) return;
      E e;
      e.ports[0] = port_at(c.first);
      e.ports[1] = port_at(c.second);
      align_at_start(E::start, e.ports[0], e.ports[1]);
      const Frame<double> first = initial_pose(e.ports[0]);
      elements::take_data(e, c.values.data(), first.R, laws.data());
      take_start(e, motion::relative(first, initial_pose(e.ports[1])));
      add(e, c.name);
    });
  }
  for (const scene::PointLoad& l : scene.point_loads) {
    elements::PointLoad e;
    e.ports[0] = port_at(l.at);
    for (const SpaceLoad& part : space_loads(l.force, l.moment, l.frame, l.axes == scene::LoadAxes::body,
                                             add_factor(l.law, l.signal, l.name), l.name)) {
      e.wrench = part.wrench;
      e.follows = part.follows;
      e.law = part.law;
      add(e, l.name);
    }
  }
}

void Builder::add_initial_velocities() {
  for (const scene::InitialVelocity& v : scene.initial_velocities) {
    const auto thing = poses.find(v.of);
    const bool is_beam = thing && thing->kind == scene::ThingKind::beam;
    const std::vector<int> targets = is_beam ? plan.beams[thing->index].nodes : std::vector<int>{node_of.at(v.of)};
    const Frame<double> origin = plan.nodes[static_cast<std::size_t>(targets.front())].pose;
    Vec3<double> linear = v.velocity, angular = v.angular_velocity;
    if (v.axes == scene::LoadAxes::body) {
      linear = origin.R * linear;
      angular = origin.R * angular;
    } else if (!v.frame.empty() && v.frame != "ground") {
      linear = frame_start.at(v.frame).R * linear;
      angular = frame_start.at(v.frame).R * angular;
    }
    if (!v.frame.empty()) {
      const Vec6<double> carried = frame_velocity(v.frame, origin.x);
      linear += lanes::linear_part(carried);
      angular += lanes::angular_part(carried);
    }
    for (int id : targets) {
      NodePlan& n = plan.nodes[static_cast<std::size_t>(id)];
      const Vec3<double> at = linear + lanes::cross(angular, Vec3<double>(n.pose.x - origin.x));
      n.twist = lanes::join(lanes::transpose_times(n.pose.R, at), lanes::transpose_times(n.pose.R, angular));
    }
  }
}

/// The nodes keep their numbers from here on.
void Builder::list_given_velocities() {
  if (scene.initial_velocities.empty()) return;
  std::unordered_map<std::string_view, const BeamPlan*> beam_of;
  for (const BeamPlan& beam : plan.beams) beam_of.emplace(beam.name, &beam);
  for (const scene::InitialVelocity& v : scene.initial_velocities) {
    if (const auto beam = beam_of.find(v.of); beam != beam_of.end()) {
      for (int node : beam->second->nodes) plan.given_velocities.push_back({v.of, node});
      continue;
    }
    plan.given_velocities.push_back({v.of, node_of.at(v.of)});
    plan.given_velocities.back().has_angular = v.has_angular_velocity;
    if (const auto offset = part_offset.find(v.of); offset != part_offset.end())
      plan.given_velocities.back().offset = offset->second;
  }
}

void Builder::number_elements() {
  int first = 0;
  std::array<int, std::tuple_size_v<ElementArrays>> first_of{};
  for_each_array(plan.elements, [&](const auto& array) {
    using E = typename std::decay_t<decltype(array)>::value_type;
    constexpr std::size_t place = index_of<E>;
    first_of[place] = first;
    for (std::size_t i = 0; i < array.size(); ++i) {
      plan.directory.push_back({static_cast<std::uint8_t>(place), static_cast<std::int32_t>(i)});
      plan.element_owner.push_back(owners<E>()[i]);
    }
    first += static_cast<int>(array.size());
  });
  for (JointPlan& j : plan.joints) j.element += first_of[index_of<elements::Joint>];
  for (BeamPlan& b : plan.beams)
    with_nodes_of_order(b.order, [&]<int N>() {
      for (int& e : b.elements) e += first_of[index_of<elements::Beam<N>>];
      for (auto& list : b.loads)
        for (int& e : list) e += first_of[index_of<elements::LineLoad<N>>];
    });
}

/// In the order in which pictures show them: joints and couplings, then the ends of beams.
void Builder::list_attachments() {
  std::vector<int> body_at(plan.nodes.size(), -1);
  for (std::size_t b = 0; b < plan.bodies.size(); ++b)
    body_at[static_cast<std::size_t>(plan.bodies[b].frame.node)] = static_cast<int>(b);
  const auto attach = [&](const Port& port) {
    const int body = port.node == elements::ground ? -1 : body_at[static_cast<std::size_t>(port.node)];
    if (body >= 0) plan.bodies[static_cast<std::size_t>(body)].attachments.push_back(port);
  };
  for_each_array(plan.elements, [&](const auto& array) {
    using E = typename std::decay_t<decltype(array)>::value_type;
    if constexpr (elements::joins_two_frames(E::role))
      for (const E& e : array)
        for (const Port& p : e.ports) attach(p);
  });
  for (const BeamPlan& beam : plan.beams) {
    if (beam.elements.empty()) continue;
    for_each_array(plan.elements, [&](const auto& array) {
      using E = typename std::decay_t<decltype(array)>::value_type;
      if constexpr (E::role == elements::Role::beam)
        if (E::num_ports == beam.order + 1) {
          attach(*std::begin(array[static_cast<std::size_t>(beam.elements.front())].ports));
          attach(*std::prev(std::end(array[static_cast<std::size_t>(beam.elements.back())].ports)));
        }
    });
  }
}

/// Diagonal of the box around all nodes and attachment points [m], or the radius of gyration of the largest body if
/// that is larger; 1 if both are zero.
/// Largest distance of a joint from the centre of all joints, twice: a moment counts as a force at this arm where the
/// reactions of dependent joints have to be shared out. It depends neither on where the frames of bodies are drawn nor
/// on the axes of the ground.
double Builder::extent_of_joints() const {
  const std::vector<elements::Joint>& joints = array_of<elements::Joint>(plan.elements);
  Vec3<double> sum = Vec3<double>::zero();
  for (const elements::Joint& e : joints) sum += initial_pose(e.ports[0]).x;
  double most = 0.0;
  for (const elements::Joint& e : joints)
    most = std::max(
        most, length_of(Vec3<double>(initial_pose(e.ports[0]).x - (1.0 / static_cast<double>(joints.size())) * sum)));
  return most > 0.0 ? 2.0 * most : plan.length_scale;
}

double Builder::size_of_structure() const {
  Vec3<double> low = Vec3<double>::zero(), high = low;
  bool is_first = true;
  const auto add_point = [&](const Vec3<double>& x) {
    for (int k = 0; k < 3; ++k) {
      low[k] = is_first ? x[k] : std::min(low[k], x[k]);
      high[k] = is_first ? x[k] : std::max(high[k], x[k]);
    }
    is_first = false;
  };
  for (const NodePlan& node : plan.nodes) add_point(node.pose.x);
  for_each_array(plan.elements, [&](const auto& array) {
    for (const auto& e : array)
      for (const Port& p : e.ports) add_point(initial_pose(p).x);
  });
  const Vec3<double> size = high - low;
  double most = length_of(size);
  for (const scene::Body& b : scene.bodies)
    if (b.mass > 0.0)
      most = std::max(most, std::sqrt(0.5 * (b.inertia(0, 0) + b.inertia(1, 1) + b.inertia(2, 2)) / b.mass));
  return most > 0.0 ? most : 1.0;
}

void Builder::measure_joints() {
  if (plan.joints.empty()) return;
  const scene::PartLengths lengths(scene, poses);
  std::map<std::string, double> of_motion;
  for (const scene::PrescribedMotion& m : scene.motions)
    of_motion[m.name] = lengths.of_joint({}, m.at, plan.length_scale);
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {  // those of the scene come first, one for one
    if (j < scene.joints.size())
      plan.joints[j].length = lengths.of_joint(scene.joints[j].first, scene.joints[j].second, plan.length_scale);
    else
      plan.joints[j].length = of_motion.at(plan.joints[j].name);
  }
}

void Builder::make_graph() {
  blocks::BlockGraph& g = plan.graph;
  plan.joint_of_element.assign(plan.directory.size(), -1);
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    plan.joint_of_element[static_cast<std::size_t>(plan.joints[j].element)] = static_cast<int>(j);
  plan.block_of_node.assign(plan.nodes.size(), 0);
  std::vector<char> holds(plan.joints.size(), 0);
  for (const HeldNode& h : plan.held) {
    plan.block_of_node[static_cast<std::size_t>(h.node)] = -1;
    for (int j : h.joints) holds[static_cast<std::size_t>(j)] = 1;
  }
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    if (plan.block_of_node[n] < 0) continue;
    plan.block_of_node[n] = g.num_blocks();
    g.block_size.push_back(plan.unknowns.count_of(n));
  }
  const std::span<SignalPlan> driving =
      std::span(plan.signals).first(static_cast<std::size_t>(plan.num_driving_signals));
  for (SignalPlan& s : driving) {
    s.block = g.num_blocks();
    g.block_size.push_back(1);
  }
  g.block_kind.assign(g.block_size.size(), blocks::BlockKind::motion);
  const double arm = extent_of_joints();
  for (std::size_t id = 0; id < plan.directory.size(); ++id) {
    with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      for (const Port& p : e.ports)
        if (p.node != elements::ground && plan.block_of_node[static_cast<std::size_t>(p.node)] >= 0)
          g.element_blocks.push_back(plan.block_of_node[static_cast<std::size_t>(p.node)]);
    });
    const int j = plan.joint_of_element[id];
    if (j >= 0 && holds[static_cast<std::size_t>(j)] == 0 && !plan.joints[static_cast<std::size_t>(j)].rows.empty()) {
      JointPlan& joint = plan.joints[static_cast<std::size_t>(j)];
      joint.block = g.num_blocks();
      g.element_blocks.push_back(g.num_blocks());
      g.block_size.push_back(static_cast<int>(joint.rows.size()));
      g.block_kind.push_back(blocks::BlockKind::multiplier);
      for (const int row : joint.rows)
        g.multiplier_measure.push_back(elements::is_length(joint_of(plan, joint).rows[row].kind) ? 1.0 : 1.0 / arm);
    }
    for (const int s : signals_of(plan, id))
      g.element_blocks.push_back(plan.signals[static_cast<std::size_t>(s)].block);
    g.element_begin.push_back(static_cast<std::int64_t>(g.element_blocks.size()));
  }
  for (SignalPlan& s : driving) {
    s.element = g.num_elements();
    for (const Port& p : s.reading.ports) {
      const bool moves = p.node != elements::ground && plan.block_of_node[static_cast<std::size_t>(p.node)] >= 0;
      if (s.reads_nodes() && moves && std::find(s.nodes.begin(), s.nodes.end(), p.node) == s.nodes.end())
        s.nodes.push_back(p.node);
    }
    for (const int node : s.nodes) g.element_blocks.push_back(plan.block_of_node[static_cast<std::size_t>(node)]);
    for (const int other : s.signals) g.element_blocks.push_back(plan.signals[static_cast<std::size_t>(other)].block);
    g.element_blocks.push_back(s.block);
    g.element_begin.push_back(static_cast<std::int64_t>(g.element_blocks.size()));
  }
}

Plan make_plan(const scene::Scene& scene) {
  Builder b(scene);
  b.plan.gravity = scene.gravity;
  b.plan.gravity_law = b.add_factor(scene.gravity_law, "gravity");
  b.add_signal_laws();
  b.add_frames();
  b.add_bodies();
  b.add_beams();
  b.add_joints();
  b.add_motions();
  b.add_couplings();
  b.add_signals();
  b.find_points();
  b.add_initial_velocities();
  b.turn_points_with_their_parts();
  b.stop_spins();
  b.plan.length_scale = b.size_of_structure();
  b.measure_joints();
  b.list_attachments();
  b.weld_nodes();
  b.list_given_velocities();
  b.mark_points();
  b.number_elements();
  b.choose_unknowns();
  b.leave_out_rotations_of_points();
  b.find_massless_rotations();
  b.hold_nodes();
  b.settle();
  b.list_signals_of_elements();
  if (!scene::type_of(scene.analysis.kind).wants_all_motions) b.say_idle_parts();
  b.find_mobility();
  b.make_graph();
  b.add_sensors();
  b.list_turning_joints();
  b.plan.energy_stores = energy_stores(b.plan);
  return std::move(b.plan);
}

}  // namespace bough::plan
