#include "bough/elements/energies.hpp"
#include "ports_from_inertial.hpp"

namespace bough::elements {

namespace {

double power(const Vec6<double>& wrench, const Vec6<double>& twist) { return lanes::dot(wrench, twist); }

/// Energies, and the resultant of gravity.
template <class E>
Measures begin_measures(const E& e, const Field& field, double turns) {
  const Energies energies = eval_energies(e, field, turns);
  const Vec3<double>& g = field.around.gravity;
  Measures m;
  m.kinetic = energies.kinetic;
  m.strain = energies.strain;
  m.momentum = energies.momentum;
  m.potential = -lanes::dot(g, energies.mass_moment);
  m.load = lanes::join(energies.mass * g, lanes::cross(energies.mass_moment, g));
  return m;
}

/// Reactions of the ground on the structure through an element, from its residual at the ports.
template <class E>
void add_ground_reaction(const E& e, const PortMotion<double>* p, const Vec3<double>& anchor, const double* out,
                         Measures& m) {
  for (int k = 0; k < E::num_ports; ++k) {
    if (e.ports[k].node != ground) continue;
    Vec6<double> f;
    for (int i = 0; i < 6; ++i) f[i] = out[6 * k + i];
    m.load += to_inertial(p[k], anchor, f);  // a residual at the ground is the reaction of the ground
    m.work_rate += power(f, p[k].v);         // 0 if the ground is at rest
  }
}

template <class E>
Measures measure_load(const E& e, const Field& field) {
  PortMotion<double> p[E::num_ports];
  Vec3<double> anchor;
  eval_ports_from_inertial(e, field, p, anchor);
  double out[6 * E::num_ports];
  eval_residual(e, p, field.around, out);
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
Measures measure_coupling(const E& e, const Field& field, bool with_energies) {
  PortMotion<double> p[2];
  Vec3<double> anchor;
  eval_ports_from_inertial(e, field, p, anchor);
  double out[12], elastic[12];
  eval_residual(e, p, field.around, out);
  Measures m;
  if (with_energies) m = begin_measures(e, field, 0.0);
  if (field.around.has_inertia) {
    Surroundings<double> still = field.around;
    still.has_inertia = false;
    eval_residual(e, p, still, elastic);
    for (int k = 0; k < 12; ++k) m.dissipation_rate += (out[k] - elastic[k]) * p[k / 6].v[k % 6];
  }
  if constexpr (requires { eval_energy_by_factor(e, p); })
    if (stiffness_law(e) >= 0) m.strain_by_law = eval_energy_by_factor(e, p);
  add_ground_reaction(e, p, anchor, out, m);
  return m;
}

/// Contribution of the ground to an element whose residual is not evaluated otherwise.
template <class E>
void add_ground_reaction_if_any(const E& e, const PortMotion<double>* p, const Vec3<double>& anchor, const Field& field,
                                Measures& m) {
  bool grounded = false;
  for (const Port& port : e.ports) grounded = grounded || port.node == ground;
  if (!grounded) return;
  double out[6 * E::num_ports];
  eval_residual(e, p, field.around, out);
  add_ground_reaction(e, p, anchor, out, m);
}

template <int N>
Measures measure_beam(const Beam<N>& beam, const Field& field, bool with_energies) {
  PortMotion<double> p[N];
  Vec3<double> anchor;
  eval_ports_from_inertial(beam, field, p, anchor);
  Measures m;
  if (with_energies) m = begin_measures(beam, field, 0.0);
  if (field.around.has_inertia && beam.has_damping) {
    using G = motion::Se3;
    BeamRates<G, double, N> rates;
    eval_beam_rates<G, double, N>(p, field.around, false, true, rates);
    G::Wrench<double> viscous[N], elastic[N];
    eval_internal_forces<G, double, N, double>(beam, rates, true, viscous);
    eval_internal_forces<G, double, N, double>(beam, rates, false, elastic);
    for (int i = 0; i < N; ++i)
      if (i != Beam<N>::reference) m.dissipation_rate += G::real_power(viscous[i] - elastic[i], rates.rate[i]);
  }
  add_ground_reaction_if_any(beam, p, anchor, field, m);
  return m;
}

}  // namespace

template <>
Measures measure(const Beam<2>& e, const Field& field, const double*, double, bool with_energies) {
  return measure_beam(e, field, with_energies);
}
template <>
Measures measure(const Beam<3>& e, const Field& field, const double*, double, bool with_energies) {
  return measure_beam(e, field, with_energies);
}
template <>
Measures measure(const Beam<4>& e, const Field& field, const double*, double, bool with_energies) {
  return measure_beam(e, field, with_energies);
}
template <>
Measures measure(const LineLoad<2>& e, const Field& field, const double*, double, bool) {
  return measure_load(e, field);
}
template <>
Measures measure(const LineLoad<3>& e, const Field& field, const double*, double, bool) {
  return measure_load(e, field);
}
template <>
Measures measure(const LineLoad<4>& e, const Field& field, const double*, double, bool) {
  return measure_load(e, field);
}
template <>
Measures measure(const PointLoad& e, const Field& field, const double*, double, bool) {
  return measure_load(e, field);
}
template <>
Measures measure(const Spring& e, const Field& field, const double*, double, bool with_energies) {
  return measure_coupling(e, field, with_energies);
}
template <>
Measures measure(const Bushing& e, const Field& field, const double*, double, bool with_energies) {
  return measure_coupling(e, field, with_energies);
}
template <>
Measures measure(const RigidBody& e, const Field& field, const double*, double, bool with_energies) {
  PortMotion<double> p[1];
  Vec3<double> anchor;
  eval_ports_from_inertial(e, field, p, anchor);
  Measures m;
  if (with_energies) m = begin_measures(e, field, 0.0);
  add_ground_reaction_if_any(e, p, anchor, field, m);
  return m;
}

template <>
Measures measure(const Joint& joint, const Field& field, const double* multipliers, double turns, bool with_energies) {
  PortMotion<double> p[2];
  Vec3<double> anchor;
  eval_ports_from_inertial(joint, field, p, anchor);
  double out[12], rows[max_rows];
  eval_residual(joint, p, multipliers, field.around, turns, out, rows);
  Measures m;
  if (with_energies) m = begin_measures(joint, field, turns);
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
    motion::Se3::Wrench<double> g;
    eval_coordinate<motion::Se3, double, double>(e, H, turns, g);
    const double rate = lanes::dot(motion::wrench_vector(g), twist);
    m.dissipation_rate += e.damping * rate * rate;
    if (e.law >= 0) m.work_rate += field.around.laws[e.law] * rate;
  }
  return m;
}

Vec6<double> eval_reaction(const Joint& joint, const Field& field, const double* multipliers, double turns) {
  PortMotion<double> p[2];
  Vec3<double> anchor;
  eval_ports_from_inertial(joint, field, p, anchor);
  double out[12], rows[max_rows];
  eval_residual(joint, p, multipliers, field.around, turns, out, rows);
  Vec6<double> wrench;
  for (int k = 0; k < 6; ++k) wrench[k] = -out[6 + k];
  return wrench;
}

}  // namespace bough::elements
