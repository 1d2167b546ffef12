#pragma once
/// Rotations SO(3): exponential, logarithm and tangent operators, accurate to round-off from phi = 1e-16 to beyond pi.
/// psi = phi n [rad] is the rotation vector. Every function is pure, does not allocate and cannot fail.
#include "bough/motion/quaternion.hpp"
#include "bough/motion/skew_series.hpp"

namespace bough::motion {

/// R = exp(~psi) = I + a ~psi + b ~psi ~psi, any angle.
template <class S>
Mat3<S> exp_so3(const Vec3<S>& psi) {
  const lanes::Vec<S, 8> c = eval_stumpff(dot(psi, psi));
  return series_matrix(SkewSeries<S>{c[1], c[2], S(0.0), S(0.0), S(0.0), S(0.0)}, psi);
}
/// psi with exp(~psi) = R and |psi| <= pi; at exactly pi one of the two. Errors of R off the group are not amplified.
/// The function is analytic in R except at phi = pi, so derivative types are valid at phi = 0.
template <class S>
Vec3<S> log_so3(const Mat3<S>& R) {
  return log_quaternion(quaternion_direction(R));
}
/// T(psi): exp(psi)^-1 D exp(psi)[delta] = (T(psi) delta)~.
template <class S>
Mat3<S> tangent_so3(const Vec3<S>& psi) {
  return series_matrix(tangent_series(dot(psi, psi)), psi);
}
/// T(psi)^-1; |psi| != 2 pi, 4 pi, ...
template <class S>
Mat3<S> inverse_tangent_so3(const Vec3<S>& psi) {
  return series_matrix(inverse_tangent_series(dot(psi, psi)), psi);
}
/// T(psi) a, T(psi)^-1 a, T(psi)^T m, T(psi)^-T m without a matrix.
template <class S>
Vec3<S> tangent_so3_times(const Vec3<S>& psi, const Vec3<S>& a) {
  return series_times(tangent_series(dot(psi, psi)), psi, a);
}
template <class S>
Vec3<S> inverse_tangent_so3_times(const Vec3<S>& psi, const Vec3<S>& a) {
  return series_times(inverse_tangent_series(dot(psi, psi)), psi, a);
}
template <class S>
Vec3<S> tangent_so3_transpose_times(const Vec3<S>& psi, const Vec3<S>& m) {
  return series_times(transposed(tangent_series(dot(psi, psi))), psi, m);
}
template <class S>
Vec3<S> inverse_tangent_so3_transpose_times(const Vec3<S>& psi, const Vec3<S>& m) {
  return series_times(transposed(inverse_tangent_series(dot(psi, psi))), psi, m);
}

}  // namespace bough::motion
