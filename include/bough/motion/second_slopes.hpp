#pragma once
/// Second derivatives of the tangent operator T(d), as matrices. By transference every formula on SO(3) holds on SE(3)
/// for the dual vector psi + e u (e^2 = 0); a jet of one direction is a dual number, so each formula is written once, on
/// 3-vectors, and the two parts of the result are the blocks of the 6x6 matrix.
#include "bough/motion/se3.hpp"

namespace bough::motion {

/// d(D f(psi)[x] y)/dpsi, f = I + p ~psi + q ~psi^2.
template <class S>
Mat3<S> series_second_jacobian(const SkewSeries<S>& f, const Vec3<S>& psi, const Vec3<S>& x, const Vec3<S>& y) {
  const S half = dot(psi, x), s = half + half, s_dq = s * f.dq;
  const Vec3<S> w1 = cross(psi, y), w2 = cross(psi, w1), xy = cross(x, y);
  const Vec3<S> first = f.dp * w1 + f.dq * w2;
  const Vec3<S> left = f.dp * xy + f.dq * (cross(x, w1) + cross(psi, xy)) + s * (f.ddp * w1 + f.ddq * w2);
  Mat3<S> r = outer(left + left - s_dq * y, psi) + outer(first + first - f.q * y, x) -
              skew(f.q * xy + (s * f.dp) * y + s_dq * w1);
  const S diagonal = f.q * dot(x, y) + s_dq * dot(psi, y);
  for (int i = 0; i < 3; ++i) r(i, i) = r(i, i) + diagonal;
  return r;
}

/// d^2(n . f(psi) y)/dpsi^2, symmetric:  with k = y x n, b = (n.psi)(psi.y) - x n.y, g = db/dpsi,
///   n . f y = n.y + p psi.k + q b.
template <class S>
Mat3<S> series_hessian(const SkewSeries<S>& f, const Vec3<S>& psi, const Vec3<S>& n, const Vec3<S>& y) {
  const S ny = dot(n, y), n_psi = dot(n, psi), y_psi = dot(y, psi), b = n_psi * y_psi - dot(psi, psi) * ny;
  const Vec3<S> k = cross(y, n), g = y_psi * n + n_psi * y - (ny + ny) * psi;
  const S k_psi = dot(k, psi);
  const Vec3<S> half = f.dp * k + f.dq * g + (f.ddp * k_psi + f.ddq * b) * psi, a = half + half;
  const Vec3<S> qn = f.q * n;
  Mat3<S> r = outer(a, psi) + outer(psi, a) + outer(qn, y) + outer(y, qn);
  const S half_diagonal = f.dp * k_psi + f.dq * b - f.q * ny;
  for (int i = 0; i < 3; ++i) r(i, i) = r(i, i) + (half_diagonal + half_diagonal);
  return r;
}

/// T(d) and its derivatives up to the second at one d, coefficients evaluated once.
template <class S>
class TangentSlopes {
 public:
  using Dual = lanes::Jet<S, 1>;

  explicit TangentSlopes(const Vec6<S>& d)
      : psi_(dual(angular_part(d), linear_part(d))), f_(tangent_series(Dual(dot(psi_, psi_)))) {
    T_ = {{f_.p.a, f_.q.a, f_.dp.a, f_.dq.a, f_.ddp.a, f_.ddq.a}, d};
  }
  const MotionOperator<S>& T() const { return T_; }
  /// d(D T(d)[x] y)/dd, 6x6.
  Mat6<S> second(const Vec6<S>& x, const Vec6<S>& y) const {
    const Mat3<Dual> m = series_second_jacobian(f_, psi_, motion_vector(x), motion_vector(y));
    return detail::upper(part(m, false), part(m, true));
  }
  /// d^2(n . T(d) y)/dd^2, 6x6, symmetric.
  Mat6<S> hessian(const Vec6<S>& n, const Vec6<S>& y) const {
    const Mat3<Dual> m = series_hessian(f_, psi_, dual(linear_part(n), angular_part(n)), motion_vector(y));
    return detail::lower_right(part(m, false), part(m, true));
  }

 private:
  static Vec3<Dual> dual(const Vec3<S>& real, const Vec3<S>& infinitesimal) {
    Vec3<Dual> r;
    for (int i = 0; i < 3; ++i) {
      r[i].a = real[i];
      r[i].d[0] = infinitesimal[i];
    }
    return r;
  }
  static Vec3<Dual> motion_vector(const Vec6<S>& a) { return dual(angular_part(a), linear_part(a)); }
  static Mat3<S> part(const Mat3<Dual>& m, bool infinitesimal) {
    Mat3<S> r;
    for (int i = 0; i < 9; ++i) r.m[i] = infinitesimal ? m.m[i].d[0] : m.m[i].a;
    return r;
  }

  Vec3<Dual> psi_;
  SkewSeries<Dual> f_;
  MotionOperator<S> T_;
};

}  // namespace bough::motion
