#pragma once
/// The shared checker of elements: a second driver, in any scalar, from node motions to node residuals. It shares the
/// kernels with the library but none of the drivers' code: ports, offsets, seeds of derivatives and gathering.
#include <complex>
#include <vector>

#include "bough/elements/energies.hpp"
#include "elements/beam_energy.hpp"
#include "elements/samples.hpp"

namespace bough::elements::check {

using Complex = std::complex<double>;
constexpr double complex_step = 1e-40;  ///< its square is below round-off of anything

template <class S>
struct NodeState {
  Frame<S> H;  ///< position relative to the anchor
  Vec6<S> v, a;
};

template <class S>
std::vector<NodeState<S>> states_of(const std::vector<NodeMotion>& nodes, const motion::Vec3Pair& anchor) {
  std::vector<NodeState<S>> r;
  for (const NodeMotion& n : nodes)
    r.push_back({motion::cast<S>(Frame<double>{n.R, motion::difference(n.x, anchor)}), lanes::cast<S>(n.v),
                 lanes::cast<S>(n.a)});
  return r;
}

/// Twist of the frame in which nodes are described, and its rate.
template <class S>
struct ObserverTwist {
  Vec6<S> twist, twist_rate;
};
template <class S>
ObserverTwist<S> twist_of(const CarrierMotion& m) {
  return {lanes::cast<S>(m.twist), lanes::cast<S>(m.twist_rate)};
}

/// Ports seen from the inertial frame where the nodes are described in another, by 6x6 matrices:
///   v + Q V,  a + Q V' - ad(v) Q V,  Q = Ad(H)^-1.
template <class S, class E>
void carry_along(const E&, const ObserverTwist<S>* observer, const Vec3<double>& anchor,
                 std::vector<PortMotion<S>>& ports) {
  if (observer == nullptr || !has_mass_matrix<E>) return;
  for (PortMotion<S>& p : ports) {
    const Mat6<S> Q = motion::inverse_adjoint(Frame<S>{p.H.R, p.H.x + lanes::cast<S>(anchor)});
    const Vec6<S> carried = Q * observer->twist;
    p.a += Q * observer->twist_rate - motion::cross6(p.v) * carried;
    p.v += carried;
  }
}

template <class S, class E>
std::vector<PortMotion<S>> ports_of(const E& e, const std::vector<NodeState<S>>& nodes, const Vec3<double>& anchor) {
  std::vector<PortMotion<S>> r;
  for (const Port& port : e.ports) {
    const Frame<S> offset = motion::cast<S>(port.offset);
    if (port.node == ground) {
      r.push_back({{offset.R, offset.x - lanes::cast<S>(anchor)}, Vec6<S>::zero(), Vec6<S>::zero()});
      continue;
    }
    const NodeState<S>& n = nodes[static_cast<std::size_t>(port.node)];
    const Mat6<S> inverse = motion::inverse_adjoint(offset);
    r.push_back({motion::compose(n.H, offset), inverse * n.v, inverse * n.a});
  }
  return r;
}

template <class S, class E>
void eval_kernel_of(const E& e, const PortMotion<S>* p, const S* multipliers, const Surroundings<S>& around, S* out,
                    double turns) {
  if constexpr (E::num_multipliers > 0)
    eval_residual(e, p, multipliers, around, turns, out, out + 6 * E::num_ports);
  else
    eval_residual(e, p, around, out);
}

template <class S, class E>
S energy_of(const E& e, const PortMotion<S>* p, double turns, const S* laws) {
  if constexpr (E::num_multipliers > 0)
    return eval_strain_energy(e, p, turns);
  else if constexpr (requires { eval_strain_energy(e, p, laws); })
    return eval_strain_energy(e, p, laws);
  else if constexpr (requires { strain_energy_of(e, p); })
    return strain_energy_of(e, p);
  else
    return eval_strain_energy(e, p);
}

/// Residual in the unknowns of the nodes, then the constraint rows.
template <class S, class E>
std::vector<S> node_residual(const E& e, const std::vector<NodeState<S>>& nodes, const Vec3<double>& anchor,
                             const std::vector<S>& multipliers, const Surroundings<S>& around, double turns,
                             const ObserverTwist<S>* observer = nullptr) {
  constexpr int P = E::num_ports;
  std::vector<PortMotion<S>> p = ports_of(e, nodes, anchor);
  carry_along(e, observer, anchor, p);
  S out[6 * P + E::num_multipliers];
  eval_kernel_of(e, p.data(), multipliers.data(), around, out, turns);
  std::vector<S> r;
  for (int k = 0; k < P; ++k) {
    if (e.ports[k].node == ground) continue;
    Vec6<S> f;
    for (int i = 0; i < 6; ++i) f[i] = out[6 * k + i];
    f = lanes::transpose_times(motion::inverse_adjoint(motion::cast<S>(e.ports[k].offset)), f);
    for (int i = 0; i < 6; ++i) r.push_back(f[i]);
  }
  for (int k = 0; k < num_multipliers(e); ++k) r.push_back(out[6 * P + k]);
  return r;
}

/// Velocity and acceleration of a frame that drifts and falls, as components in the axes of a node that turns:
///   v += (b; 0),  a += (c - w x b; 0) with the angular velocity w that v has.
template <class S>
void add_drift_to(NodeState<S>& n, const Vec3<S>& b, const Vec3<S>& c, double sign) {
  const Vec3<S> rate = c - lanes::cross(lanes::angular_part(n.v), b);
  for (int i = 0; i < 3; ++i) {
    n.v[i] += sign * b[i];
    n.a[i] += sign * rate[i];
  }
}

/// Node moved by the iteration's increment eta, velocity and acceleration following as Slopes says.
template <class S>
NodeState<S> stepped(const NodeState<S>& n, const NodeMotion& at, const Slopes& slopes, bool moves,
                     const Vec3<S>& gravity, const Vec6<S>& eta) {
  NodeState<S> r = n;
  const Frame<S> step = motion::exp_se3(eta);
  if (moves) r.H = motion::compose(n.H, step);
  const Vec6<S> of_coordinates = motion::inverse_tangent(lanes::cast<S>(at.dq)) * eta;
  const Vec3<S> none = Vec3<S>::zero(), drift = slopes.drifts ? lanes::cast<S>(at.drift) : none;
  const auto fall = [&](const NodeState<S>& of) {
    return slopes.falls ? lanes::transpose_times(of.H.R, gravity) : none;
  };
  add_drift_to(r, drift, fall(n), -1.0);
  r.v += slopes.velocity * of_coordinates;
  r.a += slopes.mass_only ? eta : slopes.acceleration * of_coordinates;
  add_drift_to(r, lanes::transpose_times(step.R, drift), fall(r), 1.0);
  return r;
}

inline std::vector<Complex> complex_of(const std::vector<double>& a) { return {a.begin(), a.end()}; }

/// Derivatives of the residual (rows) along all unknowns (columns) by the complex step, row-major.
template <class E>
std::vector<double> complex_tangent(const Sample<E>& s, const Field& field) {
  const E& e = s.element;
  const int n = num_unknowns(e), m = num_multipliers(e);
  const motion::Vec3Pair anchor = anchor_of(e, s.nodes.data());
  const std::vector<Complex> laws = complex_of(s.laws);
  const Surroundings<Complex> around{lanes::cast<Complex>(field.around.gravity), laws.data(), field.around.has_inertia};
  const ObserverTwist<Complex> moving =
      twist_of<Complex>(field.observer != nullptr ? *field.observer : CarrierMotion{});
  const ObserverTwist<Complex>* observer = field.observer != nullptr ? &moving : nullptr;
  std::vector<double> tangent(static_cast<std::size_t>(n * n));
  int column = 0;
  const auto fill = [&](const std::vector<Complex>& r) {
    for (int i = 0; i < n; ++i)
      tangent[static_cast<std::size_t>(i * n + column)] = r[static_cast<std::size_t>(i)].imag() / complex_step;
    ++column;
  };
  Slopes slopes = field.slopes;
  if (!field.around.has_inertia) slopes.velocity = slopes.acceleration = 0.0, slopes.drifts = slopes.falls = false;
  if (slopes.mass_only) slopes.velocity = slopes.acceleration = 0.0;
  for (const Port& port : e.ports) {
    if (port.node == ground) continue;
    for (int k = 0; k < 6; ++k) {
      std::vector<NodeState<Complex>> states = states_of<Complex>(s.nodes, anchor);
      NodeState<Complex>& node = states[static_cast<std::size_t>(port.node)];
      const Vec6<Complex> eta = Complex(0.0, complex_step) * Vec6<Complex>::unit(k);
      node =
          stepped(node, s.nodes[static_cast<std::size_t>(port.node)], slopes, !slopes.mass_only, around.gravity, eta);
      std::vector<Complex> r =
          node_residual(e, states, anchor.hi, complex_of(s.multipliers), around, s.turns, observer);
      if (slopes.mass_only && m > 0) {  // rows keep the gradient of positions: G a, as in the constraint's second rate
        states = states_of<Complex>(s.nodes, anchor);
        NodeState<Complex>& moved = states[static_cast<std::size_t>(port.node)];
        moved = stepped(moved, s.nodes[static_cast<std::size_t>(port.node)], Slopes{}, true, around.gravity, eta);
        const auto rows = node_residual(e, states, anchor.hi, complex_of(s.multipliers), around, s.turns, observer);
        for (int i = n - m; i < n; ++i) r[static_cast<std::size_t>(i)] = rows[static_cast<std::size_t>(i)];
      }
      fill(r);
    }
  }
  for (int k = 0; k < m; ++k) {
    std::vector<Complex> multipliers = complex_of(s.multipliers);
    multipliers[static_cast<std::size_t>(k)] += Complex(0.0, complex_step);
    fill(node_residual(e, states_of<Complex>(s.nodes, anchor), anchor.hi, multipliers, around, s.turns, observer));
  }
  return tangent;
}

/// What the library gives.
struct Evaluation {
  std::vector<double> residual, tangent;
};
template <class E>
Evaluation evaluation_of(const Sample<E>& s, const Field& field) {
  const auto n = static_cast<std::size_t>(num_unknowns(s.element));
  Evaluation r{std::vector<double>(n), std::vector<double>(n * n)};
  evaluate(s.element, field, s.multipliers.data(), s.turns, r.residual.data(), r.tangent.data());
  return r;
}
template <class E>
std::vector<double> residual_of(const Sample<E>& s, const Field& field) {
  std::vector<double> r(static_cast<std::size_t>(num_unknowns(s.element)));
  evaluate(s.element, field, s.multipliers.data(), s.turns, r.data(), nullptr);
  return r;
}

/// Energies as they are reported, and what changes them and the momentum; rates are those of statics at rest.
struct Measured {
  double kinetic = 0.0, strain = 0.0, potential = 0.0, work_rate = 0.0;
  Vec6<double> momentum = Vec6<double>::zero();  ///< (linear; angular about the origin)
  Vec6<double> load = Vec6<double>::zero();      ///< resultant of gravity, loads and reactions of the ground
};

/// Power of the constraints and drives of a joint.
inline double joint_power(const Sample<Joint>& s, const std::vector<PortMotion<double>>& p) {
  const Frame<double> H = motion::relative(p[0].H, p[1].H);
  const Vec6<double> twist = p[1].v - motion::inverse_adjoint_times(H, p[0].v);
  double power = 0.0;
  Vec6<double> gradient;
  for (int k = 0; k < s.element.num_rows; ++k) {
    eval_row(s.element.rows[k], H, s.turns, s.laws.data(), gradient);
    power -= s.multipliers[static_cast<std::size_t>(k)] * lanes::dot(gradient, twist);
  }
  for (int k = 0; k < s.element.num_efforts; ++k) {
    const Effort& e = s.element.efforts[k];
    motion::Se3::Wrench<double> g;
    eval_coordinate<motion::Se3, double, double>(e, H, s.turns, g);
    if (e.law >= 0) power += s.laws[static_cast<std::size_t>(e.law)] * lanes::dot(motion::wrench_vector(g), twist);
  }
  return power;
}

template <class E>
Measured measured(const Sample<E>& s, bool has_inertia = true) {
  const Field field = s.field(has_inertia);
  Measured m;
  if constexpr (E::role != Role::load) {
    const Energies e = eval_energies(s.element, field, s.turns);
    const Vec3<double>& g = field.around.gravity;
    m.kinetic = e.kinetic;
    m.strain = e.strain;
    m.potential = -lanes::dot(g, e.mass_moment);
    m.momentum = e.momentum;
    m.load = lanes::join(e.mass * g, lanes::cross(e.mass_moment, g));
  }
  const Vec3<double> origin = Vec3<double>::zero();
  const auto p = ports_of(s.element, states_of<double>(s.nodes, motion::Vec3Pair::from(origin)), origin);
  double out[6 * E::num_ports + E::num_multipliers];
  eval_kernel_of(s.element, p.data(), s.multipliers.data(), field.around, out, s.turns);
  for (int k = 0; k < E::num_ports; ++k) {
    Vec6<double> f;
    for (int i = 0; i < 6; ++i) f[i] = out[6 * k + i];
    const Vec6<double> at_origin = motion::inverse_adjoint_transpose_times(p[static_cast<std::size_t>(k)].H, f);
    if (s.element.ports[k].node == ground) m.load += at_origin;
    if (E::role != Role::load) continue;
    m.load -= at_origin;
    if (has_inertia) m.work_rate -= lanes::dot(f, p[static_cast<std::size_t>(k)].v);
  }
  if constexpr (E::role == Role::joint)
    if (has_inertia) m.work_rate = joint_power(s, p);
  return m;
}

inline double largest(const std::vector<double>& a) {
  double m = 0.0;
  for (const double x : a) m = std::max(m, std::abs(x));
  return m;
}
/// Largest difference over the largest entry of both (or `floor`, if that is more).
inline double relative_error(const std::vector<double>& a, const std::vector<double>& b, double floor = 1e-30) {
  if (a.size() != b.size()) return 1e300;
  double m = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) m = std::max(m, std::abs(a[i] - b[i]));
  return m / std::max({largest(a), largest(b), floor});
}

}  // namespace bough::elements::check
