#pragma once
/// Chains of frames as functions of time, for tests: every pose a truncated Taylor series of an extended scalar, so
/// that angular velocities and derivatives come from differentiating rotation matrices and positions, by no formula
/// of nested frames. All quantities at t = 0.
#include <vector>

#include "bough/lanes/taylor.hpp"
#include "bough/motion/frame_chain.hpp"
#include "samples.hpp"

namespace bough::motion::test {

constexpr int order = 3;
template <class Real>
using Series = lanes::Taylor<Real, order>;

template <class Real>
Series<Real> time_derivative(const Series<Real>& x) {
  Series<Real> r(0.0);
  for (int k = 0; k < order; ++k) r.c[k] = double(k + 1) * x.c[k + 1];
  return r;
}
template <class Real>
Vec3<Series<Real>> time_derivative(const Vec3<Series<Real>>& x) {
  return {{time_derivative(x[0]), time_derivative(x[1]), time_derivative(x[2])}};
}
template <class Real>
Vec3<Real> value(const Vec3<Series<Real>>& x) {
  return {{x[0].c[0], x[1].c[0], x[2].c[0]}};
}
template <class Real>
Vec3<double> rounded(const Vec3<Real>& x) {
  return {{static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])}};
}
template <class Real>
Vec3<double> rounded(const Vec3<Series<Real>>& x) {
  return rounded(value(x));
}
/// w of Rdot R^T = ~w, in the parent's axes; exact to one order less than R.
template <class Real>
Vec3<Series<Real>> spin_of(const Mat3<Series<Real>>& R) {
  Mat3<Series<Real>> rate;
  for (int k = 0; k < 9; ++k) rate.m[k] = time_derivative(R.m[k]);
  const Mat3<Series<Real>> M = rate * transpose(R);
  return {{M(2, 1), M(0, 2), M(1, 0)}};
}

template <class Real>
class Oracle {
 public:
  using T = Series<Real>;
  using Vec = Vec3<T>;
  using Mat = Mat3<T>;

  /// A chain of `last` frames and a point of the last one; angles, rates, lengths and their derivatives over decades.
  Oracle(Random& random, int last) : R_(1, Mat::identity()), x_(1, Vec::zero()) {
    std::vector<FrameMotion> links;
    for (int i = 1; i <= last; ++i) {
      const double speed = std::pow(10.0, random.number()), length = std::pow(10.0, random.number());
      Mat R = turn(random, speed) * turn(random, speed);
      R = R * turn(random, speed);
      const Vec x = series(random, length, speed);
      step_R_.push_back(R);
      step_x_.push_back(x);
      x_.push_back(x_.back() + R_.back() * x);
      R_.push_back(R_.back() * R);
      links.push_back(link_of(R, x));
    }
    chain = FrameChain(links);
    r = series(random, std::pow(10.0, random.number()), std::pow(10.0, random.number()));
    point = {last, rounded(r), rounded(time_derivative(r)), rounded(time_derivative(time_derivative(r)))};
  }

  /// Rotation of frame b in frame a.
  Mat R(int a, int b) const { return transpose_times(R_[at(a)], R_[at(b)]); }
  /// Position of a point at r in frame b, seen from frame a.
  Vec position(int a, int b, const Vec& p) const {
    return transpose_times(R_[at(a)], Vec(x_[at(b)] + R_[at(b)] * p - x_[at(a)]));
  }
  /// W_ab in the axes of a.
  Vec W(int a, int b) const { return spin_of(R(a, b)); }
  /// w_i in the axes of frame i, and a_i.
  Vec w(int i) const { return transpose_times(step_R_[at(i) - 1], spin_of(step_R_[at(i) - 1])); }
  Vec a(int i) const { return time_derivative(w(i)); }
  /// d_g of a vector whose components in the axes of b are y; in the axes of g.
  Vec derivative(int g, int b, const Vec& y) const { return time_derivative(Vec(R(g, b) * y)); }
  /// Sum of the a_i from frame a to frame b in the axes of b, with a minus where b < a.
  Vec sum_of_local(int a_, int b) const {
    Vec s = Vec::zero();
    for (int i = a_ + 1; i <= b; ++i) s += R(b, i) * a(i);
    for (int i = a_; i > b; --i) s -= R(b, i) * a(i);
    return s;
  }

  FrameChain chain{{}};
  PointMotion point;
  Vec r;  ///< of the point in the last frame

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  /// A rotation about a fixed random axis by an angle that is a random cubic.
  static Mat turn(Random& random, double speed) {
    const Vec3<double> n = random.unit();
    T angle;
    for (int k = 0; k <= order; ++k) angle.c[k] = Real(std::pow(speed, k) * random.number());
    // Rodrigues, with the axis of unit length in the extended scalar.
    using std::sqrt;
    Vec3<Real> m{{Real(n[0]), Real(n[1]), Real(n[2])}};
    m = Real(Real(1) / sqrt(dot(m, m))) * m;
    T s, c;
    sin_cos(angle, s, c);
    Mat R;
    const Real cyclic[9] = {Real(0), -m[2], m[1], m[2], Real(0), -m[0], -m[1], m[0], Real(0)};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k <= order; ++k) {
          const Real one(i == j && k == 0 ? 1 : 0), mm = m[i] * m[j], unit(i == j ? 1 : 0), first(k == 0 ? 1 : 0);
          R(i, j).c[k] = one + cyclic[3 * i + j] * s.c[k] + (first - c.c[k]) * (mm - unit);
        }
    return R;
  }
  static Vec series(Random& random, double length, double speed) {
    Vec x;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k <= order; ++k) x[i].c[k] = Real(length * std::pow(speed, k) * random.number());
    return x;
  }
  static FrameMotion link_of(const Mat& R, const Vec& x) {
    FrameMotion m;
    for (int k = 0; k < 9; ++k) m.pose.R.m[k] = static_cast<double>(R.m[k].c[0]);
    m.pose.x = rounded(x);
    m.velocity = rounded(time_derivative(x));
    m.acceleration = rounded(time_derivative(time_derivative(x)));
    m.angular_velocity = rounded(spin_of(R));
    m.angular_acceleration = rounded(time_derivative(spin_of(R)));
    return m;
  }

  std::vector<Mat> step_R_, R_;
  std::vector<Vec> step_x_, x_;
};

inline double length_of(const Vec3<double>& a) { return std::sqrt(dot(a, a)); }

/// Magnitudes that bound the terms of a chain's formulas: the scale against which their round-off is measured.
struct Scale {
  double W = 0.0;      ///< sum of the |w_i|
  double alpha = 0.0;  ///< sum of the |a_i| and of all |w_i| |w_j|
  double v = 0.0;      ///< of the origins and the point, all terms
  double acc = 0.0;
};
inline Scale scale_of(const FrameChain& chain, const PointMotion& point) {
  Scale s;
  for (int i = 1; i <= chain.last(); ++i) {
    s.W += length_of(chain.link(i).angular_velocity);
    s.alpha += length_of(chain.link(i).angular_acceleration);
  }
  s.alpha += s.W * s.W;
  const auto add = [&s](const Vec3<double>& x, const Vec3<double>& rate, const Vec3<double>& second) {
    s.v += length_of(rate) + s.W * length_of(x);
    s.acc += length_of(second) + 2.0 * s.W * length_of(rate) + (s.alpha + s.W * s.W) * length_of(x);
  };
  add(point.position, point.velocity, point.acceleration);
  for (int i = 1; i <= chain.last(); ++i) add(chain.link(i).pose.x, chain.link(i).velocity, chain.link(i).acceleration);
  return s;
}

}  // namespace bough::motion::test
