#pragma once
/// Kinematic constraints between two frames, each row a scalar function of the relative motion H = H_a^-1 H_b = (R, u) alone, with one
/// multiplier; and efforts (springs, dampers, torques) along the joint's free coordinates.
///   residual: F_b = G^T lambda + efforts,  F_a = -Ad(H^-1)^T F_b,  and the rows Phi(H, t) themselves.
/// G holds the rows' gradients with respect to the right increment zeta of the second frame: R <- R (1 + ~zeta_w), u <- u + R zeta_u.
#include "bough/elements/port.hpp"

namespace bough::elements {

enum class RowKind : std::uint8_t {
  along,   ///< u_i - law = 0: displacement along axis i of the first frame
  across,  ///< e_i . R e_j = 0: axis i of the first frame normal to axis j of the second
  angle,   ///< theta - law = 0: rotation about axis 3, turns counted
  screw,   ///< u_3 - pitch theta - law = 0
};

template <class C>
struct ConstraintRowOf {
  RowKind kind = RowKind::along;
  int i = 0, j = 0;
  int law = -1;   ///< -1: zero
  C pitch = 0.0;  ///< displacement per radian [m/rad] (screw)
};
using ConstraintRow = ConstraintRowOf<double>;

enum class Coordinate : std::uint8_t { angle, displacement };

template <class C>
struct EffortOf {
  Coordinate coordinate = Coordinate::angle;
  C stiffness = 0.0, rest = 0.0, damping = 0.0;
  int law = -1;  ///< effort on the second body along the axis; -1: none
};
using Effort = EffortOf<double>;

constexpr int max_rows = 6;
constexpr int max_efforts = 4;

/// A joint of `num_rows` rows, the first of the array. The angle at the last accepted step, from which the present one is unwrapped, belongs to
/// the state of a run and is handed to the kernel as `turns`.
template <class C>
struct JointOf {
  static constexpr int num_ports = 2;
  static constexpr int num_multipliers = max_rows;  ///< at most
  PortOf<C> ports[2];
  ConstraintRowOf<C> rows[max_rows];
  int num_rows = 0;
  EffortOf<C> efforts[max_efforts];
  int num_efforts = 0;
};
using Joint = JointOf<double>;

/// Whether an effort damps; else nothing looks at velocities.
template <class C>
bool is_damped(const JointOf<C>& joint) {
  bool damped = false;
  for (int k = 0; k < joint.num_efforts; ++k) damped = damped || is_present(joint.efforts[k].damping);
  return damped;
}

/// theta = turns + atan2(s', c'), (c', s') the rotation about axis 3 seen from the last accepted angle: smooth over any number of turns.
template <class S, class C>
S eval_angle(const Mat3<S>& R, const C& turns) {
  using lanes::atan2;  // of complex numbers, which lie in std
  using std::atan2;
  using std::cos;
  using std::sin;
  const C c0 = cos(turns), s0 = sin(turns);
  const S s = R(1, 0) - R(0, 1), c = R(0, 0) + R(1, 1);
  return atan2(S(c0 * s - s0 * c), S(c0 * c + s0 * s)) + turns;
}

/// Gradient of e_i . R e_j by the rotation increment: e_j x (R^T e_i).
template <class S>
Vec3<S> across_gradient(const Mat3<S>& R, int i, int j) {
  const Vec3<S> row{{R(i, 0), R(i, 1), R(i, 2)}};
  return lanes::cross(Vec3<S>::unit(j), row);
}

template <class S>
Vec3<S> angle_gradient(const Mat3<S>& R) {
  const S s = R(1, 0) - R(0, 1), c = R(0, 0) + R(1, 1);
  const S inverse = S(1.0) / (s * s + c * c);
  const Vec3<S> gs = across_gradient(R, 1, 0) - across_gradient(R, 0, 1);
  const Vec3<S> gc = across_gradient(R, 0, 0) + across_gradient(R, 1, 1);
  return (c * inverse) * gs - (s * inverse) * gc;
}

/// Value and gradient (linear; angular in the second frame) of one row.
template <class S, class C>
S eval_row(const ConstraintRowOf<C>& row, const Frame<S>& H, const C& turns, const S* laws, Vec6<S>& gradient) {
  const S target = row.law >= 0 ? laws[row.law] : S(0.0);
  const Vec3<S> none = Vec3<S>::zero();
  const auto along = [&H](int i) { return Vec3<S>{{H.R(i, 0), H.R(i, 1), H.R(i, 2)}}; };
  switch (row.kind) {
    case RowKind::along:
      gradient = lanes::join(along(row.i), none);
      return H.x[row.i] - target;
    case RowKind::across:
      gradient = lanes::join(none, across_gradient(H.R, row.i, row.j));
      return H.R(row.i, row.j);
    case RowKind::angle:
      gradient = lanes::join(none, angle_gradient(H.R));
      return eval_angle(H.R, turns) - target;
    case RowKind::screw:
      gradient = lanes::join(along(2), Vec3<S>(-row.pitch * angle_gradient(H.R)));
      return H.x[2] - row.pitch * eval_angle(H.R, turns) - target;
  }
  return S(0.0);
}

/// Coordinate of an effort and its gradient.
template <class S, class C>
S eval_coordinate(Coordinate coordinate, const Frame<S>& H, const C& turns, Vec6<S>& gradient) {
  ConstraintRowOf<C> row;
  row.kind = coordinate == Coordinate::angle ? RowKind::angle : RowKind::along;
  row.i = 2;
  return eval_row<S, C>(row, H, turns, nullptr, gradient);
}

/// Effort of the springs, dampers and drives without constraint along one coordinate, on the second body, against the motion. rate: of the
/// coordinate, nullptr where nothing damps it.
template <class S, class C>
S eval_effort(const EffortOf<C>& e, const S& coordinate, const S* rate, const S* laws) {
  S f = e.stiffness * (coordinate - e.rest);
  if (rate != nullptr) f = f + e.damping * *rate;
  if (e.law >= 0) f = f - laws[e.law];
  return f;
}

/// Adds the efforts along all free coordinates, as a wrench on the second port that resists the motion.
template <class S, class C>
void add_efforts(const JointOf<C>& joint, const Frame<S>& H, const PortMotion<S>* p, const Surroundings<S>& around,
                 const C& turns, Vec6<S>& f) {
  Vec6<S> gradient;
  for (int k = 0; k < joint.num_efforts; ++k) {
    const S value = eval_coordinate(joint.efforts[k].coordinate, H, turns, gradient);
    const bool damps = around.has_inertia && is_present(joint.efforts[k].damping);
    S rate(0.0);
    if (damps) rate = lanes::dot(gradient, p[1].v - motion::inverse_adjoint_times(H, p[0].v));
    f += eval_effort(joint.efforts[k], value, damps ? &rate : nullptr, around.laws) * gradient;
  }
}

template <class S, class C>
void eval_residual(const JointOf<C>& joint, const PortMotion<S>* p, const S* multipliers, const Surroundings<S>& around,
                   S* out, const C& turns) {
  const Frame<S> H = motion::relative(p[0].H, p[1].H);
  Vec6<S> f = Vec6<S>::zero(), gradient;
  for (int k = 0; k < joint.num_rows; ++k) {
    out[12 + k] = eval_row(joint.rows[k], H, turns, around.laws, gradient);
    f += multipliers[k] * gradient;
  }
  add_efforts(joint, H, p, around, turns, f);
  const Vec6<S> first = motion::inverse_adjoint_transpose_times(H, f);
  for (int k = 0; k < 6; ++k) {
    out[k] = -first[k];
    out[6 + k] = f[k];
  }
}

/// Strain energy of the efforts' springs [J].
template <class S, class C>
S eval_strain_energy(const JointOf<C>& joint, const PortMotion<S>* p, const C& turns) {
  const Frame<S> H = motion::relative(p[0].H, p[1].H);
  Vec6<S> gradient;
  S sum(0.0);
  for (int k = 0; k < joint.num_efforts; ++k) {
    const S stretch = eval_coordinate(joint.efforts[k].coordinate, H, turns, gradient) - joint.efforts[k].rest;
    sum = sum + 0.5 * joint.efforts[k].stiffness * stretch * stretch;
  }
  return sum;
}

}  // namespace bough::elements
