#pragma once
/// Relative motion of two frames k and l [1.42-1.49]. Pure, no allocation, no failure. Seen from frame k it is
/// relative(H_k, H_l) of se3.hpp: C* = C_k^-1 C_l, R* = R_k^T R_l, u* = R_k^T (u_l - u_k) [1.48-1.49].
#include "bough/motion/half_angle.hpp"

namespace bough::motion {

/// The motion that takes k to l, in the inertial frame: C = C_l C_k^-1 [1.42], R = R_l R_k^T [1.43],
///   u_O = u - (R - I) u_k,  u = u_l - u_k [1.44-1.45].
/// H = H_l H_k^-1 moves the body; u_O is the displacement of its point at the inertial origin. R - I is formed without
/// cancellation: for an exact R the error of u_O is round-off of |u| + 2 sin(phi/2) |u_k|, so small rotations of frames
/// far from the origin lose no digits. The rounding of R itself still causes an error of epsilon |u_k|.
template <class S>
Frame<S> relative_in_inertial(const Frame<S>& k, const Frame<S>& l) {
  const Mat3<S> R = l.R * transpose(k.R);
  return {R, l.x - k.x - rotation_change(normalise(quaternion_of(R)), k.x)};
}

}  // namespace bough::motion
