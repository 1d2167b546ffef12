#include "bough/elements/beam_forces.hpp"
#include "emit.hpp"
#include "ports_from_inertial.hpp"

namespace bough::elements {

namespace {

/// Adds a share of the wrench in the residual at a port, in the axes of the frame in which nodes are described.
void add_port_wrench(const PortMotion<double>* p, const Vec3<double>& anchor, const double* out, int port, double share,
                     Measures& m) {
  Vec6<double> wrench;
  for (int i = 0; i < 6; ++i) wrench[i] = share * out[6 * port + i];
  const Vec6<double> there = to_origin(p[port].H, anchor, wrench);
  m.force += lanes::linear_part(there);
  m.moment += lanes::angular_part(there);
}

/// Adds the reactions of the ground on the structure through an element, which are its residual there.
template <class E>
void add_ground_reaction(const E& e, const PortMotion<double>* p, const Vec3<double>& anchor, const double* out,
                         Measures& m) {
  for (int k = 0; k < E::num_ports; ++k)
    if (e.ports[k].node == ground) add_port_wrench(p, anchor, out, k, 1.0, m);
}

template <class E>
Measures measure_load(const E& e, const Field& field) {
  PortMotion<double> p[E::num_ports];
  Vec3<double> anchor;
  eval_ports_from_inertial(e, field, p, anchor);
  double out[6 * E::num_ports];
  eval_residual(e, p, field.around, out);
  Measures m;
  for (int k = 0; k < E::num_ports; ++k) add_port_wrench(p, anchor, out, k, -1.0, m);
  add_ground_reaction(e, p, anchor, out, m);
  return m;
}

template <class E>
Measures measure_coupling(const E& e, const Field& field) {
  PortMotion<double> p[2];
  Vec3<double> anchor;
  eval_ports_from_inertial(e, field, p, anchor);
  double out[12], elastic[12];
  eval_residual(e, p, field.around, out);
  Measures m;
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

/// Adds them for an element whose residual is needed for nothing else.
template <class E>
void add_ground_reaction(const E& e, const PortMotion<double>* p, const Vec3<double>& anchor, const Field& field,
                         Measures& m) {
  if (!holds_on_to_ground(e)) return;
  double out[6 * E::num_ports];
  eval_residual(e, p, field.around, out);
  add_ground_reaction(e, p, anchor, out, m);
}

template <int N>
Measures measure_beam(const Beam<N>& beam, const Field& field) {
  PortMotion<double> p[N];
  Vec3<double> anchor;
  eval_ports_from_inertial(beam, field, p, anchor);
  Measures m;
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
  add_ground_reaction(beam, p, anchor, field, m);
  return m;
}

}  // namespace

template <class E>
Measures measure(const E& e, const Field& field, const double*, double) {
  if constexpr (E::role == Role::beam) {
    return measure_beam(e, field);
  } else if constexpr (E::role == Role::load) {
    return measure_load(e, field);
  } else if constexpr (E::role == Role::coupling) {
    return measure_coupling(e, field);
  } else {
    PortMotion<double> p[E::num_ports];
    Vec3<double> anchor;
    eval_ports_from_inertial(e, field, p, anchor);
    Measures m;
    add_ground_reaction(e, p, anchor, field, m);
    return m;
  }
}

template <>
Measures measure(const Joint& joint, const Field& field, const double* multipliers, double turns) {
  PortMotion<double> p[2];
  Vec3<double> anchor;
  eval_ports_from_inertial(joint, field, p, anchor);
  Measures m;
  if (holds_on_to_ground(joint)) {
    double out[12], rows[max_rows];
    eval_residual(joint, p, multipliers, field.around, turns, out, rows);
    add_ground_reaction(joint, p, anchor, out, m);
  }
  if (!field.around.has_inertia) return m;
  const Frame<double> H = motion::relative(p[0].H, p[1].H);
  const Vec6<double> twist = p[1].v - motion::inverse_adjoint_times(H, p[0].v);
  for (int k = 0; k < joint.num_efforts; ++k) {
    motion::Se3::Wrench<double> g;
    eval_coordinate<motion::Se3, double, double>(joint.efforts[k], H, turns, g);
    const double rate = lanes::dot(motion::wrench_vector(g), twist);
    m.dissipation_rate += joint.efforts[k].damping * rate * rate;
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

template <class E>
constexpr auto measure_of_part = &measure<E>;
BOUGH_EMIT(measure_of_part, _all, ElementsOn<motion::Se3>)

}  // namespace bough::elements
