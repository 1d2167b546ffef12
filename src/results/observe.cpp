#include "bough/results/observe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "bough/results/balance.hpp"
#include "bough/scene/components.hpp"
#include "bough/scene/couplings.hpp"
#include "bough/scene/sensor_kinds.hpp"
#include "observe_parts.hpp"
#include "section_force.hpp"
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

/// Strains of the stress-free section under a sectional force: C^-1 f, by Cholesky's factors, in units in which the
/// diagonal is 1.
Vec6<double> strain_of(const motion::Mat6<double>& stiffness, const Vec6<double>& force) {
  double unit[6];
  motion::Mat6<double> L = stiffness;
  Vec6<double> x = force;
  for (int i = 0; i < 6; ++i) unit[i] = 1.0 / std::sqrt(stiffness(i, i));
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = unit[i] * stiffness(i, j) * unit[j];
      for (int k = 0; k < j; ++k) sum -= L(i, k) * L(j, k);
      L(i, j) = i == j ? std::sqrt(sum) : sum / L(j, j);
    }
    x[i] *= unit[i];
    for (int k = 0; k < i; ++k) x[i] -= L(i, k) * x[k];
    x[i] /= L(i, i);
  }
  for (int i = 5; i >= 0; --i) {
    for (int k = i + 1; k < 6; ++k) x[i] -= L(k, i) * x[k];
    x[i] /= L(i, i);
  }
  for (int i = 0; i < 6; ++i) x[i] *= unit[i];
  return x;
}

/// The largest value of sign * f along a beam.
class ExtremeSearch {
 public:
  explicit ExtremeSearch(double sign) : sign_(sign) {}

  /// f: the function along element k, s from 0 to 1, smooth between its nodes.
  template <class F>
  void see_element(const F& f, int nodes, std::size_t k) {
    constexpr int intervals = 8;
    constexpr double beside = 1e-9;  // where loads act on a node, forces differ before and behind it
    for (int i = 1; i < nodes; ++i) {
      const double from = static_cast<double>(i - 1) / (nodes - 1), to = static_cast<double>(i) / (nodes - 1);
      double s[intervals + 1], v[intervals + 1];
      for (int j = 0; j <= intervals; ++j) {
        s[j] = from + (to - from) * j / intervals + (j == 0 && i > 1 ? beside : 0.0);
        v[j] = sign_ * f(s[j]);
        see(v[j], s[j], k);
      }
      for (int j = 1; j < intervals; ++j) {
        if (v[j] < v[j - 1] || v[j] < v[j + 1]) continue;
        const double bend = v[j - 1] - 2.0 * v[j] + v[j + 1];
        if (!(bend < 0.0)) continue;
        const double at = s[j] + 0.5 * (s[j + 1] - s[j]) * (v[j - 1] - v[j + 1]) / bend;
        see(sign_ * f(at), at, k);
      }
    }
  }
  double value() const { return value_; }
  double place() const { return place_; }  ///< in elements from the start of the beam

 private:
  void see(double v, double s, std::size_t k) {
    if (!(v > value_)) return;
    value_ = v;
    place_ = static_cast<double>(k) + s;
  }
  double sign_, value_ = -std::numeric_limits<double>::infinity(), place_ = 0.0;
};

/// The point of a beam that a sensor names.
BeamPoint eval_station(const step::System& system, const Field& f, const plan::SensorPlan& s) {
  const plan::BeamPlan& beam = system.plan().beams[static_cast<std::size_t>(s.beam)];
  const auto [k, local] = locate(beam, s.sensor.station);
  BeamPoint point;
  with_beam_element(system.plan(), beam.elements[static_cast<std::size_t>(k)],
                    [&, at = local](const auto& e) { point = eval_point(e, f, at); });
  return point;
}

}  // namespace

PointMotion motion_at(const step::System& system, const step::State& state, const plan::SensorPlan& s) {
  const Field f = system.instant().field(state);
  if (s.beam < 0) return motion_of_port(s.port, f);
  const BeamPoint p = eval_station(system, f, s);
  return {p.pose, p.v, p.a};
}

Vec6<double> section_force_at(const step::System& system, const step::State& state, const plan::SensorPlan& s) {
  const plan::BeamPlan& beam = system.plan().beams[static_cast<std::size_t>(s.beam)];
  const auto [k, local] = locate(beam, s.sensor.station);
  const auto element = static_cast<std::size_t>(k);
  Vec6<double> force;
  with_beam_element(system.plan(), beam.elements[element], [&, at = local](const auto& e) {
    const Field f = system.instant().field(state);
    force = ElementForce(system, e, beam.loads[element], f, state).at(at);
  });
  return force;
}

SectionExtremes section_extremes(const step::System& system, const step::State& state, const plan::SensorPlan& s) {
  const plan::BeamPlan& beam = system.plan().beams[static_cast<std::size_t>(s.beam)];
  const std::vector<std::string> names = scene::components_of(scene::SensorKind::section_force);
  const auto component = static_cast<int>(std::find(names.begin(), names.end(), s.sensor.component) - names.begin());
  const Field f = system.instant().field(state);
  ExtremeSearch least(-1.0), largest(1.0);
  for (std::size_t k = 0; k < beam.elements.size(); ++k)
    with_beam_element(system.plan(), beam.elements[k], [&](const auto& e) {
      ElementForce along(system, e, beam.loads[k], f, state);
      const auto value = [&along, component](double at) { return along.at(at)[component]; };
      least.see_element(value, std::decay_t<decltype(e)>::num_ports, k);
      largest.see_element(value, std::decay_t<decltype(e)>::num_ports, k);
    });
  const auto elements = static_cast<double>(beam.elements.size());
  return {-least.value(), largest.value(), least.place() / elements, largest.place() / elements};
}

Vec6<double> section_strain_at(const step::System& system, const step::State& state, const plan::SensorPlan& s) {
  if (system.plan().is_dynamic) return eval_station(system, system.instant().field(state), s).strain;
  const plan::BeamPlan& beam = system.plan().beams[static_cast<std::size_t>(s.beam)];
  const auto element = static_cast<std::size_t>(locate(beam, s.sensor.station).first);
  Vec6<double> strain;
  with_beam_element(system.plan(), beam.elements[element],
                    [&](const auto& e) { strain = strain_of(e.stiffness, section_force_at(system, state, s)); });
  return strain;
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
      ElementForce along(system, e, beam.loads[k], f, state);
      for (int i = k == 0 ? 0 : 1; i <= parts; ++i) {
        const double s = static_cast<double>(i) / parts;
        const Vec6<double> force = along.at(s);
        BeamPoint point = eval_point(e, f, s);
        if (!system.plan().is_dynamic) point.strain = strain_of(e.stiffness, force);
        curve.points.push_back(make_curve_point(point, force));
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

/// Velocity of a port's origin in the axes of the ground.
Vec3<double> velocity_of(const Port& port, const Field& f) {
  const PointMotion p = motion_of_port(port, f);
  return p.pose.R * lanes::linear_part(p.v);
}

/// Calls visit(name, first port, second port) for joints, couplings and prescribed motions, in the order of
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
  copy(velocity_of(e.ports[port], f), arrow.velocity);
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
    copy(velocity_of(first, f), link.first_velocity);
    copy(velocity_of(second, f), link.second_velocity);
    frame.links.push_back(link);
  });
  for (std::size_t k = 0; k < plan.frames.size(); ++k) {
    const Frame<double>& pose = f.carriers[k].pose;
    records::FramePose& moving = frame.frames.emplace_back();
    moving.name = plan.frames[k].name;
    copy(pose.x, moving.position);
    copy(pose.R, moving.axes);
    copy(pose.R * lanes::linear_part(f.carriers[k].twist), moving.velocity);
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
  for (const scene::Coupling& c : scene.couplings) {
    const auto line = scene::line_force_of(c);
    kind_of[c.name] = !line                      ? c.kind->name
                      : !(line->damping > 0.0)   ? "spring"
                      : !(line->stiffness > 0.0) ? "damper"
                                                 : "spring and damper";
  }
  for_each_link(plan, [&](const std::string& name, const Port&, const Port&) {
    const auto found = kind_of.find(name);
    parts.links.push_back({found != kind_of.end() ? found->second : "prescribed motion"});
  });
  return parts;
}

}  // namespace bough::results
