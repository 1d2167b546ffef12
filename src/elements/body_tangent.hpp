#pragma once
/// Tangents of rigid bodies and point loads, as put(i, j, block) of the ports' increments.
#include "beam_terms.hpp"
#include "bough/elements/body.hpp"

namespace bough::elements {

/// dF = M (da - d(R^T g)) - (ad(v)^T M + hat(M v)) dv; of a point df = m (du' - d(R^T g)) + m (w x du + dw x u)
/// without moments.
template <class G, class S, class C, class Put>
BOUGH_INLINE void eval_tangent(const RigidBodyOn<G, C>& body, const PortMotionOn<G, S>* p,
                               const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                               const Put& put) {
  using Block = typename G::template Matrix<S>;
  eval_residual(body, p, around, residual);
  const auto a = weighed_slope(p[0], ports[0], around);
  const bool rates = around.has_inertia && ports[0].moves;
  if (is_seen_as_point(body)) {
    auto rows = G::linear_rows(a);
    if (rates && G::turns) G::add_spin_rows(rows, p[0].v, ports[0].velocity);
    Block block = Block::zero();
    for (int i = 0; i < G::translations; ++i)
      for (int j = 0; j < G::dof; ++j) block(i, j) = body.mass(0, 0) * rows(i, j);
    return put(0, 0, block);
  }
  Block block = G::block_product(body.mass, a);
  if (rates) G::add_block_product(block, G::gyroscopic(body.mass, G::motion(p[0].v)), ports[0].velocity);
  put(0, 0, block);
}

/// The components of a dead load in the axes of the port turn against the port's rotation.
template <class G, class S, class C, class Put>
BOUGH_INLINE void eval_tangent(const PointLoadOn<G, C>& load, const PortMotionOn<G, S>* p,
                               const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                               const Put& put) {
  eval_residual(load, p, around, residual);
  auto block = G::template Matrix<S>::zero();
  if (!load.follows && ports[0].moves) G::add_turning(block, wrench_at<G>(residual));
  put(0, 0, block);
}

}  // namespace bough::elements
