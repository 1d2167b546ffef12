#pragma once
/// Three vectorial parameterizations of rotations and motions, p = p(phi) n, behind one interface:
///   law                 p(phi)         regular for                        R(p) = I + ...,  x = p.p
///   exponential         phi            |p| < 2 pi                         c_1 ~p + c_2 ~p~p
///   Cayley              2 tan(phi/2)   phi < pi (Gibbs-Rodrigues, times 2)  (~p + ~p~p/2)/(1 + x/4)
///   Wiener-Milenkovic   4 tan(phi/4)   phi < 2 pi, all phi with rescaling  see WienerMilenkovicLaw
/// All have p = phi + O(phi^3): they agree to first order. For any of them, body components,
///   T = I/p' - (1 - cos phi)/x ~p + (1/p' - sin(phi)/p)/x ~p~p,   T^-1 = p' I + ~p/2 + (p' - (p/2) cot(phi/2))/x ~p~p,
/// p' = dp/dphi. On SE(3) the same functions of the dual vector p + e u, e^2 = 0 (transference): P = (u; p) has
/// u = p w + p' d n for the motion (d, phi, w, n), which is the screw p N of [1.73] with alpha = 2 sin(phi/2) p'/p:
/// alpha = 2 sin(phi/2)/phi, 1/cos(phi/2) and, for Wiener-Milenkovic, exactly 1.
/// Templates on the scalar; pure, no allocation, no failure. Sources: data/manual/theory/motions.md.
#include <string_view>

#include "bough/motion/se3.hpp"

namespace bough::motion {

/// f I + g ~p + h ~p ~p: every isotropic tensor function of a vector; f, g, h functions of x = p.p.
template <class S>
struct IsotropicTensor {
  S f, g, h;

  Mat3<S> matrix(const Vec3<S>& p) const {
    const Vec3<S> hp = h * p;
    const S diagonal = f - dot(hp, p);
    Mat3<S> r = outer(hp, p) + skew(g * p);
    for (int i = 0; i < 3; ++i) r(i, i) = r(i, i) + diagonal;
    return r;
  }
  Vec3<S> times(const Vec3<S>& p, const Vec3<S>& a) const { return f * a + cross(p, g * a + h * cross(p, a)); }
  IsotropicTensor transposed() const { return {f, -g, h}; }
};

/// p = phi n, the rotation vector: parameters with |p| <= pi. T^-1 does not exist at |p| = 2 pi, 4 pi, ...
struct ExponentialLaw {
  static constexpr std::string_view name = "exponential";
  template <class S>
  static IsotropicTensor<S> rotation(const S& x) {
    const lanes::Vec<S, 8> c = eval_stumpff(x);
    return {S(1.0), c[1], c[2]};
  }
  template <class S>
  static IsotropicTensor<S> tangent(const S& x) {
    const lanes::Vec<S, 8> c = eval_stumpff(x);
    return {S(1.0), -c[2], c[3]};
  }
  template <class S>
  static IsotropicTensor<S> inverse_tangent(const S& x) {
    return {S(1.0), S(0.5), eval_inverse_coefficients(x).k};
  }
  template <class S>
  static Vec3<S> parameters(const Quaternion<S>& q) {
    return log_quaternion(q);
  }
};

/// p = 2 tan(phi/2) n, rational. It is infinite at phi = pi. There, and only there, |p| is limited to 2e50, which still
/// gives the rotation to round-off, so that no infinity or NaN appears. Near pi the two parts of a motion's u, p' d
/// along the axis and p w across it, differ by the factor p/4. The pose is therefore recovered to epsilon |p| |x|, and
/// not at all at pi itself.
struct CayleyLaw {
  static constexpr std::string_view name = "cayley";
  static constexpr double smallest_cosine = 1e-50;  ///< of phi/2, which in doubles is 0 or above 1e-20
  template <class S>
  static IsotropicTensor<S> rotation(const S& x) {
    const S g = S(1.0) / (1.0 + 0.25 * x);
    return {S(1.0), g, 0.5 * g};
  }
  /// (I - ~p/2)/(1 + x/4).
  template <class S>
  static IsotropicTensor<S> tangent(const S& x) {
    const S f = S(1.0) / (1.0 + 0.25 * x);
    return {f, -0.5 * f, S(0.0)};
  }
  /// I + ~p/2 + p p^T/4.
  template <class S>
  static IsotropicTensor<S> inverse_tangent(const S& x) {
    return {1.0 + 0.25 * x, S(0.5), S(0.25)};
  }
  template <class S>
  static Vec3<S> parameters(const Quaternion<S>& q) {
    const auto at_pi = less(q.w, S(smallest_cosine));
    return (S(2.0) / select(at_pi, S(smallest_cosine), q.w)) * q.v;
  }
};

/// p = 4 tan(phi/4) n (conformal rotation vector, modified Rodrigues parameters times 4). With t = tan(phi/4), t^2 =
/// x/16:
///   R = I + (1 - t^2)/(1 + t^2)^2 ~p + ~p~p/(2 (1 + t^2)^2),
///   T = I/(1 + t^2) + (-~p/2 + ~p~p/8)/(1 + t^2)^2,   T^-1 = (1 + t^2) I + ~p/2 + ~p~p/8, polynomial.
/// Infinite at 2 pi; p and -16 p/x are the same rotation, so rescaling when |p| > 4 (phi > pi) keeps |p| <= 4 for
/// motions of any angle, where T^-1 has norm at most 2.
struct WienerMilenkovicLaw {
  static constexpr std::string_view name = "wiener_milenkovic";
  template <class S>
  static IsotropicTensor<S> rotation(const S& x) {
    const S t2 = 0.0625 * x, r = S(1.0) / (1.0 + t2), rr = r * r;
    return {S(1.0), (1.0 - t2) * rr, 0.5 * rr};
  }
  template <class S>
  static IsotropicTensor<S> tangent(const S& x) {
    const S r = S(1.0) / (1.0 + 0.0625 * x), rr = r * r;
    return {r, -0.5 * rr, 0.125 * rr};
  }
  template <class S>
  static IsotropicTensor<S> inverse_tangent(const S& x) {
    return {1.0 + 0.0625 * x, S(0.5), S(0.125)};
  }
  template <class S>
  static Vec3<S> parameters(const Quaternion<S>& q) {
    using std::sqrt;
    return (S(4.0) / (sqrt(q.w * q.w + dot(q.v, q.v)) + q.w)) * q.v;
  }
};

/// Operators of one law. Rotations take p, motions P = (u; p); increments are right increments in body components:
/// R^T D R[dp] = (T dp)~, and the same with 6-vectors on SE(3).
template <class Law>
struct Parameterization {
  static constexpr std::string_view name = Law::name;

  /// R(p).
  template <class S>
  static Mat3<S> rotation(const Vec3<S>& p) {
    return Law::rotation(S(dot(p, p))).matrix(p);
  }
  /// p of a rotation by the angle 0 <= phi <= pi; at pi one of the two.
  template <class S>
  static Vec3<S> parameters(const Mat3<S>& R) {
    return Law::parameters(quaternion_of(R));
  }
  /// T(p): body angular velocity = T dp/dt.
  template <class S>
  static Mat3<S> tangent(const Vec3<S>& p) {
    return Law::tangent(S(dot(p, p))).matrix(p);
  }
  template <class S>
  static Mat3<S> inverse_tangent(const Vec3<S>& p) {
    return Law::inverse_tangent(S(dot(p, p))).matrix(p);
  }

  /// H(P): R(p) and x = T(p)^T u.
  template <class S>
  static Frame<S> motion(const Vec6<S>& P) {
    const Vec3<S> p = angular_part(P);
    const S x = dot(p, p);
    return {Law::rotation(x).matrix(p), Law::tangent(x).transposed().times(p, linear_part(P))};
  }
  /// P of a motion: p of its rotation and u = T(p)^-T x.
  template <class S>
  static Vec6<S> parameters(const Frame<S>& H) {
    const Vec3<S> p = parameters(H.R);
    return join(Law::inverse_tangent(S(dot(p, p))).transposed().times(p, H.x), p);
  }
  /// T(P), 6x6: body velocity V* = T dP/dt, the H* of [1.82-1.85]; V = T(-P) dP/dt in the inertial frame.
  template <class S>
  static Mat6<S> tangent(const Vec6<S>& P) {
    const auto p = dual(angular_part(P), linear_part(P));
    return blocks(Law::tangent(lanes::Jet<S, 1>(dot(p, p))).matrix(p));
  }
  template <class S>
  static Mat6<S> inverse_tangent(const Vec6<S>& P) {
    const auto p = dual(angular_part(P), linear_part(P));
    return blocks(Law::inverse_tangent(lanes::Jet<S, 1>(dot(p, p))).matrix(p));
  }
  /// d(T(P) a)/dP, 6x6, row i and column j: d(.)_i/dP_j.
  template <class S>
  static Mat6<S> tangent_derivative(const Vec6<S>& P, const Vec6<S>& a) {
    return derivative(P, a, [](const auto& x) { return Law::tangent(x); });
  }
  template <class S>
  static Mat6<S> inverse_tangent_derivative(const Vec6<S>& P, const Vec6<S>& a) {
    return derivative(P, a, [](const auto& x) { return Law::inverse_tangent(x); });
  }

 private:
  /// real + e infinitesimal, e^2 = 0: a jet of one direction.
  template <class S>
  static Vec3<lanes::Jet<S, 1>> dual(const Vec3<S>& real, const Vec3<S>& infinitesimal) {
    Vec3<lanes::Jet<S, 1>> r;
    for (int i = 0; i < 3; ++i) {
      r[i].a = real[i];
      r[i].d[0] = infinitesimal[i];
    }
    return r;
  }
  template <class S>
  static Mat6<S> blocks(const Mat3<lanes::Jet<S, 1>>& m) {
    Mat3<S> real, infinitesimal;
    for (int i = 0; i < 9; ++i) {
      real.m[i] = m.m[i].a;
      infinitesimal.m[i] = m.m[i].d[0];
    }
    return detail::upper(real, infinitesimal);
  }
  template <class S, class Tensor>
  static Mat6<S> derivative(const Vec6<S>& P, const Vec6<S>& a, const Tensor& tensor) {
    using J = lanes::Jet<S, 6>;
    Vec6<J> z, b;
    for (int j = 0; j < 6; ++j) {
      z[j] = J::variable(P[j], j);
      b[j] = J(0.0);
      b[j].a = a[j];
    }
    const auto p = dual(angular_part(z), linear_part(z)), v = dual(angular_part(b), linear_part(b));
    const auto y = tensor(lanes::Jet<J, 1>(dot(p, p))).times(p, v);
    Mat6<S> r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j) {
        r(i, j) = y[i].d[0].d[j];
        r(i + 3, j) = y[i].a.d[j];
      }
    return r;
  }
};
using ExponentialMap = Parameterization<ExponentialLaw>;
using CayleyMap = Parameterization<CayleyLaw>;
using WienerMilenkovicMap = Parameterization<WienerMilenkovicLaw>;

/// Wiener-Milenkovic parameters of the same rotation or motion with |p| <= 4, p <- -16 p/x where |p| > 4. The dual part
/// follows: u <- -16 (u - 2 p (p.u)/x)/x.
template <class S>
Vec3<S> rescale_wiener_milenkovic(const Vec3<S>& p) {
  const S x = dot(p, p);
  const auto keep = less(x, S(16.0));
  return select(keep, S(1.0), S(-16.0) / select(keep, S(16.0), x)) * p;
}
template <class S>
Vec6<S> rescale_wiener_milenkovic(const Vec6<S>& P) {
  const Vec3<S> p = angular_part(P), u = linear_part(P);
  const S x = dot(p, p), pu = dot(p, u);
  const auto keep = less(x, S(16.0));
  const S safe = select(keep, S(16.0), x), scale = select(keep, S(1.0), S(-16.0) / safe);
  const S along = select(keep, S(0.0), (pu + pu) / safe);
  return join(scale * (u - along * p), scale * p);
}

}  // namespace bough::motion
