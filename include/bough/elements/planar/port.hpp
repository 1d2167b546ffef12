#pragma once
/// Elements that move in a plane: the same as those of the layer for motions (u; theta) on SE(2), three unknowns a node. A node's planar
/// frame is its own turned about fixed axes so that the third is normal to the plane (plan::NodeUnknowns), positions are coordinates in
/// the plane.
#include <complex>

#include "bough/elements/evaluate.hpp"
#include "bough/motion/se2.hpp"

namespace bough::elements::planar {

using motion::PlaneLog;
using motion::PlaneMotion;
using motion::Vec2;

/// Position in the plane, a pair as motion::PositionPair [m].
template <class S>
struct PairOf {
  Vec2<S> hi, lo;
};

/// As NodeMotionOf: turn (cos, sin), position, twist (linear; angular) in own axes, its derivative, increment since the last accepted step.
template <class S>
struct NodeOf {
  Vec2<S> turn;
  PairOf<S> x;
  Vec3<S> v, a, dq;
};
using Node = NodeOf<double>;

template <class C>
struct PortOf {
  int node = ground;
  bool has_offset = false;
  Vec2<C> turn{{C(1.0), C(0.0)}};  ///< of the port's frame in the node's (on the ground: in the plane's axes)
  Vec2<C> x{{C(0.0), C(0.0)}};     ///< of its origin [m]
};
using Port = PortOf<double>;

template <class S>
struct PortMotion {
  Vec2<S> turn, x;  ///< x relative to the element's anchor
  Vec3<S> v, a;
};

/// Scalar of what an element does not differentiate by: its constants, laws and multipliers.
template <class S>
struct BaseOf {
  using Type = S;
};
template <class S, int N>
struct BaseOf<lanes::Jet<S, N>> {
  using Type = S;
};
template <>
struct BaseOf<std::complex<double>> {
  using Type = double;
};
template <class S>
using Base = typename BaseOf<S>::Type;

template <class S>
struct Surroundings {
  Vec2<S> gravity;  ///< in the plane's axes [m/s^2]
  const Base<S>* laws = nullptr;
  bool has_inertia = true;
};

template <class S>
struct FieldOf {
  const NodeOf<S>* nodes = nullptr;
  Surroundings<S> around;
  Slopes slopes;
};
using Field = FieldOf<double>;

/// Relative pose of two ports: turn and position in the first's axes.
template <class S>
struct Relative {
  Vec2<S> turn, x;
};
template <class S>
Relative<S> relative(const PortMotion<S>& a, const PortMotion<S>& b) {
  return {motion::conjugate_times(a.turn, b.turn), motion::conjugate_times(a.turn, Vec2<S>(b.x - a.x))};
}
/// Ad(H)^-1 V of a frame at (turn, x) in the one that V belongs to.
template <class A, class S>
Vec3<S> seen_from(const Vec2<A>& turn, const Vec2<A>& x, const Vec3<S>& v) {
  const Vec2<S> here{{v[0] - v[2] * x[1], v[1] + v[2] * x[0]}};
  return motion::join(motion::conjugate_times(turn, here), v[2]);
}
/// Ad(H)^-T F: a wrench at the frame as one at the other's origin.
template <class A, class S>
Vec3<S> carried_back(const Vec2<A>& turn, const Vec2<A>& x, const Vec3<S>& f) {
  const Vec2<S> turned = motion::complex_times(turn, motion::plane_part(f));
  return motion::join(turned, S(f[2] + (x[0] * turned[1] - x[1] * turned[0])));
}

}  // namespace bough::elements::planar
