#pragma once
/// Forces of planar elements, wrenches (force; moment) in the ports' own axes that resist the motion: the formulas of README.md in the
/// plane, where all tangent operators are complex numbers. Those of beams and line loads are in src/elements/planar.
#include "bough/elements/planar/port.hpp"

namespace bough::elements::planar {

using motion::complex_times;
using motion::conjugate_times;
using motion::join;
using motion::plane_part;
using motion::quarter_turn;

template <class C>
using Mat3Of = Mat3<C>;

/// Section matrices 3x3 of (N, Q, M).
template <int N, class C = double>
struct Beam {
  static constexpr int num_ports = N, num_rows_at_most = 0;
  PortOf<C> ports[N];
  C length = 0.0;
  Mat3Of<C> stiffness, damping, mass;
  bool has_damping = false, has_mass = false;
  Vec3<C> reference_strain[N - 1];
};

template <int N, class C = double>
struct LineLoad {
  static constexpr int num_ports = N, num_rows_at_most = 0;
  PortOf<C> ports[N];
  C length = 0.0;
  Vec3<C> wrench;
  bool follows = false;
  int law = 0;
};

template <class C>
struct RigidBodyOf {
  static constexpr int num_ports = 1, num_rows_at_most = 0;
  PortOf<C> ports[1];
  Mat3Of<C> mass;
  bool is_point = false;  ///< as in space
};
using RigidBody = RigidBodyOf<double>;

template <class C>
struct PointLoadOf {
  static constexpr int num_ports = 1, num_rows_at_most = 0;
  PortOf<C> ports[1];
  Vec3<C> wrench;
  bool follows = false;
  int law = 0;
};
using PointLoad = PointLoadOf<double>;

template <class C>
struct SpringOf {
  static constexpr int num_ports = 2, num_rows_at_most = 0;
  PortOf<C> ports[2];
  C stiffness = 0.0, rest_length = 0.0, damping = 0.0;
};
using Spring = SpringOf<double>;

template <class C>
struct BushingOf {
  static constexpr int num_ports = 2, num_rows_at_most = 0;
  PortOf<C> ports[2];
  Mat3Of<C> stiffness, damping;
  Vec3<C> rest;
  bool has_damping = false;
};
using Bushing = BushingOf<double>;

/// Rows of a joint in the relative turn (c, s) and position x of its second frame in the first:
///   along   d . x - law = 0          across   d . (c, s) = 0          angle   sign theta - law = 0,  sign = d_1
template <class C>
struct RowOf {
  RowKind kind = RowKind::along;
  Vec2<C> d;
  int law = -1;
};
/// A force along d . x, or a moment about sign theta.
template <class C>
struct EffortOf {
  Coordinate coordinate = Coordinate::angle;
  Vec2<C> d;
  elements::EffortOf<C> effort;
};
template <class C>
struct JointOf {
  static constexpr int num_ports = 2, num_rows_at_most = max_rows;
  PortOf<C> ports[2];
  RowOf<C> rows[max_rows];
  int num_rows = 0;
  EffortOf<C> efforts[max_efforts];
  int num_efforts = 0;
};
using Joint = JointOf<double>;

/// a - (R^T g; 0)
template <class S>
Vec3<S> weighed_acceleration(const PortMotion<S>& p, const Surroundings<S>& around) {
  const Vec2<S> weight = conjugate_times(p.turn, around.gravity);
  if (!around.has_inertia) return join(Vec2<S>(-weight), S(0.0));
  return join(Vec2<S>(plane_part(p.a) - weight), p.a[2]);
}

/// -ad(v)^T m
template <class S>
Vec3<S> gyroscopic(const Vec3<S>& v, const Vec3<S>& m) {
  return join(Vec2<S>(v[2] * quarter_turn(plane_part(m))), S(v[0] * m[1] - v[1] * m[0]));
}

template <class S, class C>
void eval_residual(const RigidBodyOf<C>& e, const PortMotion<S>* p, const Surroundings<S>& around, Vec3<S>* out) {
  if (e.is_point) {
    Vec2<S> f = e.mass(0, 0) * motion::plane_part(weighed_acceleration(p[0], around));
    if (around.has_inertia) f += p[0].v[2] * motion::quarter_turn(Vec2<S>(e.mass(0, 0) * motion::plane_part(p[0].v)));
    out[0] = join(f, S(0.0));
    return;
  }
  Vec3<S> f = e.mass * weighed_acceleration(p[0], around);
  if (around.has_inertia) f += gyroscopic(p[0].v, Vec3<S>(e.mass * p[0].v));
  out[0] = f;
}

template <class S, class C>
void eval_residual(const PointLoadOf<C>& e, const PortMotion<S>* p, const Surroundings<S>& around, Vec3<S>* out) {
  Vec3<S> f;
  for (int k = 0; k < 3; ++k) f[k] = S(-around.laws[e.law] * e.wrench[k]);
  out[0] = e.follows ? f : join(conjugate_times(p[0].turn, plane_part(f)), f[2]);
}

template <class S, class C>
void eval_residual(const SpringOf<C>& e, const PortMotion<S>* p, const Surroundings<S>& around, Vec3<S>* out) {
  using std::sqrt;
  const Vec2<S> r = p[1].x - p[0].x;
  const S length = sqrt(lanes::dot(r, r));
  const Vec2<S> n = (S(1.0) / length) * r;
  S tension = e.stiffness * (length - e.rest_length);
  if (around.has_inertia && is_present(e.damping))
    tension = tension + e.damping * lanes::dot(n, Vec2<S>(complex_times(p[1].turn, plane_part(p[1].v)) -
                                                          complex_times(p[0].turn, plane_part(p[0].v))));
  out[0] = join(conjugate_times(p[0].turn, Vec2<S>(-tension * n)), S(0.0));
  out[1] = join(conjugate_times(p[1].turn, Vec2<S>(tension * n)), S(0.0));
}

template <class S, class C>
void eval_residual(const BushingOf<C>& e, const PortMotion<S>* p, const Surroundings<S>& around, Vec3<S>* out) {
  const Relative<S> H = relative(p[0], p[1]);
  const PlaneLog<S> log(H.turn, H.x);
  Vec3<S> stretch = log.d;
  for (int k = 0; k < 3; ++k) stretch[k] = stretch[k] - e.rest[k];
  Vec3<S> n = e.stiffness * stretch;
  if (around.has_inertia && e.has_damping) n += e.damping * log.inverse_times(p[1].v - seen_from(H.turn, H.x, p[0].v));
  out[1] = log.inverse_transpose_times(n);
  out[0] = -carried_back(H.turn, H.x, out[1]);
}

/// Value of a row and its gradient by the right increment of the second frame.
template <class S, class C>
S eval_coordinate(RowKind kind, const Vec2<C>& d, const Relative<S>& H, const C& turns, Vec3<S>& gradient) {
  using std::cos;
  using std::sin;
  const Vec2<S> direction{{S(d[0]), S(d[1])}};
  if (kind == RowKind::along) {
    gradient = join(conjugate_times(H.turn, direction), S(0.0));
    return lanes::dot(direction, H.x);
  }
  if (kind == RowKind::across) {
    gradient = join(Vec2<S>::zero(), lanes::dot(direction, quarter_turn(H.turn)));
    return lanes::dot(direction, H.turn);
  }
  gradient = join(Vec2<S>::zero(), direction[0]);
  // turns + the angle seen from the last accepted one
  const Vec2<C> before{{C(cos(turns)), C(sin(turns))}};
  const Vec2<S> about{{H.turn[0], direction[0] * H.turn[1]}};
  const Vec2<S> since = conjugate_times(before, about);
  return motion::angle_of(since[0], since[1]) + turns;
}

/// Residuals of the two ports, values and gradients of the rows.
template <class S, class C>
void eval_joint(const JointOf<C>& e, const PortMotion<S>* p, const Base<S>* multipliers, const Surroundings<S>& around,
                const C& turns, Vec3<S>* out, S* rows) {
  const Relative<S> H = relative(p[0], p[1]);
  Vec3<S> f = Vec3<S>::zero(), gradient;
  for (int k = 0; k < e.num_rows; ++k) {
    rows[k] = eval_coordinate(e.rows[k].kind, e.rows[k].d, H, turns, gradient);
    if (e.rows[k].law >= 0) rows[k] = rows[k] - around.laws[e.rows[k].law];
    f += multipliers[k] * gradient;
  }
  for (int k = 0; k < e.num_efforts; ++k) {
    const RowKind kind = e.efforts[k].coordinate == Coordinate::angle ? RowKind::angle : RowKind::along;
    const S value = eval_coordinate(kind, e.efforts[k].d, H, turns, gradient);
    const elements::EffortOf<C>& effort = e.efforts[k].effort;
    S size = effort.stiffness * (value - effort.rest);
    if (around.has_inertia && is_present(effort.damping))
      size = size + effort.damping * lanes::dot(gradient, Vec3<S>(p[1].v - seen_from(H.turn, H.x, p[0].v)));
    if (effort.law >= 0) size = size - around.laws[effort.law];
    f += size * gradient;
  }
  out[1] = f;
  out[0] = -carried_back(H.turn, H.x, f);
}

}  // namespace bough::elements::planar
