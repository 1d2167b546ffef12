#pragma once
/// Poses beyond which the formulation of an element does not hold, and what a joint remembers of accepted poses.
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "bough/elements/evaluate.hpp"

namespace bough::elements {

using motion::Vec2;

/// Cosine of the angle between the ends of a beam below which the beam is folded.
inline constexpr double folded_cosine = -0.95;

/// Rotation of port `port` relative to the first port: a matrix in space, (cos, sin) in a plane.
template <class E>
Mat3<double> eval_relative_rotation(const E& e, int port, const Field& f) {
  return lanes::transpose_times(eval_port_rotation(e.ports[0], f), eval_port_rotation(e.ports[port], f));
}
template <class E>
Vec2<double> eval_relative_rotation(const E& e, int port, const FieldOn<motion::Se2, double>& f) {
  return motion::conjugate_times(eval_port_rotation(e.ports[0], f), eval_port_rotation(e.ports[port], f));
}
/// Cosine of the angle of a rotation: (trace(R) - 1) / 2.
inline double cosine_of(const Mat3<double>& R) { return 0.5 * (R(0, 0) + R(1, 1) + R(2, 2) - 1.0); }
inline double cosine_of(const Vec2<double>& turn) { return turn[0]; }

/// How far an element is from the limits of its shape: the least cos(angle) - cos(limit) of its angles that have a
/// limit; negative: past it. Since |d cos(a)/da| <= 1, the angle is at least as far from the limit, in rad. Limits: a
/// beam turns by nearly half a turn over its length, where the logarithm of (1) in beams.md is not unique; a joint
/// goes to its opposite pose, which satisfies the same constraints. Infinite: the element has none.
template <class E, class F>
double eval_shape_margin(const E&, const F&) {
  return std::numeric_limits<double>::infinity();
}
template <class G, int N>
double eval_shape_margin(const BeamOn<G, N>& e, const FieldOn<G, double>& f) {
  double cosine = 1.0;
  for (int i = 1; i < N; ++i) cosine = std::min(cosine, cosine_of(eval_relative_rotation(e, i, f)));
  return cosine - folded_cosine;
}
inline double eval_shape_margin(const Joint& e, const Field& f) {
  double margin = std::numeric_limits<double>::infinity();
  for (int k = 0; k < e.num_rows; ++k) {
    if (e.rows[k].kind != RowKind::across) continue;
    const bool aligns = aligns_all_axes(e, k);
    if (!aligns && e.rows[k].j != 2) continue;
    const Mat3<double> R = eval_relative_rotation(e, 1, f);
    margin = std::min(margin, R(2, 2));
    if (aligns) return std::min({margin, R(0, 0), R(1, 1)});
  }
  return margin;
}
inline double eval_shape_margin(const JointOn<motion::Se2>& e, const FieldOn<motion::Se2, double>& f) {
  return e.has_branch ? cosine_of(eval_relative_rotation(e, 1, f)) : std::numeric_limits<double>::infinity();
}

/// Angle of a joint about its axis 3 [rad], on the branch nearest to `turns`, the angle at the last accepted step.
inline double eval_joint_angle(const Joint& e, const Field& f, double turns) {
  return motion::eval_angle(eval_relative_rotation(e, 1, f), turns);
}
template <class G>
requires(!G::turns) double eval_joint_angle(const JointOn<G>&, const FieldOn<G, double>&, double turns) {
  return turns;
}
inline double eval_joint_angle(const JointOn<motion::Se2>& e, const FieldOn<motion::Se2, double>& f, double turns) {
  constexpr double whole = 6.283185307179586476925;
  if (e.axis_sign == 0) return turns;
  const Vec2<double> turn = eval_relative_rotation(e, 1, f);
  const double angle = e.axis_sign * motion::angle_of(turn[0], turn[1]);
  return angle + whole * std::round((turns - angle) / whole);
}

}  // namespace bough::elements
