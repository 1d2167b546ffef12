#pragma once
/// Rigid body and point load: elements of one port without multipliers, on any group.
#include "bough/elements/beam_rates.hpp"

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
using RigidBody = RigidBodyOn<motion::Se3>;

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
using PointLoad = PointLoadOn<motion::Se3>;

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

}  // namespace bough::elements
