#pragma once
/// Scalar coordinates of the relative pose H = H_a^-1 H_b of a second frame in a first: what the rows of joints hold,
/// drives prescribe, springs of joints resist and sensors measure. A kind of row is its traits, its value with the
/// gradient, and the slope of the gradient; all three stand here, for every group. All functions are pure.
#include <cstdint>

#include "bough/motion/group.hpp"

namespace bough::motion {

enum class RowKind : std::uint8_t {
  along,     ///< u_i: displacement along axis i of the first frame
  across,    ///< e_i . R e_j: cosine between axis i of the first frame and axis j of the second
  angle,     ///< theta: rotation about axis 3, turns counted
  screw,     ///< u_3 - pitch theta
  distance,  ///< |x| - length: distance of the second frame's origin from the first's, which may not be 0
};

/// What else the library asks of a kind of row. In texts {i} and {j} stand for the numbers of the axes.
struct RowTraits {
  bool is_length;  ///< a length [m]; otherwise an angle [rad] or a cosine
  bool has_angle;  ///< depends on theta, whose turns are counted
  /// Depends on the origins of both frames alone, and not on their axes. A joint holds such a coordinate at its initial
  /// value, unless a drive prescribes it, and its frames do not coincide.
  bool is_between_points;
  const char* about;
  const char* equation;  ///< what is 0
};
inline constexpr RowTraits row_traits[] = {
    {true, false, false, "along {i}", "u{i}"},
    {false, false, false, "axis {i} of the first normal to axis {j} of the second", "e{i}.R e{j}"},
    {false, true, false, "angle about 3", "theta"},
    {true, true, false, "screw along 3", "u3 - pitch theta / (2 pi)"},
    {true, false, true, "distance", "|x| - length"},
};
constexpr const RowTraits& traits_of(RowKind kind) { return row_traits[static_cast<int>(kind)]; }

/// Whether rows together act between points of both parts, and depend on the axes of neither: coordinates between
/// points, or all three displacements.
template <class Rows>
bool joins_points(const Rows& rows) {
  int along = 0;
  for (const auto& row : rows) {
    along += row.kind == RowKind::along ? 1 : 0;
    if (row.kind != RowKind::along && !traits_of(row.kind).is_between_points) return false;
  }
  return along == 0 || along == 3;
}

/// theta = turns + atan2(s', c'), (c', s') the rotation about axis 3 seen from the last accepted angle: smooth over
/// any number of turns. turn: (c, s) of the rotation, times any positive factor.
template <class G, class S, class C>
BOUGH_INLINE S eval_axial_angle(const lanes::Vec<S, 2>& turn, const C& turns) {
  using std::cos;
  using std::sin;
  const C c0 = cos(turns), s0 = sin(turns);
  return G::angle_of_turn(S(c0 * turn[0] + s0 * turn[1]), S(c0 * turn[1] - s0 * turn[0])) + turns;
}
template <class S, class C>
S eval_angle(const Mat3<S>& R, const C& turns) {
  return eval_axial_angle<Se3>(lanes::Vec<S, 2>{{R(0, 0) + R(1, 1), R(1, 0) - R(0, 1)}}, turns);
}
/// Gradient of the angle by the rotation's right increment.
template <class S>
Vec3<S> angle_gradient(const Mat3<S>& R) {
  return Se3::axial_moment(Frame<S>{R, {}}, Se3::Direction<S>{});
}

/// |x| - length; its gradient is the force R^T n, n = x / |x|.
template <class G, class S, class C>
BOUGH_INLINE S eval_distance(const C& length, const typename G::template Pose<S>& H,
                             typename G::template Wrench<S>& gradient) {
  const S distance = lanes::length_of(H.x);
  gradient = G::force(G::turned_back(H, typename G::template Translation<S>((S(1.0) / distance) * H.x)));
  return distance - length;
}
/// The same as eval_coordinate below, of a kind that measures rotations.
template <class G, class S, class C>
BOUGH_INLINE S eval_turning_coordinate(RowKind kind, const typename G::template Direction<C>& direction,
                                       const C& constant, const typename G::template Pose<S>& H, const C& turns,
                                       typename G::template Wrench<S>& gradient) {
  if (kind == RowKind::across) {
    const auto s = G::seen(H, direction);
    gradient = G::moment(G::cosine_moment(direction, s));
    return G::cosine(direction, s);
  }
  const S angle = eval_axial_angle<G>(G::axial_turn(H, direction), turns);
  const auto moment = G::axial_moment(H, direction);
  if (kind == RowKind::angle) {
    gradient = G::moment(moment);
    return angle;
  }
  const S minus_pitch = S(-constant);
  const auto axis = G::template Direction<C>::axial();
  gradient = G::force_moment(G::seen(H, axis), minus_pitch * moment);
  return G::component(H, axis) + minus_pitch * angle;
}
/// Value of a coordinate and its gradient, a wrench in the axes of the second frame. Where nothing turns, all
/// coordinates but distances are displacements. constant: pitch of a screw [m/rad], length [m].
template <class G, class S, class C>
BOUGH_INLINE S eval_coordinate(RowKind kind, const typename G::template Direction<C>& direction, const C& constant,
                               const typename G::template Pose<S>& H, const C& turns,
                               typename G::template Wrench<S>& gradient) {
  if (kind != RowKind::along) {
    if (kind == RowKind::distance) return eval_distance<G, S, C>(constant, H, gradient);
    if constexpr (G::turns) return eval_turning_coordinate<G, S, C>(kind, direction, constant, H, turns, gradient);
  }
  gradient = G::force(G::seen(H, direction));
  return G::component(H, direction);
}
/// Derivatives of the gradient of a coordinate, its force and its moment, by the rotation; and of its force by the
/// displacement of the second frame, lateral (I - force force^T), of a coordinate between points.
template <class G, class S>
struct GradientSlope {
  bool has_force = false, has_moment = false, has_lateral = false;
  typename G::template TurnSlope<S> force, moment;
  S lateral = S(0.0);
};
template <class G, class S, class C>
GradientSlope<G, S> eval_gradient_slope(RowKind kind, const typename G::template Direction<C>& direction,
                                        const C& constant, const typename G::template Pose<S>& H) {
  GradientSlope<G, S> r;
  if (kind == RowKind::distance) {
    r.has_lateral = true;
    r.lateral = S(1.0) / lanes::length_of(H.x);
  }
  if constexpr (G::turns) {  // otherwise displacements have constant gradients
    if (kind == RowKind::distance) {
      r.has_force = true;
      r.force = G::seen_slope(G::turned_back(H, typename G::template Translation<S>(r.lateral * H.x)));
    }
    if (kind == RowKind::along || kind == RowKind::screw) {
      r.has_force = true;
      r.force = G::seen_slope(G::seen(H, kind == RowKind::along ? direction : G::template Direction<C>::axial()));
    }
    if (kind == RowKind::across) {
      r.has_moment = true;
      r.moment = G::cosine_slope(direction, G::seen(H, direction));
    }
    if (kind == RowKind::angle || kind == RowKind::screw) {
      r.has_moment = true;
      r.moment = G::axial_slope(H, direction);
      if (kind == RowKind::screw) r.moment = S(-constant) * r.moment;
    }
  }
  return r;
}

}  // namespace bough::motion
