#pragma once
/// Tag of a group for kernels written once for all groups: Group::Pose<S>, Group::Vector<S> and static functions.
#include "bough/motion/se3.hpp"

namespace bough::motion {

struct Se3 {
  static constexpr int dof = 6;
  template <class S>
  using Pose = Frame<S>;
  template <class S>
  using Vector = Vec6<S>;
  template <class S>
  using Matrix = Mat6<S>;

  template <class S>
  static Pose<S> identity() {
    return Frame<S>::identity();
  }
  template <class S>
  static Pose<S> exp(const Vec6<S>& d) {
    return exp_se3(d);
  }
  template <class S>
  static Vec6<S> log(const Frame<S>& H) {
    return log_se3(H);
  }
  template <class S>
  static Pose<S> compose(const Frame<S>& a, const Frame<S>& b) {
    return motion::compose(a, b);
  }
  template <class S>
  static Pose<S> inverse(const Frame<S>& a) {
    return motion::inverse(a);
  }
  template <class S>
  static Pose<S> relative(const Frame<S>& a, const Frame<S>& b) {
    return motion::relative(a, b);
  }
  template <class S>
  static Mat6<S> adjoint(const Frame<S>& H) {
    return motion::adjoint(H);
  }
  template <class S>
  static Mat6<S> inverse_adjoint(const Frame<S>& H) {
    return motion::inverse_adjoint(H);
  }
  template <class S>
  static Vec6<S> adjoint_times(const Frame<S>& H, const Vec6<S>& v) {
    return motion::adjoint_times(H, v);
  }
  template <class S>
  static Vec6<S> inverse_adjoint_times(const Frame<S>& H, const Vec6<S>& v) {
    return motion::inverse_adjoint_times(H, v);
  }
  template <class S>
  static Vec6<S> adjoint_transpose_times(const Frame<S>& H, const Vec6<S>& f) {
    return motion::adjoint_transpose_times(H, f);
  }
  template <class S>
  static Vec6<S> inverse_adjoint_transpose_times(const Frame<S>& H, const Vec6<S>& f) {
    return motion::inverse_adjoint_transpose_times(H, f);
  }
  template <class S>
  static Mat6<S> cross(const Vec6<S>& v) {
    return cross6(v);
  }
  template <class S>
  static Vec6<S> cross_times(const Vec6<S>& v, const Vec6<S>& w) {
    return cross6_times(v, w);
  }
  template <class S>
  static Vec6<S> cross_transpose_times(const Vec6<S>& v, const Vec6<S>& f) {
    return cross6_transpose_times(v, f);
  }
  template <class S>
  static Mat6<S> hat(const Vec6<S>& P) {
    return hat6(P);
  }
  template <class S>
  static Mat6<S> tangent(const Vec6<S>& d) {
    return motion::tangent(d);
  }
  template <class S>
  static Mat6<S> inverse_tangent(const Vec6<S>& d) {
    return motion::inverse_tangent(d);
  }
  template <class S>
  static Vec6<S> tangent_times(const Vec6<S>& d, const Vec6<S>& a) {
    return motion::tangent_times(d, a);
  }
  template <class S>
  static Vec6<S> inverse_tangent_times(const Vec6<S>& d, const Vec6<S>& a) {
    return motion::inverse_tangent_times(d, a);
  }
  template <class S>
  static Vec6<S> tangent_transpose_times(const Vec6<S>& d, const Vec6<S>& n) {
    return motion::tangent_transpose_times(d, n);
  }
  template <class S>
  static Vec6<S> inverse_tangent_transpose_times(const Vec6<S>& d, const Vec6<S>& n) {
    return motion::inverse_tangent_transpose_times(d, n);
  }
  template <class S>
  static Mat6<S> tangent_derivative(const Vec6<S>& d, const Vec6<S>& a) {
    return motion::tangent_derivative(d, a);
  }
  template <class S>
  static Mat6<S> tangent_transpose_derivative(const Vec6<S>& d, const Vec6<S>& n) {
    return motion::tangent_transpose_derivative(d, n);
  }
  template <class S>
  static Mat6<S> inverse_tangent_transpose_derivative(const Vec6<S>& d, const Vec6<S>& n) {
    return motion::inverse_tangent_transpose_derivative(d, n);
  }
};

}  // namespace bough::motion
