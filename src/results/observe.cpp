#include "bough/results/observe.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "bough/results/balance.hpp"
#include "bough/scene/components.hpp"
#include "observe_parts.hpp"
#include "stand_in.hpp"

namespace bough::results {

using elements::Field;
using elements::Port;
using elements::PortMotion;
using motion::Frame;
using motion::Mat3;
using motion::Vec3;
using motion::Vec6;

namespace {

/// A material point of a beam: section pose, twist, acceleration, strain.
struct BeamPoint {
  Frame<double> pose;  ///< position in the inertial frame
  Vec6<double> v, a, strain;
};

using Series = lanes::Taylor<double, 1>;  ///< value and change to first order

/// Motion of a port and its first-order change with the node's increment eta (in the node's own axes) that is below the
/// round-off of its position (State::unsettled): R' = R ~w, x' = R v.
PortMotion<Series> with_unsettled(const PortMotion<double>& p, const Port& port, const step::State& state) {
  PortMotion<Series> r;
  r.H.R = lanes::cast<Series>(p.H.R);
  r.H.x = lanes::cast<Series>(p.H.x);
  r.v = r.a = Vec6<Series>::zero();
  if (port.node == elements::ground) return r;
  Vec6<double> eta = state.unsettled[static_cast<std::size_t>(port.node)];
  if (port.has_offset) eta = motion::inverse_adjoint_times(port.offset, eta);
  const Vec3<double> dx = p.H.R * lanes::linear_part(eta), w = lanes::angular_part(eta);
  for (int i = 0; i < 3; ++i) {
    r.H.x[i].c[1] = dx[i];
    for (int j = 0; j < 3; ++j) {
      const int k = (j + 1) % 3, l = (j + 2) % 3;
      r.H.R(i, j).c[1] = p.H.R(i, k) * w[l] - p.H.R(i, l) * w[k];
    }
  }
  return r;
}

/// Adds the residual of an element to `sum`. In statics it includes the first-order effect of that increment, f + K
/// eta; see step/settle.hpp.
template <class E>
void add_settled_residual(const E& e, const PortMotion<double>* p, const Field& f, const step::State& state,
                          double* sum) {
  constexpr int n = 6 * E::num_ports;
  double out[n];
  elements::eval_residual(e, p, f.around, out);
  for (int k = 0; k < n; ++k) sum[k] += out[k];
  if (state.unsettled.empty()) return;
  PortMotion<Series> moved[E::num_ports];
  for (int i = 0; i < E::num_ports; ++i) moved[i] = with_unsettled(p[i], e.ports[i], state);
  Series law(0.0);
  elements::Surroundings<Series> around{lanes::cast<Series>(f.around.gravity), &law, f.around.has_inertia};
  E own = e;
  if constexpr (E::role == elements::Role::load) {
    law = Series(f.around.laws[own.law]);
    own.law = 0;
  }
  Series change[n];
  elements::eval_residual(own, moved, around, change);
  for (int k = 0; k < n; ++k) sum[k] += change[k].c[1];
}

/// Wrenches of a beam element and its line loads on its first and last node, in section axes. The section resultants at
/// the two ends are (-first, last): they follow from nodal equilibrium, and are one order more accurate than those from
/// strains.
template <class E>
void eval_end_wrenches(const step::System& system, const E& e, const std::vector<int>& loads, const Field& f,
                       const step::State& state, Vec6<double>& first, Vec6<double>& last) {
  constexpr int N = E::num_ports;
  const motion::Vec3Pair anchor = elements::anchor_of(e, f.nodes);
  PortMotion<double> p[N];
  for (int i = 0; i < N; ++i) {
    p[i] = elements::eval_port(e.ports[i], f.nodes, anchor);
    if (f.observer != nullptr)
      elements::add_observer_motion(p[i], Vec3<double>(anchor.hi + anchor.lo), f.observer->twist,
                                    f.observer->twist_rate);
  }
  double out[6 * N] = {};
  add_settled_residual(e, p, f, state, out);
  for (int id : loads)
    plan::with_element(system.plan().elements, system.plan().directory[static_cast<std::size_t>(id)],
                       [&](const auto& load) {
                         using L = std::decay_t<decltype(load)>;
                         if constexpr (L::role == elements::Role::load && L::num_ports == N)
                           add_settled_residual(load, p, f, state, out);
                       });
  for (int k = 0; k < 6; ++k) {
    first[k] = -out[k];
    last[k] = out[6 * (N - 1) + k];
  }
}

template <class E>
BeamPoint eval_point(const E& e, const Field& f, double s) {
  constexpr int N = E::num_ports;
  const motion::Vec3Pair anchor = elements::anchor_of(e, f.nodes);
  PortMotion<double> p[N];
  for (int i = 0; i < N; ++i) p[i] = elements::eval_port(e.ports[i], f.nodes, anchor);
  const auto b = elements::eval_shape<double, N>(p);
  double shape[N], slope[N];
  elements::eval_interpolation<N>(s, shape, slope);
  Vec6<double> rate[N], rate2[N];
  const PortMotion<double>& r = p[elements::Beam<N>::reference];
  elements::eval_shape_rates<double, N>(b, p, rate);
  elements::eval_shape_accelerations<double, N>(b, p, rate, rate2);
  const auto m = elements::eval_section<double, N>(shape, b, rate, rate2, r);
  BeamPoint point;
  point.pose = motion::compose(r.H, m.relative);
  point.pose.x = point.pose.x + anchor.hi + anchor.lo;
  point.v = m.v;
  point.a = m.a;
  const Vec6<double> d1 = elements::blend<double, N>(slope, b.d);
  point.strain = (1.0 / e.length) * motion::tangent_times(m.d, d1);
  // Stress-free strain: constant over an element made of one helicoid.
  point.strain -= e.reference_strain[0];
  return point;
}

template <class F>
void with_beam_element(const plan::Plan& plan, int id, F&& f) {
  plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(id)], [&](const auto& e) {
    if constexpr (std::decay_t<decltype(e)>::role == elements::Role::beam) f(e);
  });
}

/// The point of a beam that a sensor names.
BeamPoint eval_station(const step::System& system, const Field& f, const plan::SensorPlan& s) {
  const plan::BeamPlan& beam = system.plan().beams[static_cast<std::size_t>(s.beam)];
  const auto [k, local] = locate(beam, s.sensor.station);
  BeamPoint point;
  with_beam_element(system.plan(), beam.elements[static_cast<std::size_t>(k)],
                    [&, at = local](const auto& e) { point = eval_point(e, f, at); });
  return point;
}

/// Second-order term of the sectional force over an element, 1/2 d2f/ds2, from its strains at the strain points.
/// Elements of four nodes have three such points and therefore this term; those of fewer nodes do not. (Strains at
/// other points are less accurate.)
template <class E>
Vec6<double> eval_force_curvature(const E& e, const Field& f, const step::State& state) {
  constexpr int N = E::num_ports, P = E::num_strain_points;
  if constexpr (P < 3) {
    return Vec6<double>::zero();
  } else {
    const motion::Vec3Pair anchor = elements::anchor_of(e, f.nodes);
    PortMotion<double> p[N];
    for (int i = 0; i < N; ++i) p[i] = elements::eval_port(e.ports[i], f.nodes, anchor);
    const auto shape = elements::eval_shape<double, N>(p);
    elements::BeamShape<Series, N> moved_shape;
    if (!state.unsettled.empty()) {
      PortMotion<Series> moved[N];
      for (int i = 0; i < N; ++i) moved[i] = with_unsettled(p[i], e.ports[i], state);
      moved_shape = elements::eval_shape<Series, N>(moved);
    }
    Vec6<double> force[P];
    double at[P];
    for (int g = 0; g < P; ++g) {
      at[g] = 0.0;
      for (int i = 0; i < N; ++i) at[g] += elements::strain_rule<N>().shape[g][i] * i / (N - 1);
      Vec6<double> strain = elements::eval_strain<double, N>(shape, e.length, g);
      strain -= e.reference_strain[g];
      if (!state.unsettled.empty()) {
        const Vec6<Series> change = elements::eval_strain<Series, N>(moved_shape, e.length, g);
        for (int k = 0; k < 6; ++k) strain[k] += change[k].c[1];
      }
      force[g] = e.stiffness * strain;
    }
    const Vec6<double> first = (1.0 / (at[1] - at[0])) * (force[1] - force[0]),
                       second = (1.0 / (at[2] - at[1])) * (force[2] - force[1]);
    return (1.0 / (at[2] - at[0])) * (second - first);
  }
}

/// Sectional force of an element at s in [0, 1]: nodal equilibrium at the ends, and between them a straight line or the
/// parabola that the strains give.
struct ElementForce {
  Vec6<double> first, last, curvature;
  template <class E>
  ElementForce(const step::System& system, const E& e, const std::vector<int>& loads, const Field& f,
               const step::State& state)
      : curvature(eval_force_curvature(e, f, state)) {
    eval_end_wrenches(system, e, loads, f, state, first, last);
  }
  Vec6<double> at(double s) const { return (1.0 - s) * first + s * last + (s * (s - 1.0)) * curvature; }
};

}  // namespace

PointMotion motion_at(const step::System& system, const step::State& state, const plan::SensorPlan& s) {
  const Field f = system.instant().field(state);
  if (s.beam < 0) return motion_of_port(s.port, f);
  const BeamPoint p = eval_station(system, f, s);
  return {p.pose, p.v, p.a};
}

Vec6<double> section_strain_at(const step::System& system, const step::State& state, const plan::SensorPlan& s) {
  return eval_station(system, system.instant().field(state), s).strain;
}

Vec6<double> section_force_at(const step::System& system, const step::State& state, const plan::SensorPlan& s) {
  const plan::BeamPlan& beam = system.plan().beams[static_cast<std::size_t>(s.beam)];
  const auto [k, local] = locate(beam, s.sensor.station);
  const auto element = static_cast<std::size_t>(k);
  Vec6<double> force;
  with_beam_element(system.plan(), beam.elements[element], [&, at = local](const auto& e) {
    force = ElementForce(system, e, beam.loads[element], system.instant().field(state), state).at(at);
  });
  return force;
}

namespace {

void copy(const Vec3<double>& from, double* to) { std::copy_n(from.v, 3, to); }
void copy(const Mat3<double>& from, double* to) { std::copy_n(from.m, 9, to); }

records::CurvePoint make_curve_point(const BeamPoint& p, const Vec6<double>& force) {
  records::CurvePoint point{};
  copy(p.pose.x, point.position);
  copy(p.pose.R, point.axes);
  copy(p.pose.R * lanes::linear_part(p.v), point.velocity);
  std::copy_n(force.v, 6, point.force);
  std::copy_n(p.strain.v, 6, point.strain);
  return point;
}

int intervals_of(const plan::Plan& plan) {
  std::size_t num_elements = 0;
  for (const plan::BeamPlan& beam : plan.beams) num_elements += beam.elements.size();
  return num_elements > 4000 ? 1 : num_elements > 1000 ? 2 : 4;
}

records::Curve make_curve(const plan::BeamPlan& beam, const step::System& system, const Field& f,
                          const step::State& state, int parts) {
  records::Curve curve;
  curve.name = beam.name;
  for (std::size_t k = 0; k < beam.elements.size(); ++k)
    with_beam_element(system.plan(), beam.elements[k], [&](const auto& e) {
      const ElementForce along(system, e, beam.loads[k], f, state);
      for (int i = k == 0 ? 0 : 1; i <= parts; ++i) {
        const double s = static_cast<double>(i) / parts;
        curve.points.push_back(make_curve_point(eval_point(e, f, s), along.at(s)));
      }
    });
  return curve;
}

records::BodyPose make_body_pose(const plan::BodyPlan& body, const Field& f) {
  const PointMotion p = motion_of_port(body.frame, f);
  records::BodyPose pose{};
  pose.name = body.name;
  copy(p.pose.x, pose.position);
  copy(p.pose.R, pose.axes);
  copy(motion::transform(p.pose, body.center), pose.center);
  copy(p.pose.R * (lanes::linear_part(p.v) + lanes::cross(lanes::angular_part(p.v), body.center)), pose.velocity);
  for (const Port& port : body.attachments) {
    const Vec3<double> x = position_of(f, port);
    pose.attachments.push_back({x[0], x[1], x[2]});
  }
  return pose;
}

/// Calls visit(name, first port, second port) for joints, springs, bushings and prescribed motions, in the order of
/// MotionFrame::links.
template <class Visit>
void for_each_link(const plan::Plan& plan, const Visit& visit) {
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      using E = std::decay_t<decltype(e)>;
      if constexpr (elements::joins_two_frames(E::role)) visit(plan.element_owner[id], e.ports[0], e.ports[1]);
    });
  for (const plan::WeldPlan& weld : plan.welds) visit(weld.name, weld.first, weld.second);
}

/// Force and moment of a load's element at a port, in the axes of the ground.
template <class E>
records::Arrow arrow_at(const E& e, int port, const std::string& name, const Field& f) {
  records::Arrow arrow{name, {}, {}, {}, E::num_ports > 1};
  copy(position_of(f, e.ports[port]), arrow.position);
  Vec6<double> w = f.around.laws[e.law] * e.wrench;
  if (e.follows) w = turned(motion_of_port(e.ports[port], f).pose.R, w);
  std::copy_n(w.v, 3, arrow.force);
  std::copy_n(w.v + 3, 3, arrow.moment);
  return arrow;
}

/// Point loads. Several elements of one load at one place (components in rotating axes) become one arrow. Of line
/// loads, an arrow at each node of their elements; a node shared by consecutive elements gets one.
void add_arrows(const plan::Plan& plan, const Field& f, std::vector<records::Arrow>& arrows) {
  int last_node = elements::ground;
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      using E = std::decay_t<decltype(e)>;
      if constexpr (E::role == elements::Role::load) {
        for (int port = 0; port < E::num_ports; ++port) {
          const records::Arrow arrow = arrow_at(e, port, plan.element_owner[id], f);
          const int node = e.ports[port].node;
          const bool follows_own = !arrows.empty() && arrows.back().name == arrow.name;
          if (!follows_own || (E::num_ports > 1 && (node == elements::ground || node != last_node)))
            arrows.push_back(arrow);
          else if (E::num_ports == 1)
            for (int i = 0; i < 3; ++i) {
              arrows.back().force[i] += arrow.force[i];
              arrows.back().moment[i] += arrow.moment[i];
            }
          last_node = node;
        }
      }
    });
}

}  // namespace

records::MotionFrame eval_motion(const step::System& system, const step::State& state) {
  const plan::Plan& plan = system.plan();
  const Field f = system.instant().field(state);
  records::MotionFrame frame;
  frame.time = state.time;
  const int parts = intervals_of(plan);
  for (const plan::BeamPlan& beam : plan.beams) frame.curves.push_back(make_curve(beam, system, f, state, parts));
  for (const plan::BodyPlan& body : plan.bodies) frame.bodies.push_back(make_body_pose(body, f));
  for_each_link(plan, [&](const std::string& name, const Port& first, const Port& second) {
    records::Link link{};
    link.name = name;
    copy(position_of(f, first), link.first);
    copy(position_of(f, second), link.second);
    copy(motion_of_port(first, f).pose.R, link.axes);
    frame.links.push_back(link);
  });
  for (std::size_t k = 0; k < plan.frames.size(); ++k) {
    const Frame<double>& pose = f.carriers[k].pose;
    records::FramePose& moving = frame.frames.emplace_back();
    moving.name = plan.frames[k].name;
    copy(pose.x, moving.position);
    copy(pose.R, moving.axes);
  }
  add_arrows(plan, f, frame.arrows);
  for (std::size_t i = 0; i < plan.signals.size(); ++i)
    frame.signals.push_back({plan.signals[i].name, state.signals.value[i]});
  return frame;
}

namespace {

/// Places at which a body is held, from its centre of mass, in its own axes.
std::vector<Vec3<double>> arms_of(const plan::BodyPlan& body) {
  std::vector<Vec3<double>> arms;
  const Port& own = body.frame;
  for (const Port& port : body.attachments)
    if (port.node == own.node && port.node != elements::ground)
      arms.push_back(lanes::transpose(own.offset.R) * (port.offset.x - own.offset.x) - body.center);
  return arms;
}

}  // namespace

records::MotionParts make_parts(const scene::Scene& scene, const step::System& system) {
  records::MotionParts parts;
  std::map<std::string, int> outline_of, body_of;
  const int sides = intervals_of(system.plan()) < 4 ? 8 : 24;  // sides of round sections; fewer where there are many
                                                               // elements
  for (const scene::Section& s : scene.sections) {
    outline_of[s.name] = static_cast<int>(parts.outlines.size());
    parts.outlines.push_back(scene::outline_of(s.shape ? *s.shape : scene::equivalent_rectangle(s.stiffness), sides));
  }
  std::map<std::string, int> section_of;
  for (const scene::Beam& b : scene.beams) section_of[b.name] = outline_of.at(b.section);
  const plan::Plan& plan = system.plan();
  const std::vector<tree::SubdomainId>& leaves = system.linear().tree().leaf_of_element;
  for (const plan::BeamPlan& beam : plan.beams) {
    records::MotionParts::Curve curve;
    curve.outline = section_of.at(beam.name);
    for (const int e : beam.elements) curve.subdomains.push_back(leaves[static_cast<std::size_t>(e)]);
    parts.curves.push_back(std::move(curve));
  }
  // Copies of one part have equal surfaces, which are stored once.
  std::map<std::pair<std::vector<std::array<double, 3>>, std::vector<std::array<int, 3>>>, int> known;
  std::map<std::string, std::vector<Vec3<double>>> arms;
  for (const plan::BodyPlan& body : plan.bodies) arms[body.name] = arms_of(body);
  for (const scene::Body& b : scene.bodies) {
    int& surface = body_of.emplace(b.name, -1).first->second;
    std::optional<scene::Mesh> mesh = b.looks   ? *b.looks
                                      : b.shape ? scene::mesh_of(*b.shape)
                                                : stand_in(b, arms[b.name]);
    if (!mesh) continue;
    const auto [place, is_new] =
        known.emplace(std::pair(mesh->points, mesh->triangles), static_cast<int>(parts.meshes.size()));
    surface = place->second;
    if (is_new) parts.meshes.push_back(std::move(*mesh));
  }
  for (const plan::BodyPlan& body : plan.bodies) parts.bodies.push_back(body_of.at(body.name));
  for (const plan::SignalPlan& signal : plan.signals) parts.signal_units.push_back(signal.unit);
  std::map<std::string, std::string> kind_of;
  for (const scene::Joint& j : scene.joints) kind_of[j.name] = scene::to_string(j.kind);
  for (const scene::Spring& s : scene.springs)
    kind_of[s.name] = !(s.damping > 0.0) ? "spring" : !(s.stiffness > 0.0) ? "damper" : "spring and damper";
  for (const scene::Bushing& b : scene.bushings) kind_of[b.name] = "bushing";
  for_each_link(plan, [&](const std::string& name, const Port&, const Port&) {
    const auto found = kind_of.find(name);
    parts.links.push_back({found != kind_of.end() ? found->second : "prescribed motion"});
  });
  return parts;
}

}  // namespace bough::results
