#pragma once
/// Rigid body, point load, spring and bushing: elements of one or two ports without multipliers, on any group.
#include "bough/elements/screw_beam.hpp"

namespace bough::elements {

/// Rigid body about its node's frame.  F = M (a - (R^T g; 0)) - ad(v)^T M v,  M the mass matrix about the node [kg,
/// kg m, kg m^2]. A point at the node's origin, M = m (1, 0; 0, 0), v = (u; w), bears no moment:  f = m (u' - R^T g)
/// + w x m u.
template <class G, class C = double>
struct RigidBodyOn {
  using Group = G;
  static constexpr int num_ports = 1;
  static constexpr int num_multipliers = 0;
  PortOn<G, C> ports[1];
  typename G::template Matrix<C> mass;
  bool is_point = false;  ///< mass holds m alone: products with its zeros are left out

  static constexpr Role role = Role::body;
  static constexpr Cost cost = small_cost;
  static constexpr bool has_stiffness_matrix = false, acts_along_line = false;
  static constexpr DataAxes data_axes = DataAxes::port;
  template <class A, class B, class Visit>
  static void visit_data(A& a, B& b, Visit& visit) {
    visit.flag(a.is_point, b.is_point);
    visit.matrix(a.mass, b.mass);
  }
};
template <class C>
using RigidBodyOf = RigidBodyOn<motion::Se3, C>;
using RigidBody = RigidBodyOf<double>;

template <class G, class C>
bool looks_at_rates(const RigidBodyOn<G, C>&) {
  return true;
}
template <class G, class C>
bool has_mass(const RigidBodyOn<G, C>&) {
  return true;
}
template <class G, class C>
C total_mass(const RigidBodyOn<G, C>& e) {
  return e.mass(0, 0);
}
/// Whether products with all but the mass of a body vanish: it is a point, or nothing turns.
template <class G, class C>
bool is_seen_as_point(const RigidBodyOn<G, C>& body) {
  return !G::turns || body.is_point;
}

/// 6x6 mass about the frame's origin, from the mass, its centre and the inertia about the centre, in the frame's axes.
Mat6<double> make_mass_matrix(double mass, const Vec3<double>& center, const Mat3<double>& inertia);

template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const RigidBodyOn<G, C>& body, const PortMotionOn<G, S>* p,
                                const SurroundingsOn<G, S>& around, S* out) {
  if (is_seen_as_point(body)) {
    typename G::template Translation<S> a = -G::turned_back(p[0].H, around.gravity);
    if (around.has_inertia) a += G::linear(p[0].a);
    typename G::template Translation<S> f = body.mass(0, 0) * a;
    if (around.has_inertia && G::turns) f += G::spin(p[0].v, body.mass(0, 0) * G::linear(p[0].v));
    return G::put_force(f, out);
  }
  if (!around.has_inertia) {
    const typename G::template Translation<S> lift = -G::turned_back(p[0].H, around.gravity);
    return G::put(G::matrix_times(body.mass, lift), out);
  }
  const auto v = G::motion(p[0].v);
  const auto f = G::matrix_times(body.mass, eval_weighed_acceleration(p[0], around));
  G::put(G::subtract_dual_bracket(f, v, G::matrix_times(body.mass, v)), out);
}

/// Force and moment at a port, dead (inertial axes) or following the port; times a law.
template <class G, class C = double>
struct PointLoadOn {
  using Group = G;
  static constexpr int num_ports = 1;
  static constexpr int num_multipliers = 0;
  PortOn<G, C> ports[1];
  typename G::template Vector<C> wrench;  ///< (force [N]; moment [N m])
  bool follows = false;
  int law = 0;

  static constexpr Role role = Role::load;
  static constexpr Cost cost = small_cost;
  static constexpr bool has_stiffness_matrix = false, acts_along_line = false;
  static constexpr DataAxes data_axes = DataAxes::port;
  template <class A, class B, class Visit>
  static void visit_data(A& a, B& b, Visit& visit) {
    visit.flag(a.follows, b.follows);
    visit.wrench(a.wrench, b.wrench, a.follows);
    visit.law(a.law, b.law);
  }
};
template <class C>
using PointLoadOf = PointLoadOn<motion::Se3, C>;
using PointLoad = PointLoadOf<double>;

template <class G, class C>
bool looks_at_rates(const PointLoadOn<G, C>&) {
  return false;
}

template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const PointLoadOn<G, C>& load, const PortMotionOn<G, S>* p,
                                const SurroundingsOn<G, S>& around, S* out) {
  const Constant<S> factor = -around.laws[load.law];
  typename G::template Vector<S> f;
  for (int k = 0; k < G::dof; ++k) f[k] = S(factor * load.wrench[k]);
  if (load.follows)
    G::put(G::wrench(f), out);
  else
    G::put(G::wrench_turned_back(p[0].H, f), out);
}

/// Spring and damper along the line between two points:  tension = k (l - l0) + c l'.
template <class G, class C = double>
struct SpringOn {
  using Group = G;
  static constexpr int num_ports = 2;
  static constexpr int num_multipliers = 0;
  PortOn<G, C> ports[2];
  C stiffness = 0.0, rest_length = 0.0, damping = 0.0;

  static constexpr Role role = Role::coupling;
  static constexpr Cost cost = small_cost;
  static constexpr bool has_stiffness_matrix = false, acts_along_line = true;
  static constexpr DataAxes data_axes = DataAxes::none;
  template <class A, class B, class Visit>
  static void visit_data(A& a, B& b, Visit& visit) {
    visit.number(a.stiffness, b.stiffness);
    visit.number(a.rest_length, b.rest_length);
    visit.number(a.damping, b.damping);
  }
};
template <class C>
using SpringOf = SpringOn<motion::Se3, C>;
using Spring = SpringOf<double>;

template <class G, class C>
bool looks_at_rates(const SpringOn<G, C>& e) {
  return is_present(e.damping);
}

/// Kinematics and force of a spring: the unit vector n = (x_b - x_a) / l in inertial axes, the force along it, and the
/// derivative of the force by the length.
template <class G, class S>
struct SpringLine {
  typename G::template Translation<S> n;
  typename G::template Translation<S> w;  ///< relative velocity of the points; set if the spring has a damper
  S inverse;                              ///< 1/l
  S along;                                ///< l' = n . w; set if the spring has a damper
  S tension;
};
template <class G, class S, class C>
BOUGH_INLINE SpringLine<G, S> eval_spring_line(const SpringOn<G, C>& spring, const PortMotionOn<G, S>* p, bool damps) {
  SpringLine<G, S> line;
  const typename G::template Translation<S> r = p[1].H.x - p[0].H.x;
  const S length = lanes::length_of(r);
  line.inverse = S(1.0) / length;
  line.n = line.inverse * r;
  line.tension = spring.stiffness * (length - spring.rest_length);
  if (damps) {
    line.w = G::turned(p[1].H, G::linear(p[1].v)) - G::turned(p[0].H, G::linear(p[0].v));
    line.along = lanes::dot(line.n, line.w);
    line.tension = line.tension + spring.damping * line.along;
  }
  return line;
}

template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const SpringOn<G, C>& spring, const PortMotionOn<G, S>* p,
                                const SurroundingsOn<G, S>& around, S* out) {
  const auto line = eval_spring_line<G, S, C>(spring, p, around.has_inertia && is_present(spring.damping));
  const typename G::template Translation<S> f = line.tension * line.n;
  G::put_force(G::turned_back(p[0].H, -f), out);
  G::put_force(G::turned_back(p[1].H, f), out + G::dof);
}

template <class G, class S, class C>
S eval_strain_energy(const SpringOn<G, C>& spring, const PortMotionOn<G, S>* p) {
  const typename G::template Translation<S> r = p[1].H.x - p[0].H.x;
  const S stretch = lanes::length_of(r) - spring.rest_length;
  return 0.5 * spring.stiffness * stretch * stretch;
}

/// Elastic and viscous coupling of all relative motions of two frames:  d = log(H_a^-1 H_b),
///   F_b = T(d)^-T (k K (d - d0) + D d'),  F_a = -Ad(H_ab^-1)^T F_b,
/// with a factor k of the stiffness alone [-]: the value of a law, or 1. With k = 1 it is equivalent to a two-node beam
/// of length 1 without mass.
template <class G, class C = double>
struct BushingOn {
  using Group = G;
  static constexpr int num_ports = 2;
  static constexpr int num_multipliers = 0;
  PortOn<G, C> ports[2];
  typename G::template Matrix<C> stiffness, damping;
  typename G::template Vector<C> rest = G::template Vector<C>::zero();
  bool has_damping = false;
  int factor = -1;  ///< the law that is k; -1: k = 1

  static constexpr Role role = Role::coupling;
  static constexpr Cost cost{240e-9, 870e-9, 33e-9, 184e-9};
  static constexpr bool has_stiffness_matrix = true, acts_along_line = false;
  static constexpr DataAxes data_axes = DataAxes::port;
  template <class A, class B, class Visit>
  static void visit_data(A& a, B& b, Visit& visit) {
    visit.flag(a.has_damping, b.has_damping);
    visit.matrix(a.stiffness, b.stiffness);
    visit.matrix(a.damping, b.damping);
    visit.vector(a.rest, b.rest);
    visit.law(a.factor, b.factor);
  }
};
template <class G, class C>
inline constexpr bool exists<BushingOn<G, C>> = G::turns;
template <class C>
using BushingOf = BushingOn<motion::Se3, C>;
using Bushing = BushingOf<double>;

template <class G, class C>
bool looks_at_rates(const BushingOn<G, C>& e) {
  return e.has_damping;
}
template <class G, class C>
int stiffness_law(const BushingOn<G, C>& e) {
  return e.factor;
}
template <class G, class C>
bool exchanges_energy(const BushingOn<G, C>& e) {
  return dissipates(e) || e.factor >= 0;
}

/// The force conjugate to d,  n = k K (d - d0) + D d'.
template <class G, class S, class C>
BOUGH_INLINE typename G::template Wrench<S> eval_resultant(const BushingOn<G, C>& e, const ScrewRates<G, S>& r,
                                                           const SurroundingsOn<G, S>& around, bool viscous) {
  auto n = G::matrix_times(e.stiffness, G::strain(C(1.0), r.inverse.d, e.rest));
  if (e.factor >= 0) n = G::scaled(around.laws[e.factor], n);
  if (viscous) n = G::add(n, C(1.0), G::matrix_times(e.damping, r.rate));
  return n;
}

/// Wrenches F_b = T(d)^-T n and F_a = ad(d)^T n - F_b of a coupling with the force n conjugate to d; returns F_b.
template <class G, class S>
BOUGH_INLINE typename G::template Wrench<S> put_screw_wrenches(const ScrewRates<G, S>& r,
                                                               const typename G::template Wrench<S>& n, S* out) {
  const auto sum = G::dual_bracket(r.inverse.d, n);
  const auto second = G::add_dual_bracket(G::add(n, 0.5, sum), r.inverse.d, G::times(r.inverse.q, sum));
  G::put(second, out + G::dof);
  G::put(sum - second, out);
  return second;
}

template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const BushingOn<G, C>& bushing, const PortMotionOn<G, S>* p,
                                const SurroundingsOn<G, S>& around, S* out) {
  const bool viscous = around.has_inertia && bushing.has_damping;
  ScrewRates<G, S> r;
  eval_screw_rates<G, S>(p, around, false, viscous, r);
  const auto n = eval_resultant<G, S>(bushing, r, around, viscous);
  put_screw_wrenches<G, S>(r, n, out);
}

/// Strain energy at k = 1: its derivative by k [J].
template <class G, class S, class C>
S eval_energy_by_factor(const BushingOn<G, C>& bushing, const PortMotionOn<G, S>* p) {
  const auto inverse = motion::eval_log<G, S>(G::relative(p[0].H, p[1].H));
  typename G::template Vector<S> d = G::vector_of_motion(inverse.d);
  for (int k = 0; k < G::dof; ++k) d[k] = d[k] - bushing.rest[k];
  const typename G::template Vector<S> n = bushing.stiffness * d;
  return 0.5 * lanes::dot(d, n);
}
/// laws: values of all laws, used where one is the factor.
template <class G, class S, class C>
S eval_strain_energy(const BushingOn<G, C>& bushing, const PortMotionOn<G, S>* p, const Constant<S>* laws) {
  const S energy = eval_energy_by_factor(bushing, p);
  return bushing.factor < 0 ? energy : S(laws[bushing.factor] * energy);
}

}  // namespace bough::elements
