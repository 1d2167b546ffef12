#pragma once
/// Rigid body, point loads, springs and bushings: elements of one or two ports without multipliers.
#include "bough/elements/port.hpp"

namespace bough::elements {

/// Rigid body about its node's frame.  F = M (a - (R^T g; 0)) - ad(v)^T M v,  M the 6x6 mass about the node [kg, kg m, kg m^2].
/// A point at the node's origin, M = m (1, 0; 0, 0), v = (u; w), bears no moment:  f = m (u' - R^T g) - (m u) x w.
template <class C>
struct RigidBodyOf {
  static constexpr int num_ports = 1;
  static constexpr int num_multipliers = 0;
  PortOf<C> ports[1];
  Mat6<C> mass;
  bool is_point = false;  ///< mass holds m alone: products with its zeros are left out
};
using RigidBody = RigidBodyOf<double>;

template <class S, class C>
bool is_seen_as_point(const RigidBodyOf<C>& body, const Surroundings<S>& around) {
  return body.is_point || !around.nodes_turn;
}

/// 6x6 mass about the frame's origin, from the mass, its centre and the inertia about the centre, in the frame's axes.
Mat6<double> make_mass_matrix(double mass, const Vec3<double>& center, const Mat3<double>& inertia);

template <class S, class C>
void eval_residual(const RigidBodyOf<C>& body, const PortMotion<S>* p, const S*, const Surroundings<S>& around,
                   S* out) {
  const Vec3<S> weight = lanes::transpose_times(p[0].H.R, around.gravity);
  if (is_seen_as_point(body, around)) {
    Vec3<S> a = -weight;
    if (around.has_inertia) a += lanes::linear_part(p[0].a);
    Vec3<S> f = body.mass(0, 0) * a;
    if (around.has_inertia && around.nodes_turn)
      f -= lanes::cross(Vec3<S>(body.mass(0, 0) * lanes::linear_part(p[0].v)), lanes::angular_part(p[0].v));
    for (int k = 0; k < 3; ++k) {
      out[k] = f[k];
      out[3 + k] = S(0.0);
    }
    return;
  }
  Vec6<S> a = lanes::join<S>(-weight, Vec3<S>::zero());
  if (around.has_inertia) a += p[0].a;
  Vec6<S> f = body.mass * a;
  if (around.has_inertia) f -= motion::cross6_transpose_times(p[0].v, Vec6<S>(body.mass * p[0].v));
  for (int k = 0; k < 6; ++k) out[k] = f[k];
}

template <class S, class C>
S eval_kinetic_energy(const RigidBodyOf<C>& body, const PortMotion<S>* p) {
  return 0.5 * lanes::dot(p[0].v, Vec6<S>(body.mass * p[0].v));
}

/// Force and moment at a port, dead (inertial axes) or following the port; times a law.
template <class C>
struct PointLoadOf {
  static constexpr int num_ports = 1;
  static constexpr int num_multipliers = 0;
  PortOf<C> ports[1];
  Vec6<C> wrench;  ///< (force [N]; moment [N m])
  bool follows = false;
  int law = 0;
};
using PointLoad = PointLoadOf<double>;

template <class S, class C>
void eval_residual(const PointLoadOf<C>& load, const PortMotion<S>* p, const S*, const Surroundings<S>& around,
                   S* out) {
  const S factor = -around.laws[load.law];
  Vec6<S> f;
  for (int k = 0; k < 6; ++k) f[k] = factor * load.wrench[k];
  if (!load.follows)
    f = lanes::join<S>(lanes::transpose_times(p[0].H.R, lanes::linear_part(f)),
                       lanes::transpose_times(p[0].H.R, lanes::angular_part(f)));
  for (int k = 0; k < 6; ++k) out[k] = f[k];
}

/// Spring and damper along the line between two points:  tension = k (l - l0) + c l'.
template <class C>
struct SpringOf {
  static constexpr int num_ports = 2;
  static constexpr int num_multipliers = 0;
  PortOf<C> ports[2];
  C stiffness = 0.0, rest_length = 0.0, damping = 0.0;
};
using Spring = SpringOf<double>;

template <class S>
S eval_length(const PortMotion<S>* p) {
  using std::sqrt;
  const Vec3<S> r = p[1].H.x - p[0].H.x;
  return sqrt(lanes::dot(r, r));
}

template <class S, class C>
void eval_residual(const SpringOf<C>& spring, const PortMotion<S>* p, const S*, const Surroundings<S>& around, S* out) {
  const Vec3<S> r = p[1].H.x - p[0].H.x;
  const S length = eval_length(p);
  const Vec3<S> n = (S(1.0) / length) * r;
  S tension = spring.stiffness * (length - spring.rest_length);
  if (around.has_inertia && is_present(spring.damping)) {
    const Vec3<S> velocity = p[1].H.R * lanes::linear_part(p[1].v) - p[0].H.R * lanes::linear_part(p[0].v);
    tension = tension + spring.damping * lanes::dot(n, velocity);
  }
  const Vec3<S> at_first = lanes::transpose_times(p[0].H.R, Vec3<S>(-tension * n));
  const Vec3<S> at_second = lanes::transpose_times(p[1].H.R, Vec3<S>(tension * n));
  for (int k = 0; k < 3; ++k) {
    out[k] = at_first[k];
    out[6 + k] = at_second[k];
    out[3 + k] = out[9 + k] = S(0.0);
  }
}

template <class S, class C>
S eval_strain_energy(const SpringOf<C>& spring, const PortMotion<S>* p) {
  const S stretch = eval_length(p) - spring.rest_length;
  return 0.5 * spring.stiffness * stretch * stretch;
}

/// Elastic and viscous coupling of all relative motions of two frames:  d = log(H_a^-1 H_b),
///   F_b = T(d)^-T (K (d - d0) + D d'),  F_a = -Ad(H_ab^-1)^T F_b.
template <class C>
struct BushingOf {
  static constexpr int num_ports = 2;
  static constexpr int num_multipliers = 0;
  PortOf<C> ports[2];
  Mat6<C> stiffness, damping;
  Vec6<C> rest = Vec6<C>::zero();
  bool has_damping = false;
};
using Bushing = BushingOf<double>;

template <class S, class C>
void eval_residual(const BushingOf<C>& bushing, const PortMotion<S>* p, const S*, const Surroundings<S>& around,
                   S* out) {
  const Frame<S> relative = motion::relative(p[0].H, p[1].H);
  const Vec3<S> psi = motion::log_so3(relative.R);
  motion::MotionOperator<S> inverse{motion::inverse_tangent_series(lanes::dot(psi, psi)), {}};
  inverse.d = lanes::join(motion::series_times(motion::transposed(inverse.f), psi, relative.x), psi);
  Vec6<S> stretch = inverse.d;
  for (int k = 0; k < 6; ++k) stretch[k] = stretch[k] - bushing.rest[k];
  Vec6<S> n = bushing.stiffness * stretch;
  if (around.has_inertia && bushing.has_damping)
    n += bushing.damping * inverse.times(p[1].v - motion::inverse_adjoint_times(relative, p[0].v));
  const Vec6<S> second = inverse.transpose_times(n);
  const Vec6<S> first = motion::inverse_adjoint_transpose_times(relative, second);
  for (int k = 0; k < 6; ++k) {
    out[k] = -first[k];
    out[6 + k] = second[k];
  }
}

template <class S, class C>
S eval_strain_energy(const BushingOf<C>& bushing, const PortMotion<S>* p) {
  Vec6<S> d = motion::Se3::log(motion::relative(p[0].H, p[1].H));
  for (int k = 0; k < 6; ++k) d[k] = d[k] - bushing.rest[k];
  return 0.5 * lanes::dot(d, Vec6<S>(bushing.stiffness * d));
}

}  // namespace bough::elements
