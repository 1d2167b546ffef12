#pragma once
/// Unit quaternions, scalar first: q = (w; v) = (cos(phi/2); n sin(phi/2)); q and -q are the same rotation.
#include "bough/motion/coefficients.hpp"

namespace bough::motion {

template <class S>
struct Quaternion {
  S w;        ///< cos(phi/2)
  Vec3<S> v;  ///< n sin(phi/2)
  static Quaternion identity() { return {S(1.0), Vec3<S>::zero()}; }
};

/// Composition: rotation_of(multiply(p, q)) = rotation_of(p) rotation_of(q).
template <class S>
Quaternion<S> multiply(const Quaternion<S>& p, const Quaternion<S>& q) {
  return {p.w * q.w - dot(p.v, q.v), p.w * q.v + q.w * p.v + cross(p.v, q.v)};
}
/// The inverse of a unit quaternion.
template <class S>
Quaternion<S> conjugate(const Quaternion<S>& q) {
  return {q.w, -q.v};
}
/// q / |q|; q must not be zero.
template <class S>
Quaternion<S> normalise(const Quaternion<S>& q) {
  using std::sqrt;
  const S f = S(1.0) / sqrt(q.w * q.w + dot(q.v, q.v));
  return {f * q.w, f * q.v};
}
/// R = I + 2 w ~v + 2 ~v ~v of a unit quaternion.
template <class S>
Mat3<S> rotation_of(const Quaternion<S>& q) {
  using L = Literal<S>;
  const S x = q.v[0], y = q.v[1], z = q.v[2], w = q.w;
  return {{L(1) - L(2) * (y * y + z * z), L(2) * (x * y - w * z), L(2) * (x * z + w * y),  //
           L(2) * (x * y + w * z), L(1) - L(2) * (x * x + z * z), L(2) * (y * z - w * x),  //
           L(2) * (x * z - w * y), L(2) * (y * z + w * x), L(1) - L(2) * (x * x + y * y)}};
}
/// Quaternion of a rotation with w >= 0. The rows of 4 q q^T are linear in R; the row with the largest diagonal (always
/// >= 1) is taken, so nothing cancels and no square root is taken near zero, at any angle (Shepperd 1978).
/// The norm is 1 to the accuracy of R^T R = I.
template <class S>
Quaternion<S> quaternion_of(const Mat3<S>& R) {
  using L = Literal<S>;
  using std::sqrt;
  const S r0 = R(0, 0), r1 = R(1, 1), r2 = R(2, 2);
  const S e0 = R(2, 1) - R(1, 2), e1 = R(0, 2) - R(2, 0), e2 = R(1, 0) - R(0, 1);
  const S f0 = R(2, 1) + R(1, 2), f1 = R(0, 2) + R(2, 0), f2 = R(1, 0) + R(0, 1);
  S row[4] = {L(1) + r0 + r1 + r2, e0, e1, e2}, top = row[0];
  const S others[3][4] = {{e0, L(1) + r0 - r1 - r2, f2, f1},  //
                          {e1, f2, L(1) + r1 - r0 - r2, f0},
                          {e2, f1, f0, L(1) + r2 - r0 - r1}};
  for (int i = 0; i < 3; ++i) {
    const auto larger = less(top, others[i][i + 1]);
    top = select(larger, others[i][i + 1], top);
    for (int j = 0; j < 4; ++j) row[j] = select(larger, others[i][j], row[j]);
  }
  const S scale = L(0.5) / sqrt(top);
  const S sign = select(less(row[0], S(0.0)), -scale, scale);
  return {sign * row[0], {{sign * row[1], sign * row[2], sign * row[3]}}};
}
/// Quaternion of the rotation vector psi = phi n [rad], any angle.
template <class S>
Quaternion<S> exp_quaternion(const Vec3<S>& psi) {
  using L = Literal<S>;
  const lanes::Vec<S, 8> c = eval_stumpff(S(L(0.25) * dot(psi, psi)));
  return {c[0], L(0.5) * c[1] * psi};
}
/// Rotation vector of q with w >= 0, |psi| <= pi [rad]: psi = 2 v atan(t)/(t w), t = |v|/w. The norm of q drops out.
/// Near t = 0 a series in t^2, elsewhere atan2(|v|, w), which is as accurate at phi = pi as at 1.
template <class S>
Vec3<S> log_quaternion(const Quaternion<S>& q) {
  using L = Literal<S>;
  const S vv = dot(q.v, q.v), ww = q.w * q.w;
  const auto small = less(vv, S(L(0.04) * ww));  // 14 terms: the first left out is 0.04^14 / 29
  const S factor = choose(
      small,
      [&] {
        const S w = select(small, q.w, S(1.0)), t2 = select(small, vv, S(0.0)) / (w * w);
        S f(L(-1) / L(27));
        for (int k = 12; k >= 0; --k) f = f * t2 + (k % 2 ? L(-1) : L(1)) / static_cast<L>(2 * k + 1);
        return S(L(2) * f / w);
      },
      [&] {
        using lanes::atan2;
        using std::atan2;
        using std::sqrt;
        const S s = sqrt(select(small, S(1.0), vv));
        return S(L(2) * atan2(s, q.w) / s);
      });
  return factor * q.v;
}

}  // namespace bough::motion
