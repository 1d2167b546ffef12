#pragma once
/// The group of translations along N axes, R^N, for elements: the functions of group_se3.hpp for frames that never
/// turn. Poses are positions and vectors are N numbers in the axes of the ground. The group is commutative: ad(d) = 0,
/// so every function of ad(d), and with it every map of motions that occurs, is a multiple of the identity. Brackets
/// and the maps to and from them are zero; they are a type without numbers, and no operation on them costs anything.
#include "bough/motion/types.hpp"

namespace bough::motion {

/// The rotation of a frame that does not turn: the identity. It has no numbers.
struct NoRotation {};
/// A quantity that is always zero. It has no numbers.
template <class S>
struct Nothing {};

/// Position of a frame that does not turn [m].
template <class S, int N>
struct Place {
  [[no_unique_address]] NoRotation R;
  lanes::Vec<S, N> x;
  static Place identity() { return {{}, lanes::Vec<S, N>::zero()}; }
};
/// y -> f y
template <class S>
struct Multiple {
  S f;
  static Multiple zero() { return {S(0.0)}; }
  static Multiple identity() { return {S(1.0)}; }
};

template <int N>
struct Translations {
  static constexpr int dof = N, translations = N;
  static constexpr bool turns = false, has_moving_frames = false;
  template <class S>
  using Pose = Place<S, N>;
  template <class S>
  using Vector = lanes::Vec<S, N>;
  template <class S>
  using Matrix = lanes::Mat<S, N, N>;
  template <class S>
  using Motion = lanes::Vec<S, N>;
  template <class S>
  using Wrench = lanes::Vec<S, N>;  ///< a force
  template <class S>
  using Translation = lanes::Vec<S, N>;
  template <class S>
  using Rotation = NoRotation;
  template <class S>
  using Bracket = Nothing<S>;
  template <class S>
  using Map = Multiple<S>;
  template <class S>
  using BracketMap = Nothing<S>;
  template <class S>
  using WrenchMap = Nothing<S>;
  template <class S>
  using TurnSlope = Nothing<S>;
  template <class C>
  struct Direction {
    static constexpr bool has_numbers = true;
    lanes::Vec<C, N> d = lanes::Vec<C, N>::unit(0);
    static Direction axial() { return {}; }
  };

  // ---- poses

  template <class S>
  static BOUGH_INLINE Place<S, N> compose(const Place<S, N>& a, const Place<S, N>& b) {
    return {{}, lanes::Vec<S, N>(a.x + b.x)};
  }
  /// H_a^-1 H_b
  template <class S>
  static BOUGH_INLINE Place<S, N> relative(const Place<S, N>& a, const Place<S, N>& b) {
    return {{}, lanes::Vec<S, N>(b.x - a.x)};
  }
  template <class S>
  static BOUGH_INLINE Place<S, N> exp(const lanes::Vec<S, N>& d) {
    return {{}, d};
  }
  template <class S>
  static BOUGH_INLINE lanes::Vec<S, N> log(const Place<S, N>& H) {
    return H.x;
  }
  template <class A, class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& inverse_adjoint_times(const Place<A, N>&, const lanes::Vec<S, N>& v) {
    return v;
  }
  template <class A, class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& inverse_adjoint_transpose_times(const Place<A, N>&,
                                                                              const lanes::Vec<S, N>& f) {
    return f;
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& turned(const Place<S, N>&, const lanes::Vec<S, N>& u) {
    return u;
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& turned_back(const Place<S, N>&, const lanes::Vec<S, N>& u) {
    return u;
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& wrench_turned_back(const Place<S, N>&, const lanes::Vec<S, N>& f) {
    return f;
  }

  // ---- vectors

  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& motion(const lanes::Vec<S, N>& v) {
    return v;
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& wrench(const lanes::Vec<S, N>& f) {
    return f;
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& vector_of_motion(const lanes::Vec<S, N>& v) {
    return v;
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& vector_of_wrench(const lanes::Vec<S, N>& f) {
    return f;
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& linear(const lanes::Vec<S, N>& v) {
    return v;
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& translation(const lanes::Vec<S, N>& u) {
    return u;
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& force(const lanes::Vec<S, N>& f) {
    return f;
  }
  template <class S>
  static BOUGH_INLINE lanes::Vec<S, N> add_translation(const lanes::Vec<S, N>& v, const lanes::Vec<S, N>& u) {
    return v + u;
  }
  /// w x u with w = 0
  template <class S>
  static BOUGH_INLINE lanes::Vec<S, N> spin(const lanes::Vec<S, N>&, const lanes::Vec<S, N>&) {
    return lanes::Vec<S, N>::zero();
  }
  template <class S>
  static BOUGH_INLINE void put(const lanes::Vec<S, N>& f, S* out) {
    for (int k = 0; k < N; ++k) out[k] = f[k];
  }
  template <class S>
  static BOUGH_INLINE void put_force(const lanes::Vec<S, N>& f, S* out) {
    put(f, out);
  }
  template <class A, class S>
  static BOUGH_INLINE lanes::Vec<S, N> scaled(const A& f, const lanes::Vec<S, N>& x) {
    return f * x;
  }
  /// r + f x
  template <class F, class S>
  static BOUGH_INLINE lanes::Vec<S, N> add(lanes::Vec<S, N> r, const F& f, const lanes::Vec<S, N>& x) {
    for (int i = 0; i < N; ++i) r[i] = multiply_add(f, x[i], r[i]);
    return r;
  }
  template <class S>
  static BOUGH_INLINE S real_power(const lanes::Vec<S, N>& f, const lanes::Vec<S, N>& v) {
    return lanes::dot(f, v);
  }
  template <class C, class S>
  static BOUGH_INLINE lanes::Vec<S, N> matrix_times(const lanes::Mat<C, N, N>& m, const lanes::Vec<S, N>& x) {
    return m * x;
  }

  // ---- brackets

  template <class S>
  static BOUGH_INLINE Nothing<S> bracket(const lanes::Vec<S, N>&, const lanes::Vec<S, N>&) {
    return {};
  }
  template <class S>
  static BOUGH_INLINE lanes::Vec<S, N> widened(const Nothing<S>&) {
    return lanes::Vec<S, N>::zero();
  }
  template <class S>
  static BOUGH_INLINE lanes::Vec<S, N> dual_bracket(const lanes::Vec<S, N>&, const lanes::Vec<S, N>&) {
    return lanes::Vec<S, N>::zero();
  }
  template <class S>
  static BOUGH_INLINE const lanes::Vec<S, N>& subtract_dual_bracket(const lanes::Vec<S, N>& r, const lanes::Vec<S, N>&,
                                                                    const lanes::Vec<S, N>&) {
    return r;
  }
  template <class S>
  static BOUGH_INLINE Nothing<S> ad(const lanes::Vec<S, N>&) {
    return {};
  }
  template <class S>
  static BOUGH_INLINE Nothing<S> hat(const lanes::Vec<S, N>&) {
    return {};
  }

  // ---- maps

  template <class A, class S>
  static BOUGH_INLINE Multiple<S> scaled(const A& f, const Multiple<S>& x) {
    return {f * x.f};
  }
  template <class S>
  static BOUGH_INLINE Multiple<S> negated(const Multiple<S>& x) {
    return {-x.f};
  }
  template <class S>
  static BOUGH_INLINE Multiple<S> product(const Multiple<S>& x, const Multiple<S>& y) {
    return {x.f * y.f};
  }
  template <class S>
  static BOUGH_INLINE lanes::Vec<S, N> times(const Multiple<S>& m, const lanes::Vec<S, N>& y) {
    return m.f * y;
  }
  template <class S>
  static BOUGH_INLINE lanes::Vec<S, N> transpose_times(const Multiple<S>& m, const lanes::Vec<S, N>& f) {
    return m.f * f;
  }
  template <class S>
  static BOUGH_INLINE Multiple<S> inverse_adjoint_map(const Place<S, N>&) {
    return Multiple<S>::identity();
  }
  /// m -= the derivative of a vector in the axes of a frame that turns; it does not turn.
  template <class S>
  static BOUGH_INLINE void subtract_turned_back(Multiple<S>&, const lanes::Vec<S, N>&) {}

  // ---- functions of the relative place H of a second frame: components along directions

  template <class S, class C>
  static BOUGH_INLINE lanes::Vec<S, N> seen(const Place<S, N>&, const Direction<C>& direction) {
    return lanes::cast<S>(direction.d);
  }
  template <class S, class C>
  static BOUGH_INLINE S component(const Place<S, N>& H, const Direction<C>& direction) {
    S sum = direction.d[0] * H.x[0];
    for (int i = 1; i < N; ++i) sum = multiply_add(direction.d[i], H.x[i], sum);
    return sum;
  }

  // ---- full blocks

  template <class A, class S>
  static BOUGH_INLINE lanes::Mat<S, N, N> block_product(const lanes::Mat<A, N, N>& m, const Multiple<S>& x) {
    lanes::Mat<S, N, N> r;
    for (int i = 0; i < N * N; ++i) r.m[i] = m.m[i] * x.f;
    return r;
  }
  template <class A, class S>
  static BOUGH_INLINE void add_block_product(lanes::Mat<S, N, N>& r, const lanes::Mat<A, N, N>& m,
                                             const Multiple<S>& x) {
    for (int i = 0; i < N * N; ++i) r.m[i] = multiply_add(m.m[i], x.f, r.m[i]);
  }
  template <class A, class S>
  static BOUGH_INLINE void add_block_product(lanes::Mat<S, N, N>&, const lanes::Mat<A, N, N>&, const Nothing<S>&) {}
  template <class S, class A>
  static BOUGH_INLINE lanes::Mat<S, N, N> transposed_product(const Multiple<S>& x, const lanes::Mat<A, N, N>& m) {
    return block_product(m, x);
  }
  template <class S>
  static BOUGH_INLINE void add_wrench_map(lanes::Mat<S, N, N>&, const Nothing<S>&) {}
  template <class S>
  static BOUGH_INLINE void add_wrench_product(lanes::Mat<S, N, N>&, const Nothing<S>&, const Multiple<S>&) {}
  template <class S>
  static BOUGH_INLINE void add_turning(lanes::Mat<S, N, N>&, const lanes::Vec<S, N>&) {}
  template <class S>
  static BOUGH_INLINE void add_outer(lanes::Mat<S, N, N>& r, const lanes::Vec<S, N>& a, const lanes::Vec<S, N>& b) {
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) r(i, j) = multiply_add(a[i], b[j], r(i, j));
  }
  template <class S>
  static BOUGH_INLINE void add_force_outer(lanes::Mat<S, N, N>& r, const lanes::Vec<S, N>& f,
                                           const lanes::Vec<S, N>& n) {
    add_outer(r, f, n);
  }
  /// r += a
  template <class S>
  static BOUGH_INLINE void add_rotation(lanes::Mat<S, N, N>& r, const S& a, const Place<S, N>&, const Place<S, N>&) {
    for (int i = 0; i < N; ++i) r(i, i) = r(i, i) + a;
  }
  template <class S>
  static BOUGH_INLINE lanes::Mat<S, N, N> linear_rows(const Multiple<S>& x) {
    return x.f * lanes::Mat<S, N, N>::identity();
  }
  template <class S>
  static BOUGH_INLINE void add_spin_rows(lanes::Mat<S, N, N>&, const lanes::Vec<S, N>&, const Multiple<S>&) {}
  template <class C, class S>
  static BOUGH_INLINE lanes::Mat<S, N, N> gyroscopic(const lanes::Mat<C, N, N>&, const lanes::Vec<S, N>&) {
    return lanes::Mat<S, N, N>::zero();
  }
};

}  // namespace bough::motion
