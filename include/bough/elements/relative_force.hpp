#pragma once
/// Couplings of two ports whose force f on the second is a function of the relative motion H = H_a^-1 H_b and of the
/// relative twist xi = v_b - Q v_a alone, Q = Ad(H)^-1. So it is differentiated in those and carried to the ports:
///   zeta = eta_b - Q eta_a,   dxi = dv_b - Q dv_a - ad(Q v_a) zeta,   F_a = -Q^T f,   dF_a = -Q^T (df - hat(f) zeta).
#include "bough/elements/port.hpp"

namespace bough::elements {

/// The force on the second port and its derivatives by zeta and, if it `has_twist`, by xi; otherwise `by_twist` is not
/// used.
template <class G, class S>
struct RelativeForce {
  typename G::template Map<S> Q;  ///< Ad(H)^-1
  typename G::template Wrench<S> f;
  typename G::template Matrix<S> by_pose = G::template Matrix<S>::zero();
  typename G::template Matrix<S> by_twist = G::template Matrix<S>::zero();
  bool has_twist = false;
};

/// Blocks of the ports' increments as put(i, j, block).
template <class G, class S, class Put>
void carry_to_ports(const RelativeForce<G, S>& e, const PortMotionOn<G, S>* p, const PortSlopesOn<G, S>* ports,
                    const Put& put) {
  using Block = typename G::template Matrix<S>;
  using Map = typename G::template Map<S>;
  const Map minus = G::negated(e.Q);
  const bool moves = ports[0].moves;
  Block first = Block::zero(), second = Block::zero();
  if (moves) {
    second = e.by_pose;
    if (e.has_twist) G::add_block_product(second, e.by_twist, G::ad(-G::times(e.Q, G::motion(p[0].v))));
    first = G::block_product(second, minus);
  }
  if (e.has_twist) {
    G::add_block_product(second, e.by_twist, ports[1].velocity);
    G::add_block_product(first, e.by_twist, G::product(minus, ports[0].velocity));
  }
  put(1, 0, first);
  put(1, 1, second);
  if (moves) {
    const auto turned = G::hat(e.f);
    G::add_wrench_product(first, turned, e.Q);
    G::add_wrench_map(second, G::hat(-e.f));
  }
  put(0, 0, G::transposed_product(minus, first));
  put(0, 1, G::transposed_product(minus, second));
}

}  // namespace bough::elements
