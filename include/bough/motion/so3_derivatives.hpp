#pragma once
/// Derivatives on SO(3) in closed form, 3x3, row i and column j: d(.)_i/dpsi_j. They are regular at phi = 0; those of
/// T^-1 have its poles at |psi| = 2 pi, 4 pi, ... Derivatives on SE(3) are in se3.hpp, second derivatives in
/// operators.hpp.
/// Templates on the scalar; pure, no allocation, no failure.
#include "bough/motion/so3.hpp"

namespace bough::motion {

/// d(exp(psi) a)/dpsi = -R ~a T.
template <class S>
Mat3<S> rotation_derivative(const Vec3<S>& psi, const Vec3<S>& a) {
  const AngleCoefficients<S> c = eval_angle_coefficients(S(dot(psi, psi)));
  return series_jacobian(SkewSeries<S>{c.a, c.b, c.da, c.db, c.dda, c.ddb}, psi, a);
}
/// d(T(psi) a)/dpsi and d(T(psi)^T a)/dpsi.
template <class S>
Mat3<S> tangent_so3_derivative(const Vec3<S>& psi, const Vec3<S>& a) {
  return series_jacobian(tangent_series(S(dot(psi, psi))), psi, a);
}
template <class S>
Mat3<S> tangent_so3_transpose_derivative(const Vec3<S>& psi, const Vec3<S>& a) {
  return series_jacobian(transposed(tangent_series(S(dot(psi, psi)))), psi, a);
}
/// d(T(psi)^-1 a)/dpsi and d(T(psi)^-T a)/dpsi.
template <class S>
Mat3<S> inverse_tangent_so3_derivative(const Vec3<S>& psi, const Vec3<S>& a) {
  return series_jacobian(inverse_tangent_series(S(dot(psi, psi))), psi, a);
}
template <class S>
Mat3<S> inverse_tangent_so3_transpose_derivative(const Vec3<S>& psi, const Vec3<S>& a) {
  return series_jacobian(transposed(inverse_tangent_series(S(dot(psi, psi)))), psi, a);
}

}  // namespace bough::motion
