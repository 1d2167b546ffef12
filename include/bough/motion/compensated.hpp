#pragma once
/// Positions as sums of two numbers, so that differences of positions far from the origin stay accurate. At 200 m a
/// double resolves 3e-14 m, which limits the strain of an element of 1 m to a resolution of 3e-14; the pair resolves
/// 1e-30 m. Sums are exact under round-to-nearest without contraction or reassociation (-ffp-contract=off, no
/// fast-math).
#include "bough/motion/se3.hpp"

namespace bough::motion {

/// s + e = a + b exactly, s the rounded sum (Knuth's TwoSum).
template <class S>
void two_sum(const S& a, const S& b, S& s, S& e) {
  s = a + b;
  const S bb = s - a;
  e = (a - (s - bb)) + (b - bb);
}

/// A position hi + lo [m], |lo| at most half an ulp of hi.
template <class S, int N = 3>
struct PositionPair {
  using Vector = lanes::Vec<S, N>;
  Vector hi, lo;

  static PositionPair from(const Vector& x) { return {x, Vector::zero()}; }
  Vector rounded() const { return hi; }
  /// Adds a displacement, in the same axes.
  void add(const Vector& step) {
    for (int i = 0; i < N; ++i) {
      S s, e;
      two_sum(hi[i], step[i], s, e);
      two_sum(s, S(lo[i] + e), hi[i], lo[i]);
    }
  }
};
using Vec3Pair = PositionPair<double>;

/// a - b rounded once.
template <class S, int N>
lanes::Vec<S, N> difference(const PositionPair<S, N>& a, const PositionPair<S, N>& b) {
  lanes::Vec<S, N> r;
  for (int i = 0; i < N; ++i) {
    S s, e;
    two_sum(a.hi[i], S(-b.hi[i]), s, e);
    r[i] = s + (e + (a.lo[i] - b.lo[i]));
  }
  return r;
}

/// Frame whose origin is a pair.
template <class S>
struct PreciseFrame {
  Mat3<S> R;
  PositionPair<S> x;
  static PreciseFrame from(const Frame<S>& H) { return {H.R, PositionPair<S>::from(H.x)}; }
  Frame<S> rounded() const { return {R, x.rounded()}; }
};
/// H_a^-1 H_b. The accuracy of the relative position does not depend on the distance to the origin.
template <class S>
Frame<S> relative(const PreciseFrame<S>& a, const PreciseFrame<S>& b) {
  return {transpose_times(a.R, b.R), transpose_times(a.R, difference(b.x, a.x))};
}
/// H exp(eta): the origin moves by R exp(eta).x.
template <class S>
PreciseFrame<S> moved(const PreciseFrame<S>& H, const Vec6<S>& eta) {
  const Frame<S> step = exp_se3(eta);
  PreciseFrame<S> r{H.R * step.R, H.x};
  r.x.add(H.R * step.x);
  return r;
}

}  // namespace bough::motion
