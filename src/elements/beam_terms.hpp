#pragma once
/// Functions that tangents of beams share.
#include "bough/elements/port.hpp"

namespace bough::elements {

/// Which terms of a beam's tangent are present.
struct BeamTerms {
  bool moves;    ///< poses: all but a consistent start, whose unknowns are accelerations
  bool rates;    ///< velocities too
  bool viscous;  ///< velocities in strains
  template <class Beam>
  BeamTerms(const Beam& beam, bool has_poses, bool has_inertia)
      : moves(has_poses),
        rates(has_poses && has_inertia && (beam.has_mass || beam.has_damping)),
        viscous(has_poses && has_inertia && beam.has_damping) {}
  BeamTerms(bool has_poses, bool has_velocities, bool is_viscous)
      : moves(has_poses), rates(has_velocities), viscous(is_viscous) {}
};

/// How a - (R^T g; 0) of a port follows its own increment.
template <class G, class S>
BOUGH_INLINE typename G::template Map<S> weighed_slope(const PortMotionOn<G, S>& p, const PortSlopesOn<G, S>& slopes,
                                                       const SurroundingsOn<G, S>& around) {
  auto m = slopes.acceleration;
  if (slopes.moves) G::subtract_turned_back(m, G::turned_back(p.H, around.gravity));
  return m;
}

/// The wrench whose numbers stand there.
template <class G, class S>
BOUGH_INLINE typename G::template Wrench<S> wrench_at(const S* x) {
  typename G::template Vector<S> f;
  for (int k = 0; k < G::dof; ++k) f[k] = x[k];
  return G::wrench(f);
}

/// x += f y and x = y - x of blocks.
template <class A, class S, int N>
BOUGH_INLINE void add_scaled_to(lanes::Mat<S, N, N>& x, const A& f, const lanes::Mat<S, N, N>& y) {
  for (int i = 0; i < N * N; ++i) x.m[i] = lanes::multiply_add(f, y.m[i], x.m[i]);
}
template <class S, int N>
BOUGH_INLINE void subtract_from(const lanes::Mat<S, N, N>& y, lanes::Mat<S, N, N>& x) {
  for (int i = 0; i < N * N; ++i) x.m[i] = y.m[i] - x.m[i];
}

}  // namespace bough::elements
