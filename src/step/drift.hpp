#pragma once
/// The inertial frame relative to which a step of generalized-alpha describes a node. Internal to step.
///
/// The rule adds velocities and accelerations in the axes of the node. A body that spins and flies has a constant
/// velocity V whose components R^T V turn with the body, so that the rule would bend its path by .14 w (w h)^2 V. A
/// change to another inertial frame is exact. Relative to one that moves with V and falls with g, the body only turns,
/// and the rule keeps its linear momentum to round-off. Each step chooses such a frame for each node:
///   V = v_c + (w x s) / (w^2 + e^2),   s = v_c' + w x v_c - R^T g,   e h = least_turn,
/// with the velocity v_c and the specific acceleration s of the mass centre of the node's bodies. The second term is
/// the velocity of the centre of curvature of the node's path: relative to a frame that moves with it, a node on a
/// circle has a constant twist, for which the rule is exact. In free flight s and this term are zero.
#include "bough/elements/evaluate.hpp"
#include "bough/motion/vectors_on.hpp"
#include "bough/step/node_drift.hpp"

namespace bough::step {

/// Turn of a node in one step above which its frame follows the centre of curvature [rad]: e regularises V for nodes
/// that turn more slowly, whose centripetal acceleration has a relative error of the order of the square of this turn.
inline constexpr double least_turn = 0.01;

/// A frame that drifts, in the axes of the node whose frame it is.
template <class G, class S>
struct Drift {
  using Vector = typename G::template Vector<S>;
  using Translation = typename G::template Translation<S>;
  Translation velocity, fall;  ///< b = R^T V and c = R^T g

  /// b' = c - w x b
  Translation rate(const Vector& v) const { return fall - G::spin(v, velocity); }
  /// b'' = -w' x b - w x (b' + c), as c' = -w x c
  Translation second(const Vector& v, const Vector& a) const {
    return -G::spin(a, velocity) - G::spin(v, Translation(rate(v) + fall));
  }
};

/// v - (u; 0)
template <class G, class S>
typename G::template Vector<S> without(typename G::template Vector<S> v, const typename G::template Translation<S>& u) {
  for (int i = 0; i < G::translations; ++i) v[i] = v[i] - u[i];
  return v;
}

/// The frame of a node with this pose, v and dv/dt. fall: g along the axes in which R is given. least_square: e^2.
template <class G, class S>
Drift<G, S> choose_drift(const typename G::template Pose<S>& H, const typename G::template Vector<S>& v,
                         const typename G::template Vector<S>& a, const typename G::template Translation<S>& center,
                         const typename G::template Translation<S>& fall, double least_square) {
  using Translation = typename G::template Translation<S>;
  Drift<G, S> drift;
  drift.fall = G::turned_back(H, fall);
  const Translation u = G::linear(v) + G::spin(v, center);
  const Translation s = G::linear(a) + G::spin(a, center) + G::spin(v, u) - drift.fall;
  const S share = S(1.0) / (S(least_square) + motion::VectorsOn<G>::template angular_square<S>(v));
  drift.velocity = u + share * G::spin(v, s);
  return drift;
}

template <class G>
DriftChoice<G> make_drift_choice(const plan::Plan& plan, const NodeOrder& order);

}  // namespace bough::step
