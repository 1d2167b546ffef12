#pragma once
/// Bodies of planar/evaluate.hpp; included in the files that instantiate them.
#include "beam_tangent.hpp"
#include "bough/elements/planar/evaluate.hpp"

namespace bough::elements::planar {

using lanes::Jet;

template <class E, class S, class T>
void eval_kernel(const E& e, const PortMotion<T>* p, const S* multipliers, const S& turns,
                 const Surroundings<T>& around, Vec3<T>* out, T* rows) {
  if constexpr (E::num_rows_at_most > 0)
    eval_joint(e, p, multipliers, around, turns, out, rows);
  else
    eval_residual(e, p, around, out);
}

template <class E, class S>
const PairOf<S>* anchor_of(const E& e, const NodeOf<S>* nodes) {
  for (const auto& port : e.ports)
    if (port.node != ground) return &nodes[port.node].x;
  return nullptr;
}
template <class S>
Vec2<S> difference(const PairOf<S>& a, const PairOf<S>& b) {
  Vec2<S> r;
  for (int i = 0; i < 2; ++i) {
    S s, e;
    motion::two_sum(a.hi[i], S(-b.hi[i]), s, e);
    r[i] = s + (e + (a.lo[i] - b.lo[i]));
  }
  return r;
}

/// Pose, twist and acceleration at a port from those of its node (in scalar T, jets or not).
template <class C, class T>
void apply_offset(const PortOf<C>& port, PortMotion<T>& p) {
  if (!port.has_offset) return;
  p.x += motion::complex_times(port.x, p.turn);
  p.turn = motion::complex_times(port.turn, p.turn);
  p.v = seen_from(port.turn, port.x, p.v);
  p.a = seen_from(port.turn, port.x, p.a);
}

template <class E, class S>
PortMotion<S> node_motion(const E& e, int k, const FieldOf<S>& field, const PairOf<S>& anchor) {
  const PortOf<S>& port = e.ports[k];
  if (port.node == ground)
    return {port.turn, difference({port.x, Vec2<S>::zero()}, anchor), Vec3<S>::zero(), Vec3<S>::zero()};
  const NodeOf<S>& n = field.nodes[port.node];
  return {n.turn, difference(n.x, anchor), n.v, n.a};
}

/// The node's motion with its derivatives by its own increment, which are directions `first` to `first + 2`:
///   d turn = i turn eta_w,  dx = turn eta_u,  dv = velocity T(dq)^-1 eta,  da = acceleration T(dq)^-1 eta
template <int D, class S>
PortMotion<Jet<S, D>> seeded(const PortMotion<S>& p, const NodeOf<S>& node, const Slopes& slopes, bool moves,
                             bool has_rates, int first) {
  using T = Jet<S, D>;
  PortMotion<T> r;
  for (int i = 0; i < 2; ++i) {
    r.turn[i] = T(p.turn[i]);
    r.x[i] = T(p.x[i]);
  }
  for (int i = 0; i < 3; ++i) {
    r.v[i] = T(p.v[i]);
    r.a[i] = T(p.a[i]);
  }
  if (moves) {
    r.turn[0].d[first + 2] = -p.turn[1];
    r.turn[1].d[first + 2] = p.turn[0];
    r.x[0].d[first] = p.turn[0];
    r.x[0].d[first + 1] = -p.turn[1];
    r.x[1].d[first] = p.turn[1];
    r.x[1].d[first + 1] = p.turn[0];
  }
  if (!has_rates) return r;
  if (slopes.mass_only) {
    for (int i = 0; i < 3; ++i) r.a[i].d[first + i] = S(1.0);
    return r;
  }
  const Mat3<S> inverse = motion::inverse_tangent_plane(node.dq);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      r.v[i].d[first + j] = slopes.velocity * inverse(i, j);
      r.a[i].d[first + j] = slopes.acceleration * inverse(i, j);
    }
  return r;
}

/// Whether an element's forces depend on velocities or accelerations.
template <class E>
bool looks_at_rates(const E& e) {
  if constexpr (requires { e.has_mass; })
    return e.has_mass || e.has_damping;
  else if constexpr (requires { e.has_damping; })
    return e.has_damping;
  else if constexpr (requires { e.rest_length; })
    return is_present(e.damping);
  else if constexpr (requires { e.mass; })
    return true;
  else if constexpr (E::num_rows_at_most > 0) {
    bool damped = false;
    for (int k = 0; k < e.num_efforts; ++k) damped = damped || is_present(e.efforts[k].effort.damping);
    return damped;
  } else
    return false;  // loads
}

/// Wrenches at the nodes, ports on the ground left out, then rows.
template <class E, class T>
void gather(const E& e, const Vec3<T>* out, const T* rows, T* residual) {
  int n = 0;
  for (int k = 0; k < E::num_ports; ++k) {
    if (e.ports[k].node == ground) continue;
    const Vec3<T> f = e.ports[k].has_offset ? carried_back(e.ports[k].turn, e.ports[k].x, out[k]) : out[k];
    for (int i = 0; i < 3; ++i) residual[n++] = f[i];
  }
  for (int k = 0; k < num_multipliers(e); ++k) residual[n++] = rows[k];
}

template <class E, class S>
void eval_magnitude(const E& e, const FieldOf<S>& field, const S* residual, S* magnitude) {
  using std::abs;
  for (int i = 0; i < num_unknowns(e); ++i) magnitude[i] = abs(residual[i]);
  if constexpr (std::is_same_v<E, RigidBodyOf<S>>) {
    const NodeOf<S>& n = field.nodes[e.ports[0].node];
    const Vec2<S> weight = motion::conjugate_times(n.turn, field.around.gravity);
    if (e.is_point) {
      Vec2<S> terms[3] = {e.mass(0, 0) * weight, Vec2<S>::zero(), Vec2<S>::zero()};
      if (field.around.has_inertia) {
        terms[1] = e.mass(0, 0) * motion::plane_part(n.a);
        terms[2] = n.v[2] * motion::quarter_turn(Vec2<S>(e.mass(0, 0) * motion::plane_part(n.v)));
      }
      for (int i = 0; i < 2; ++i)
        for (const Vec2<S>& t : terms) magnitude[i] = magnitude[i] + abs(t[i]);
      return;
    }
    Vec3<S> terms[3] = {e.mass * motion::join(weight, S(0.0)), Vec3<S>::zero(), Vec3<S>::zero()};
    if (field.around.has_inertia) {
      terms[1] = e.mass * n.a;
      terms[2] = gyroscopic(n.v, Vec3<S>(e.mass * n.v));
    }
    for (int i = 0; i < 3; ++i)
      for (const Vec3<S>& t : terms) magnitude[i] = magnitude[i] + abs(t[i]);
  }
}

/// The tangent from the kernel's own source, run on jets.
template <class E, class S>
void eval_tangent_on_jets(const E& e, const FieldOf<S>& field, const S* multipliers, const S& turns, S* tangent) {
  constexpr int P = E::num_ports, D = 3 * P, most_rows = E::num_rows_at_most;
  using T = Jet<S, D>;
  const bool mass_only = field.slopes.mass_only, is_joint = most_rows > 0;
  const bool has_rates = field.around.has_inertia && looks_at_rates(e);
  const PairOf<S> anchor = *anchor_of(e, field.nodes);
  PortMotion<T> moved[P];
  for (int k = 0; k < P; ++k) {
    const bool on_ground = e.ports[k].node == ground;
    moved[k] = seeded<D>(node_motion(e, k, field, anchor), field.nodes[on_ground ? 0 : e.ports[k].node], field.slopes,
                         !on_ground && (!mass_only || is_joint), !on_ground && has_rates, 3 * k);
    if (!on_ground) apply_offset(e.ports[k], moved[k]);
  }
  const Surroundings<T> around{
      {{T(field.around.gravity[0]), T(field.around.gravity[1])}}, field.around.laws, field.around.has_inertia};
  Vec3<T> slopes[P];
  T row_slopes[most_rows + 1], all[D + most_rows + 1];
  eval_kernel<E, S, T>(e, moved, multipliers, turns, around, slopes, row_slopes);
  gather<E, T>(e, slopes, row_slopes, all);
  const int n = num_unknowns(e), m = num_multipliers(e), forces = n - m;
  int column = 0;
  for (int k = 0; k < P; ++k) {
    if (e.ports[k].node == ground) continue;
    for (int j = 0; j < 3; ++j, ++column) {
      for (int i = 0; i < forces; ++i) tangent[i * n + column] = is_joint && mass_only ? S(0.0) : all[i].d[3 * k + j];
      for (int i = forces; i < n; ++i)  // forces are G^T lambda: the columns of the multipliers
        tangent[i * n + column] = tangent[column * n + i] = all[i].d[3 * k + j];
    }
  }
  for (int i = forces; i < n; ++i)
    for (int j = forces; j < n; ++j) tangent[i * n + j] = S(0.0);
}

/// How the ports of an element follow the unknowns of their nodes.
template <class E, class S>
void eval_port_slopes(const E& e, const FieldOf<S>& field, PortSlopes<S>* ports) {
  const bool has_rates = field.around.has_inertia && looks_at_rates(e);
  for (int k = 0; k < E::num_ports; ++k) {
    const PortOf<S>& port = e.ports[k];
    ports[k].moves = !field.slopes.mass_only;
    if (port.node == ground || !has_rates || field.slopes.mass_only) {
      ports[k].velocity = ports[k].acceleration = PlaneMap<S>::zero();
      if (port.node != ground && has_rates) ports[k].acceleration.c[0] = ports[k].acceleration.b = S(1.0);
      continue;
    }
    Vec3<S> dq = field.nodes[port.node].dq;
    if (port.has_offset) dq = seen_from(port.turn, port.x, dq);
    const PlaneMap<S> inverse = inverse_tangent_map(dq);
    ports[k].velocity = scaled(field.slopes.velocity, inverse);
    ports[k].acceleration = scaled(field.slopes.acceleration, inverse);
  }
}

/// Elements whose tangents have a closed form.
template <class E>
inline constexpr bool has_closed_tangent = false;
template <int N, class C>
inline constexpr bool has_closed_tangent<Beam<N, C>> = true;

/// Wrenches and blocks by ports' increments carried to the nodes, F_node = J^T F, K_node = J^T K J with J = Ad(offset^-1).
template <class E, class S>
void eval_closed_tangent(const E& e, const FieldOf<S>& field, const PortMotion<S>* p, Vec3<S>* out, S* tangent) {
  constexpr int P = E::num_ports;
  PortSlopes<S> ports[P];
  eval_port_slopes(e, field, ports);
  int to[P], n = 0;
  for (int k = 0; k < P; ++k) to[k] = e.ports[k].node == ground ? -1 : 3 * n++;
  const int size = 3 * n;
  eval_tangent(e, p, ports, field.around, out, [&](int i, int j, Mat3<S> block) {
    if (to[i] < 0 || to[j] < 0) return;
    if (e.ports[j].has_offset) block = matrix_product(block, offset_map(e.ports[j]));
    if (e.ports[i].has_offset) block = transposed_product(offset_map(e.ports[i]), block);
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) tangent[(to[i] + k) * size + to[j] + l] = block(k, l);
  });
}

template <class E, class S>
void evaluate_element(const E& e, const FieldOf<S>& field, const S* multipliers, const S& turns, S* residual,
                      S* tangent) {
  const PairOf<S> anchor = *anchor_of(e, field.nodes);
  PortMotion<S> p[E::num_ports];
  for (int k = 0; k < E::num_ports; ++k) {
    p[k] = node_motion(e, k, field, anchor);
    if (e.ports[k].node != ground) apply_offset(e.ports[k], p[k]);
  }
  Vec3<S> out[E::num_ports];
  S rows[E::num_rows_at_most + 1];
  if constexpr (has_closed_tangent<E>) {
    if (tangent != nullptr) {
      eval_closed_tangent(e, field, p, out, tangent);
      return gather<E, S>(e, out, rows, residual);
    }
  }
  eval_kernel<E, S, S>(e, p, multipliers, turns, field.around, out, rows);
  gather<E, S>(e, out, rows, residual);
  if constexpr (!has_closed_tangent<E>)
    if (tangent != nullptr) eval_tangent_on_jets(e, field, multipliers, turns, tangent);
}

template <class E>
void evaluate(const E& e, const Field& field, const double* multipliers, double turns, double* residual,
              double* magnitude, double* tangent) {
  evaluate_element<E, double>(e, field, multipliers, turns, residual, tangent);
  eval_magnitude<E, double>(e, field, residual, magnitude);
}

}  // namespace bough::elements::planar
