#pragma once
/// Velocities and differential motions of a rigid body, and the relations between the two. V = (v; omega), inertial
/// frame: v is the velocity of the body point now at the inertial origin. V* = C^-1 V, body frame: v* is that of the
/// frame's own origin. A variation dU or dU* relates to the parameters of a motion as V or V* does to time; it is not
/// the differential of any U [1.63-1.65]. Templates on the scalar; pure, no allocation, no failure. Units: [m/s],
/// [rad/s]; of variations [m], [rad].
#include "bough/motion/se3.hpp"

namespace bough::motion {

/// v_P = v + omega x s of the point at s from the point whose velocity is v [1.50].
template <class S>
Vec3<S> velocity_at(const Vec6<S>& V, const Vec3<S>& s) {
  return linear_part(V) + cross(angular_part(V), s);
}

/// V = (du/dt + u x omega; omega) of Cdot C^-1 = ~V [1.56-1.57], u = H.x; with du, dpsi for du/dt, omega it is
/// dU = (du + ~u dpsi; dpsi) of dC C^-1 = ~dU [1.63, 1.65].
template <class S>
Vec6<S> inertial_velocity(const Frame<S>& H, const Vec3<S>& u_rate, const Vec3<S>& omega) {
  return join(u_rate + cross(H.x, omega), omega);
}
/// V* = C^-1 V = (R^T du/dt; R^T omega) of C^-1 Cdot = ~V* [1.59-1.60], dU* likewise [1.64].
template <class S>
Vec6<S> body_velocity(const Frame<S>& H, const Vec3<S>& u_rate, const Vec3<S>& omega) {
  return join(transpose_times(H.R, u_rate), transpose_times(H.R, omega));
}

/// Cdot = ~V C [1.56], also the rates of the six Plücker vectors of a moving basis, its columns: dY/dt = ~V Y [1.67].
template <class S>
Mat6<S> motion_tensor_rate(const Frame<S>& H, const Vec6<S>& V) {
  return cross6(V) * adjoint(H);
}
/// d(C^-1)/dt = -C^-1 ~V [1.61].
template <class S>
Mat6<S> inverse_motion_tensor_rate(const Frame<S>& H, const Vec6<S>& V) {
  return S(-1.0) * (inverse_adjoint(H) * cross6(V));
}
/// V of ~V = Cdot C^-1 = sum_i (dY_i/dt) Y^i, the dual basis Y^i being the rows of C^-1 [1.56, 1.67]. Symmetric blocks
/// of Cdot C^-1, which no motion has, have no effect.
template <class S>
Vec6<S> velocity_of_basis(const Frame<S>& H, const Mat6<S>& C_rate) {
  const Mat6<S> M = C_rate * inverse_adjoint(H);
  const S half(0.5);
  const auto vector_of = [&](int row, int column) {
    return Vec3<S>{{half * (M(row + 2, column + 1) - M(row + 1, column + 2)),
                    half * (M(row, column + 2) - M(row + 2, column)),
                    half * (M(row + 1, column) - M(row, column + 1))}};
  };
  return join(vector_of(0, 3), half * (vector_of(0, 0) + vector_of(3, 3)));
}

/// Transitivity: dV = (dU)' - ~V dU [1.66a]; dU_rate = (dU)'. Equal to C (dU*)'.
template <class S>
Vec6<S> velocity_variation(const Vec6<S>& V, const Vec6<S>& dU, const Vec6<S>& dU_rate) {
  return dU_rate - cross6_times(V, dU);
}
/// dV* = (dU*)' + ~V* dU* [1.66b]. Equal to C^-1 (dU)'.
template <class S>
Vec6<S> body_velocity_variation(const Vec6<S>& V, const Vec6<S>& dU, const Vec6<S>& dU_rate) {
  return dU_rate + cross6_times(V, dU);
}

/// dq/dt = q (0; omega*)/2 of the unit quaternion of R, omega* in the body frame; keeps q.dq/dt = 0.
template <class S>
Quaternion<S> quaternion_rate(const Quaternion<S>& q, const Vec3<S>& body_omega) {
  const S half(0.5);
  return {-half * dot(q.v, body_omega), half * (q.w * body_omega + cross(q.v, body_omega))};
}
/// omega* = 2 (w dv/dt - dw/dt v - v x dv/dt), its inverse; a rate of the norm drops out.
template <class S>
Vec3<S> body_angular_velocity(const Quaternion<S>& q, const Quaternion<S>& rate) {
  const Vec3<S> r = q.w * rate.v - rate.w * q.v - cross(q.v, rate.v);
  return r + r;
}

}  // namespace bough::motion
