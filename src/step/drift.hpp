#pragma once
/// The inertial frame relative to which a step of generalized-alpha describes a node. Internal to step.
///
/// The rule adds velocities and accelerations in the axes of the node. A body that spins and flies has a constant
/// velocity V whose components R^T V turn with the body, so that the rule would bend its path by .14 w (w h)^2 V. A
/// change to another inertial frame is exact. Relative to one that moves with the mass centre of an assembly, and falls
/// with g where all of the scene flies, a rigid assembly only turns: each of its nodes has a constant twist in a steady
/// rotation, for which the rule is exact, and linear momentum is kept to round-off. Each step chooses such a frame for
/// each assembly of what nothing ties to the ground. Beams and joints make an assembly; couplings do not, since what
/// they couple may spin at different rates. What is tied moves about points at rest: the frame of the
/// ground is its own.
#include "bough/elements/evaluate.hpp"
#include "bough/motion/vectors_on.hpp"
#include "bough/step/node_drift.hpp"
#include "bough/step/state.hpp"

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

/// The frame of a node with these axes. velocity: of its assembly, and fall: g, along the axes in which R is given.
template <class G, class S>
Drift<G, S> drift_at(const typename G::template Pose<S>& H, const typename G::template Translation<S>& velocity,
                     const typename G::template Translation<S>& fall) {
  return {G::turned_back(H, velocity), G::turned_back(H, fall)};
}

/// Velocities of the mass centres of all assemblies: sum of R (m v + w x m c), over the sum of m.
template <class G>
void find_frames(const DriftChoice<G>& choice, const NodesOn<G>& nodes, const NodeOrder& order,
                 std::vector<typename G::template Translation<double>>& frames);

template <class G>
DriftChoice<G> make_drift_choice(const plan::Plan& plan, const NodeOrder& order);

}  // namespace bough::step
