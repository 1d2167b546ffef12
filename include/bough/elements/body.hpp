#pragma once
/// Rigid body, point loads, springs and bushings: elements of one or two ports without multipliers.
#include "bough/elements/port.hpp"

namespace bough::elements {

/// Rigid body about its node's frame.  F = M (a - (R^T g; 0)) - ad(v)^T M v,  M the 6x6 mass about the node [kg, kg m, kg m^2].
struct RigidBody {
  static constexpr int num_ports = 1;
  static constexpr int num_multipliers = 0;
  Port ports[1];
  Mat6<double> mass;
};

/// 6x6 mass about the frame's origin, from the mass, its centre and the inertia about the centre, in the frame's axes.
Mat6<double> make_mass_matrix(double mass, const Vec3<double>& center, const Mat3<double>& inertia);

template <class S>
void eval_residual(const RigidBody& body, const PortMotion<S>* p, const S*, const Surroundings<S>& around, S* out) {
  const Vec3<S> weight = lanes::transpose_times(p[0].H.R, around.gravity);
  Vec6<S> a = lanes::join<S>(-weight, Vec3<S>::zero());
  if (around.has_inertia) a += p[0].a;
  Vec6<S> f = body.mass * a;
  if (around.has_inertia) f -= motion::cross6_transpose_times(p[0].v, Vec6<S>(body.mass * p[0].v));
  for (int k = 0; k < 6; ++k) out[k] = f[k];
}

template <class S>
S eval_kinetic_energy(const RigidBody& body, const PortMotion<S>* p) {
  return 0.5 * lanes::dot(p[0].v, Vec6<S>(body.mass * p[0].v));
}

/// Force and moment at a port, dead (inertial axes) or following the port; times a law.
struct PointLoad {
  static constexpr int num_ports = 1;
  static constexpr int num_multipliers = 0;
  Port ports[1];
  Vec6<double> wrench;  ///< (force [N]; moment [N m])
  bool follows = false;
  int law = 0;
};

template <class S>
void eval_residual(const PointLoad& load, const PortMotion<S>* p, const S*, const Surroundings<S>& around, S* out) {
  Vec6<S> f = (-around.laws[load.law]) * lanes::cast<S>(load.wrench);
  if (!load.follows)
    f = lanes::join<S>(lanes::transpose_times(p[0].H.R, lanes::linear_part(f)),
                       lanes::transpose_times(p[0].H.R, lanes::angular_part(f)));
  for (int k = 0; k < 6; ++k) out[k] = f[k];
}

/// Spring and damper along the line between two points:  tension = k (l - l0) + c l'.
struct Spring {
  static constexpr int num_ports = 2;
  static constexpr int num_multipliers = 0;
  Port ports[2];
  double stiffness = 0.0, rest_length = 0.0, damping = 0.0;
};

template <class S>
S eval_length(const PortMotion<S>* p) {
  using std::sqrt;
  const Vec3<S> r = p[1].H.x - p[0].H.x;
  return sqrt(lanes::dot(r, r));
}

template <class S>
void eval_residual(const Spring& spring, const PortMotion<S>* p, const S*, const Surroundings<S>& around, S* out) {
  const Vec3<S> r = p[1].H.x - p[0].H.x;
  const S length = eval_length(p);
  const Vec3<S> n = (S(1.0) / length) * r;
  S tension = spring.stiffness * (length - spring.rest_length);
  if (around.has_inertia && spring.damping != 0.0) {
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

template <class S>
S eval_strain_energy(const Spring& spring, const PortMotion<S>* p) {
  const S stretch = eval_length(p) - spring.rest_length;
  return 0.5 * spring.stiffness * stretch * stretch;
}

/// Elastic and viscous coupling of all relative motions of two frames:  d = log(H_a^-1 H_b),
///   F_b = T(d)^-T (K (d - d0) + D d'),  F_a = -Ad(H_ab^-1)^T F_b.
struct Bushing {
  static constexpr int num_ports = 2;
  static constexpr int num_multipliers = 0;
  Port ports[2];
  Mat6<double> stiffness, damping;
  Vec6<double> rest = Vec6<double>::zero();
  bool has_damping = false;
};

template <class S>
void eval_residual(const Bushing& bushing, const PortMotion<S>* p, const S*, const Surroundings<S>& around, S* out) {
  const Frame<S> relative = motion::relative(p[0].H, p[1].H);
  const Vec6<S> d = motion::Se3::log(relative);
  Vec6<S> stretch = d;
  for (int k = 0; k < 6; ++k) stretch[k] = stretch[k] - bushing.rest[k];
  Vec6<S> n = bushing.stiffness * stretch;
  if (around.has_inertia && bushing.has_damping)
    n += bushing.damping *
         motion::Se3::inverse_tangent_times(d, p[1].v - motion::inverse_adjoint_times(relative, p[0].v));
  const Vec6<S> second = motion::Se3::inverse_tangent_transpose_times(d, n);
  const Vec6<S> first = motion::inverse_adjoint_transpose_times(relative, second);
  for (int k = 0; k < 6; ++k) {
    out[k] = -first[k];
    out[6 + k] = second[k];
  }
}

template <class S>
S eval_strain_energy(const Bushing& bushing, const PortMotion<S>* p) {
  Vec6<S> d = motion::Se3::log(motion::relative(p[0].H, p[1].H));
  for (int k = 0; k < 6; ++k) d[k] = d[k] - bushing.rest[k];
  return 0.5 * lanes::dot(d, Vec6<S>(bushing.stiffness * d));
}

}  // namespace bough::elements
