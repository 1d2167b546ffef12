#include "bough/elements/evaluate.hpp"

namespace bough::elements {

namespace {

/// Wrench (port axes) at a port as (force; moment about the inertial origin) in inertial axes.
Vec6<double> to_inertial(const PortMotion<double>& p, const Vec3<double>& anchor, const Vec6<double>& wrench) {
  const Vec3<double> force = p.H.R * lanes::linear_part(wrench);
  const Vec3<double> moment = p.H.R * lanes::angular_part(wrench) + lanes::cross(p.H.x + anchor, force);
  return lanes::join(force, moment);
}

double power(const Vec6<double>& wrench, const Vec6<double>& twist) { return lanes::dot(wrench, twist); }

/// Gravity on a mass given by its 6x6 mass in a frame: force and potential.
void add_gravity(const Mat6<double>& mass, double factor, const PortMotion<double>& p, const Vec3<double>& anchor,
                 const Vec3<double>& gravity, Measures& m) {
  const Vec3<double> moment{{mass(5, 1), mass(3, 2), mass(4, 0)}};  // mass times the centre
  const Vec3<double> x = mass(0, 0) * (p.H.x + anchor) + p.H.R * moment;
  m.potential -= factor * lanes::dot(gravity, x);
  const Vec3<double> force = (factor * mass(0, 0)) * gravity;
  m.load += lanes::join(force, lanes::cross(factor * x, gravity));
}

/// Motions of the ports as seen from the inertial frame, in the axes of the frame in which nodes are described. `anchor` is what
/// positions are relative to, counted from the inertial origin.
template <class E>
void eval_ports(const E& e, const Field& field, PortMotion<double>* p, Vec3<double>& anchor) {
  const motion::Vec3Pair a = anchor_of(e, field.nodes);
  for (int k = 0; k < E::num_ports; ++k) p[k] = eval_port(e.ports[k], field.nodes, a, field.carriers);
  anchor = a.hi + a.lo;
  if (field.observer == nullptr) return;
  const CarrierMotion& o = *field.observer;
  for (int k = 0; k < E::num_ports; ++k) add_observer_motion(p[k], anchor, o.twist, o.twist_rate);
  anchor += lanes::transpose_times(o.pose.R, o.pose.x);
}

/// Reactions of the ground on the structure through an element, from its residual at the ports.
template <class E>
void add_ground_reaction(const E& e, const PortMotion<double>* p, const Vec3<double>& anchor, const double* out,
                         Measures& m) {
  for (int k = 0; k < E::num_ports; ++k) {
    if (e.ports[k].node != ground) continue;
    Vec6<double> f;
    for (int i = 0; i < 6; ++i) f[i] = out[6 * k + i];
    m.load += to_inertial(p[k], anchor, f);  // what the element asks of the ground, the ground gives
    m.work_rate += power(f, p[k].v);         // 0 where the ground stands still
  }
}

template <class E>
Measures measure_load(const E& e, const Field& field) {
  PortMotion<double> p[E::num_ports];
  Vec3<double> anchor;
  eval_ports(e, field, p, anchor);
  double out[6 * E::num_ports];
  eval_residual(e, p, static_cast<const double*>(nullptr), field.around, out);
  Measures m;
  for (int k = 0; k < E::num_ports; ++k) {
    Vec6<double> f;
    for (int i = 0; i < 6; ++i) f[i] = -out[6 * k + i];
    if (field.around.has_inertia) m.work_rate += power(f, p[k].v);
    m.load += to_inertial(p[k], anchor, f);
  }
  add_ground_reaction(e, p, anchor, out, m);
  return m;
}

template <class E>
Measures measure_coupling(const E& e, const Field& field) {
  PortMotion<double> p[2];
  Vec3<double> anchor;
  eval_ports(e, field, p, anchor);
  double out[12], elastic[12];
  eval_residual(e, p, static_cast<const double*>(nullptr), field.around, out);
  Measures m;
  m.strain = eval_strain_energy(e, p);
  if (field.around.has_inertia) {
    Surroundings<double> still = field.around;
    still.has_inertia = false;
    eval_residual(e, p, static_cast<const double*>(nullptr), still, elastic);
    for (int k = 0; k < 12; ++k) m.dissipation_rate += (out[k] - elastic[k]) * p[k / 6].v[k % 6];
  }
  add_ground_reaction(e, p, anchor, out, m);
  return m;
}

/// The ground's part in an element whose residual is not at hand otherwise.
template <class E>
void add_ground_reaction_if_any(const E& e, const PortMotion<double>* p, const Vec3<double>& anchor, const Field& field,
                                Measures& m) {
  bool grounded = false;
  for (const Port& port : e.ports) grounded = grounded || port.node == ground;
  if (!grounded) return;
  double out[6 * E::num_ports];
  eval_residual(e, p, static_cast<const double*>(nullptr), field.around, out);
  add_ground_reaction(e, p, anchor, out, m);
}

template <int N>
Measures measure_beam(const Beam<N>& beam, const Field& field) {
  PortMotion<double> p[N];
  Vec3<double> anchor;
  eval_ports(beam, field, p, anchor);
  Measures m;
  m.strain = eval_strain_energy(beam, p);
  const BeamShape<double, N> b = eval_shape<double, N>(p);
  const PortMotion<double>& r = p[Beam<N>::reference];
  Vec6<double> rate[N];
  const bool moves = field.around.has_inertia;
  if (moves) eval_shape_rates<double, N>(b, p, rate);
  if (moves && beam.has_damping) {
    BeamRates<double, N> rates;
    eval_beam_rates<double, N>(p, field.around, false, true, rates);
    DualVec<double> viscous[N], elastic[N];
    eval_internal_forces<double, N>(beam, rates, true, viscous);
    eval_internal_forces<double, N>(beam, rates, false, elastic);
    for (int i = 0; i < N; ++i)
      if (i != Beam<N>::reference) m.dissipation_rate += dot(viscous[i] - elastic[i], rates.rate[i]).b;
  }
  add_ground_reaction_if_any(beam, p, anchor, field, m);
  if (!beam.has_mass) return m;
  const auto& rule = mass_rule<N>();
  for (int g = 0; g < N; ++g) {
    const double w = rule.weight[g] * beam.length;
    const SectionMotion<double> s = eval_section<double, N>(rule.shape[g], b, moves ? rate : nullptr, nullptr, r);
    PortMotion<double> section;
    section.H = motion::compose(r.H, s.relative);
    if (moves) {
      const Vec6<double> momentum = w * (beam.mass * s.v);
      m.kinetic += 0.5 * lanes::dot(momentum, s.v);
      m.momentum += to_inertial(section, anchor, momentum);
    }
    add_gravity(beam.mass, w, section, anchor, field.around.gravity, m);
  }
  return m;
}

}  // namespace

template <>
Measures measure(const Beam<2>& e, const Field& field, const double*, double) {
  return measure_beam(e, field);
}
template <>
Measures measure(const Beam<3>& e, const Field& field, const double*, double) {
  return measure_beam(e, field);
}
template <>
Measures measure(const Beam<4>& e, const Field& field, const double*, double) {
  return measure_beam(e, field);
}
template <>
Measures measure(const LineLoad<2>& e, const Field& field, const double*, double) {
  return measure_load(e, field);
}
template <>
Measures measure(const LineLoad<3>& e, const Field& field, const double*, double) {
  return measure_load(e, field);
}
template <>
Measures measure(const LineLoad<4>& e, const Field& field, const double*, double) {
  return measure_load(e, field);
}
template <>
Measures measure(const PointLoad& e, const Field& field, const double*, double) {
  return measure_load(e, field);
}
template <>
Measures measure(const Spring& e, const Field& field, const double*, double) {
  return measure_coupling(e, field);
}
template <>
Measures measure(const Bushing& e, const Field& field, const double*, double) {
  return measure_coupling(e, field);
}
template <>
Measures measure(const RigidBody& e, const Field& field, const double*, double) {
  PortMotion<double> p[1];
  Vec3<double> anchor;
  eval_ports(e, field, p, anchor);
  Measures m;
  if (field.around.has_inertia) {
    m.kinetic = eval_kinetic_energy(e, p);
    m.momentum = to_inertial(p[0], anchor, e.mass * p[0].v);
  }
  add_gravity(e.mass, 1.0, p[0], anchor, field.around.gravity, m);
  add_ground_reaction_if_any(e, p, anchor, field, m);
  return m;
}

template <>
Measures measure(const Joint& joint, const Field& field, const double* multipliers, double turns) {
  PortMotion<double> p[2];
  Vec3<double> anchor;
  eval_ports(joint, field, p, anchor);
  double out[12 + max_rows];
  eval_residual(joint, p, multipliers, field.around, out, turns);
  Measures m;
  m.strain = eval_strain_energy(joint, p, turns);
  add_ground_reaction(joint, p, anchor, out, m);
  if (!field.around.has_inertia) return m;
  const Frame<double> H = motion::relative(p[0].H, p[1].H);
  const Vec6<double> twist = p[1].v - motion::inverse_adjoint_times(H, p[0].v);
  Vec6<double> gradient;
  for (int k = 0; k < joint.num_rows; ++k) {
    eval_row(joint.rows[k], H, turns, field.around.laws, gradient);
    m.work_rate -= multipliers[k] * lanes::dot(gradient, twist);
  }
  for (int k = 0; k < joint.num_efforts; ++k) {
    const Effort& e = joint.efforts[k];
    eval_coordinate(e.coordinate, H, turns, gradient);
    const double rate = lanes::dot(gradient, twist);
    m.dissipation_rate += e.damping * rate * rate;
    if (e.law >= 0) m.work_rate += field.around.laws[e.law] * rate;
  }
  return m;
}

Vec6<double> eval_reaction(const Joint& joint, const Field& field, const double* multipliers, double turns) {
  PortMotion<double> p[2];
  Vec3<double> anchor;
  eval_ports(joint, field, p, anchor);
  double out[12 + max_rows];
  eval_residual(joint, p, multipliers, field.around, out, turns);
  Vec6<double> wrench;
  for (int k = 0; k < 6; ++k) wrench[k] = -out[6 + k];
  return wrench;
}

}  // namespace bough::elements
