#pragma once
/// Tangents of elements that have no closed form of their own: the residual's own source, run on jets.
#include "bough/elements/coupling.hpp"
#include "bough/elements/element_data.hpp"

namespace bough::elements {

template <class T, class G, class S>
typename G::template Pose<T> cast_pose(const typename G::template Pose<S>& H) {
  if constexpr (G::turns)
    return {lanes::cast<T>(H.R), lanes::cast<T>(H.x)};
  else
    return {{}, lanes::cast<T>(H.x)};
}

/// The motion of a port as jets in its increment eta: H exp(eta), and v + V eta of PortSlopesOn. Accelerations do not
/// follow, for elements without mass do not use them.
template <class T, class G, class S>
PortMotionOn<G, T> vary(const PortMotionOn<G, T>& p, const PortSlopesOn<G, S>& slopes) {
  using Vector = typename G::template Vector<S>;
  PortMotionOn<G, T> r = p;
  typename G::template Vector<T> eta;
  for (int j = 0; j < G::dof; ++j) eta[j] = T::variable(S(0.0), j);
  if (slopes.moves) r.H = G::compose(p.H, G::exp(eta));
  for (int j = 0; j < G::dof; ++j) {
    const Vector dv = G::vector_of_motion(G::times(slopes.velocity, G::motion(Vector::unit(j))));
    for (int i = 0; i < G::dof; ++i) r.v[i].d[j] = dv[i];
  }
  return r;
}

/// One port after the other is varied, so that jets are as short as can be. The residual is that of its own source on
/// plain numbers: jets round some products otherwise.
template <IsCatalogued E, class G, class S, class Put>
requires(!E::has_closed_tangent) void eval_tangent(const E& e, const PortMotionOn<G, S>* p,
                                                   const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around,
                                                   S* residual, const Put& put) {
  constexpr int P = E::num_ports, dof = G::dof;
  using T = lanes::Jet<S, dof>;
  eval_residual(e, p, around, residual);
  const SurroundingsOn<G, T> here{lanes::cast<T>(around.gravity), around.laws, around.has_inertia};
  PortMotionOn<G, T> still[P];
  for (int k = 0; k < P; ++k) {
    still[k].H = cast_pose<T, G, S>(p[k].H);
    still[k].v = lanes::cast<T>(p[k].v);
    still[k].a = lanes::cast<T>(p[k].a);
  }
  for (int varied = 0; varied < P; ++varied) {
    PortMotionOn<G, T> q[P];
    for (int k = 0; k < P; ++k) q[k] = k == varied ? vary<T, G, S>(still[k], ports[k]) : still[k];
    T out[P * dof];
    eval_residual(e, q, here, out);
    for (int k = 0; k < P; ++k) {
      typename G::template Matrix<S> block;
      for (int i = 0; i < dof; ++i)
        for (int j = 0; j < dof; ++j) block(i, j) = out[dof * k + i].d[j];
      put(k, varied, block);
    }
  }
}

}  // namespace bough::elements
