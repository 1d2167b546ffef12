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
/// A multiple q' = c q, c >= 1, of the quaternion of a rotation, w >= 0. The rows of 4 q q^T are linear in R. The row
/// with the largest diagonal (always >= 1) is used, so nothing cancels at any angle, and no square root is needed
/// (Shepperd 1978).
template <class S>
Quaternion<S> quaternion_direction(const Mat3<S>& R) {
  using L = Literal<S>;
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
  const auto flipped = less(row[0], S(0.0));
  for (S& x : row) x = select(flipped, S(-x), x);
  return {row[0], {{row[1], row[2], row[3]}}};
}
/// Quaternion of a rotation with w >= 0.
template <class S>
Quaternion<S> quaternion_of(const Mat3<S>& R) {
  return normalise(quaternion_direction(R));
}
/// Quaternion of the rotation vector psi = phi n [rad], any angle.
template <class S>
Quaternion<S> exp_quaternion(const Vec3<S>& psi) {
  using L = Literal<S>;
  const lanes::Vec<S, 8> c = eval_stumpff(S(L(0.25) * dot(psi, psi)));
  return {c[0], L(0.5) * c[1] * psi};
}
namespace detail {
/// (-1)^k / (2k + 1): atan(t)/t as a polynomial in t^2, for t <= tan(pi/8); the first term left out is below 1e-20.
constexpr std::array<long double, 24> arctangent_table() {
  std::array<long double, 24> t{};
  for (int k = 0; k < 24; ++k)
    t[static_cast<std::size_t>(k)] = (k % 2 ? -1.0L : 1.0L) / static_cast<long double>(2 * k + 1);
  return t;
}
template <class L>
inline constexpr std::array<L, 24> arctangent = rounded<L>(arctangent_table());
template <class L>
inline constexpr std::array<L, 16> near_arctangent = rounded<L>(first_of<16>(arctangent_table()));  ///< for t <= 1/4
}  // namespace detail

/// Rotation vector of q with w >= 0, |psi| <= pi [rad]. The norm m of q drops out. The angle is halved twice,
///   tan(phi/4) = |v|/(m + w),  tan(phi/8) = |v|/(m + w + g),  g = sqrt(2 m (m + w)) = (m + w) sqrt(1 + tan(phi/4)^2),
/// so that psi = 8 v atan(t)/(t (m + w + g)), t = tan(phi/8), is one formula in v.v, analytic from 0 to pi, with one
/// division. Where tan(phi/2) is below 1/4, its arctangent is used directly, without a square root.
template <class S>
Vec3<S> log_quaternion(const Quaternion<S>& q) {
  using L = Literal<S>;
  using std::sqrt;
  const S vv = dot(q.v, q.v), ww = q.w * q.w;
  const auto near = less(vv, S(L(0.0625) * ww));  // tan(phi/2) < 1/4
  const S factor = choose(
      near,
      [&] {
        const S inverse = L(1) / select(near, q.w, S(1.0)), tt = select(near, vv, S(0.0)) * inverse * inverse;
        return S(L(2) * inverse * detail::horner(detail::near_arctangent<L>, tt));
      },
      [&] {
        const S m = sqrt(multiply_add(q.w, q.w, vv)), sum = m + q.w;
        const S inverse = L(1) / (sum + sqrt((m + m) * sum)), tt = vv * inverse * inverse;
        return S(L(8) * inverse * detail::horner(detail::arctangent<L>, tt));
      });
  return factor * q.v;
}

}  // namespace bough::motion
