#pragma once
/// Kinematics of beams in terms of differences of the nodes' motions. With D = ad(d), the identities T(d) D = 1 -
/// exp(-D) and Ad(exp d)^-1 = exp(-D) turn the velocity field of a beam, Ad(exp d)^-1 v_r + T(d) d', into
///   v(s) = v_r + T(d) z,   z = sum_i N_i z_i,   z_i = T(d_i)^-1 (v_i - v_r),   d_i' = z_i + ad(d_i) v_r,
/// and likewise the virtual motions and the weight (R^T g; 0). No adjoint of a relative pose remains. Derivation:
/// data/manual/theory/beams.md, "Beam".
#include "bough/elements/beam.hpp"
#include "bough/motion/operators.hpp"

namespace bough::elements {

using motion::InverseTangent;
using motion::Tangent;

/// Relative motions of the nodes i != r and their rates. Members that the analysis does not need are left unset.
template <class G, class S, int N>
struct BeamRates {
  using Motion = typename G::template Motion<S>;
  InverseTangent<G, S> inverse[N];  ///< T(d_i)^-1
  Motion d[N];                      ///< log(H_r^-1 H_i)
  Motion w[N], c[N];                ///< v_i - v_r, b_i - b_r
  Motion z[N];                      ///< T(d_i)^-1 w_i
  Motion rate[N];                   ///< d_i'
  Motion zz[N];                     ///< T(d_i)^-1 c_i + (T(d_i)^-1)' w_i = z_i'
  Motion v, b;                      ///< twist of the reference node; its acceleration minus gravity
};

/// The acceleration that multiplies the mass: b = a - (R^T g; 0); in statics only the weight.
template <class G, class S>
typename G::template Motion<S> eval_weighed_acceleration(const PortMotionOn<G, S>& p,
                                                         const SurroundingsOn<G, S>& around) {
  const typename G::template Translation<S> lift = -G::turned_back(p.H, around.gravity);
  if (!around.has_inertia) return G::translation(lift);
  return G::add_translation(G::motion(p.a), lift);
}

/// Computes the relative motions only.
template <class G, class S, int N>
void eval_relative_motions(const PortMotionOn<G, S>* p, BeamRates<G, S, N>& b) {
  constexpr int r = beam_reference<N>;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    b.inverse[i] = motion::eval_log<G, S>(G::relative(p[r].H, p[i].H));
    b.d[i] = b.inverse[i].d;
  }
}

/// Computes rates and accelerations as well, where the analysis needs them.
template <class G, class S, int N>
void eval_beam_rates(const PortMotionOn<G, S>* p, const SurroundingsOn<G, S>& around, bool has_mass, bool has_damping,
                     BeamRates<G, S, N>& b) {
  constexpr int r = beam_reference<N>;
  eval_relative_motions<G, S, N>(p, b);
  const bool moves = around.has_inertia && (has_mass || has_damping);
  if (moves) {
    b.v = G::motion(p[r].v);
    for (int i = 0; i < N; ++i) {
      if (i == r) continue;
      b.w[i] = G::motion(p[i].v) - b.v;
      b.z[i] = times(b.inverse[i], b.w[i]);
      b.rate[i] = G::add_bracket(b.z[i], b.d[i], b.v);
    }
  }
  if (!has_mass) return;
  b.b = eval_weighed_acceleration(p[r], around);
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    b.c[i] = eval_weighed_acceleration(p[i], around) - b.b;
    if (N == 2) continue;  // screw_beam.hpp does not need these
    b.zz[i] = times(b.inverse[i], b.c[i]);
    if (moves) b.zz[i] = G::add(b.zz[i], 1.0, slope_times(b.inverse[i], b.rate[i], b.w[i]));
  }
}

/// sum_i w_i x_i over the nodes other than the reference.
template <class G, class S, int N>
typename G::template Motion<S> blend(const double* w, const typename G::template Motion<S>* x) {
  constexpr int r = beam_reference<N>, first = r == 0 ? 1 : 0;
  typename G::template Motion<S> sum = G::scaled(w[first], x[first]);
  for (int i = first + 1; i < N; ++i)
    if (i != r) sum = G::add(sum, w[i], x[i]);
  return sum;
}

}  // namespace bough::elements
