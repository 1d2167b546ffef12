#pragma once
/// The inertial frame relative to which a step of generalized-alpha describes a node. Internal to step.
///
/// The rule adds velocities and accelerations in the axes of the node. A body that spins and flies has a constant
/// velocity V whose components R^T V turn with the body, so that the rule would bend its path by .14 w (w h)^2 V. A
/// change to another inertial frame is exact. Relative to one that moves with the mass centre of the node's bodies, and
/// falls with g where all of the scene flies, the body only turns, and the rule keeps its linear momentum to round-off.
/// Each step chooses such a frame for each node of what nothing ties to the ground. What is tied moves on circles rather
/// than on lines: twists in the axes of its nodes are constant in a steady rotation, for which the rule is exact.
#include "bough/elements/evaluate.hpp"
#include "bough/motion/vectors_on.hpp"
#include "bough/step/node_drift.hpp"

namespace bough::step {

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

/// The frame of a node with this pose and v. fall: g along the axes in which R is given.
template <class G, class S>
Drift<G, S> choose_drift(const typename G::template Pose<S>& H, const typename G::template Vector<S>& v,
                         const typename G::template Translation<S>& center, const S& flies,
                         const typename G::template Translation<S>& fall) {
  const typename G::template Translation<S> of_center = G::linear(v) + G::spin(v, center);
  return {flies * of_center, G::turned_back(H, fall)};
}

template <class G>
DriftChoice<G> make_drift_choice(const plan::Plan& plan, const NodeOrder& order);

}  // namespace bough::step
