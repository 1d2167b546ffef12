#pragma once
/// Forces of planar elements, wrenches (force; moment) in the ports' own axes that resist the motion: the formulas of README.md in the
/// plane, where all tangent operators are complex numbers.
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

template <class S, int N>
Vec3<S> blend(const double* w, const Vec3<S>* x) {
  constexpr int r = elements::Beam<N>::reference, first = r == 0 ? 1 : 0;
  Vec3<S> sum = w[first] * x[first];
  for (int i = first + 1; i < N; ++i)
    if (i != r) sum += w[i] * x[i];
  return sum;
}

/// F_i = T(d_i)^-T p_i,  F_r = sum - sum_i F_i.
template <class S, int N>
void eval_nodal_wrenches(const PlaneLog<S>* log, const Vec3<S>* p, Vec3<S> sum, Vec3<S>* out) {
  constexpr int r = elements::Beam<N>::reference;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    out[i] = log[i].inverse_transpose_times(p[i]);
    sum -= out[i];
  }
  out[r] = sum;
}

template <class S, int N>
void eval_logs(const PortMotion<S>* p, PlaneLog<S>* log, Vec3<S>* d) {
  constexpr int r = elements::Beam<N>::reference;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const Relative<S> H = relative(p[r], p[i]);
    log[i] = PlaneLog<S>(H.turn, H.x);
    d[i] = log[i].d;
  }
}

template <class S, int N, class C>
void eval_residual(const Beam<N, C>& e, const PortMotion<S>* port, const Surroundings<S>& around, Vec3<S>* out) {
  constexpr int r = elements::Beam<N>::reference;
  const bool moves = around.has_inertia && (e.has_mass || e.has_damping), viscous = around.has_inertia && e.has_damping;
  PlaneLog<S> log[N];
  Vec3<S> d[N], z[N], rate[N], zz[N], p[N];
  eval_logs<S, N>(port, log, d);
  if (moves)
    for (int i = 0; i < N; ++i) {
      if (i == r) continue;
      z[i] = log[i].inverse_times(port[i].v - port[r].v);
      rate[i] = z[i] + motion::plane_bracket(d[i], port[r].v);
    }

  const C inverse = 1.0 / e.length;
  if constexpr (N == 2) {
    Vec3<S> strain = inverse * d[1];
    for (int k = 0; k < 3; ++k) strain[k] = strain[k] - e.reference_strain[0][k];
    p[1] = e.stiffness * strain;
    if (viscous) p[1] += e.damping * Vec3<S>(inverse * rate[1]);
  } else {
    const auto& rule = strain_rule<N>();
    for (int i = 0; i < N; ++i) p[i] = Vec3<S>::zero();
    for (int g = 0; g < N - 1; ++g) {
      const PlaneMotion<S> T(blend<S, N>(rule.shape[g], d));
      const Vec3<S> y = blend<S, N>(rule.slope[g], d);
      Vec3<S> strain = inverse * T.times(y);
      for (int k = 0; k < 3; ++k) strain[k] = strain[k] - e.reference_strain[g][k];
      Vec3<S> n = e.stiffness * strain;
      if (viscous)
        n += e.damping * Vec3<S>(inverse * (T.times(blend<S, N>(rule.slope[g], rate)) +
                                            T.slope_times(blend<S, N>(rule.shape[g], rate), y)));
      const Vec3<S> by_slope = T.transpose_times(n), by_shape = T.slope_transpose_times(y, n);
      for (int i = 0; i < N; ++i)
        if (i != r)
          p[i] += (rule.weight[g] * rule.slope[g][i]) * by_slope + (rule.weight[g] * rule.shape[g][i]) * by_shape;
    }
  }
  Vec3<S> sum = Vec3<S>::zero();
  for (int i = 0; i < N; ++i)
    if (i != r) sum += motion::plane_bracket_transpose(d[i], p[i]);
  if (!e.has_mass) return eval_nodal_wrenches<S, N>(log, p, sum, out);

  const Vec3<S> b = weighed_acceleration(port[r], around);
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    Vec3<S> c = weighed_acceleration(port[i], around) - b;
    if (moves) c -= log[i].slope_times(rate[i], z[i]);
    zz[i] = log[i].inverse_times(c);
  }
  const auto& rule = mass_rule<N>();
  for (int g = 0; g < N; ++g) {
    const double* shape = rule.shape[g];
    const PlaneMotion<S> T(blend<S, N>(shape, d));
    Vec3<S> a = b + T.times(blend<S, N>(shape, zz));
    Vec3<S> f;
    if (moves) {
      const Vec3<S> zg = blend<S, N>(shape, z);
      const Vec3<S> v = port[r].v + T.times(zg);
      a += T.slope_times(blend<S, N>(shape, rate), zg);
      f = e.mass * a + gyroscopic(v, Vec3<S>(e.mass * v));
    } else {
      f = e.mass * a;
    }
    const C weight = rule.weight[g] * e.length;
    f = weight * f;
    const Vec3<S> q = T.transpose_times(f);
    for (int i = 0; i < N; ++i)
      if (i != r) p[i] += shape[i] * q;
    sum += f;
  }
  eval_nodal_wrenches<S, N>(log, p, sum, out);
}

template <class S, int N, class C>
void eval_residual(const LineLoad<N, C>& e, const PortMotion<S>* port, const Surroundings<S>& around, Vec3<S>* out) {
  constexpr int r = elements::Beam<N>::reference;
  PlaneLog<S> log[N];
  Vec3<S> d[N], p[N], sum = Vec3<S>::zero();
  eval_logs<S, N>(port, log, d);
  for (int i = 0; i < N; ++i) p[i] = Vec3<S>::zero();
  for (int g = 0; g < N; ++g) {
    const double* shape = mass_rule<N>().shape[g];
    const PlaneMotion<S> T(blend<S, N>(shape, d));
    const Base<S> factor = -(mass_rule<N>().weight[g] * e.length * around.laws[e.law]);
    Vec3<S> f;
    for (int k = 0; k < 3; ++k) f[k] = S(factor * e.wrench[k]);
    if (!e.follows) {
      const S x = T.theta * T.theta;
      const lanes::Vec<S, 8> c = motion::eval_stumpff(x);
      const Vec2<S> turn = complex_times(port[r].turn, Vec2<S>{{c[0], T.theta * c[1]}});
      f = join(conjugate_times(turn, plane_part(f)), f[2]);
    }
    const Vec3<S> q = T.transpose_times(f);
    for (int i = 0; i < N; ++i)
      if (i != r) p[i] += shape[i] * q;
    sum += f;
  }
  eval_nodal_wrenches<S, N>(log, p, sum, out);
}

}  // namespace bough::elements::planar
