#pragma once
/// What forces of beams look at, in differences of the nodes' motions. With D = ad(d), T(d) D = 1 - exp(-D) and
/// Ad(exp d)^-1 = exp(-D) turn the velocity field of a beam, Ad(exp d)^-1 v_r + T(d) d', into
///   v(s) = v_r + T(d) z,   z = sum_i N_i z_i,   z_i = T(d_i)^-1 (v_i - v_r),   d_i' = z_i + ad(d_i) v_r,
/// and the same for virtual motions and for the weight (R^T g; 0). No adjoint of a relative pose is left. Derivation: README.md, "Beam".
#include "bough/elements/beam.hpp"
#include "bough/motion/dual_series.hpp"

namespace bough::elements {

using motion::Dual;
using motion::DualMat;
using motion::DualSeries;
using motion::DualVec;

/// Relative motions of the nodes i != r and their rates, as dual vectors.
template <class S, int N>
struct BeamRates {
  DualSeries<S> inverse[N];  ///< T(d_i)^-1
  DualVec<S> d[N];           ///< log(H_r^-1 H_i)
  DualVec<S> w[N], c[N];     ///< v_i - v_r, b_i - b_r
  DualVec<S> z[N];           ///< T(d_i)^-1 w_i
  DualVec<S> rate[N];        ///< d_i'
  DualVec<S> zz[N];          ///< T(d_i)^-1 c_i + (T(d_i)^-1)' w_i = z_i'
  DualVec<S> v, b;           ///< twist of the reference; its acceleration less that of gravity
};

/// What masses look at: b = a - (R^T g; 0); in statics the weight alone.
template <class S>
DualVec<S> eval_weighed_acceleration(const PortMotion<S>& p, const Surroundings<S>& around) {
  const Vec3<S> weight = lanes::transpose_times(p.H.R, around.gravity);
  if (!around.has_inertia) return {Vec3<S>::zero(), -weight};
  return {lanes::angular_part(p.a), lanes::linear_part(p.a) - weight};
}

/// Relative motions alone.
template <class S, int N>
void eval_relative_motions(const PortMotion<S>* p, BeamRates<S, N>& b) {
  constexpr int r = Beam<N>::reference;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const Frame<S> H = motion::relative(p[r].H, p[i].H);
    const Vec3<S> psi = motion::log_so3(H.R);
    const S x = lanes::dot(psi, psi);
    const auto k = motion::eval_inverse_coefficients(x);
    const Vec3<S> turned = k.k * lanes::cross(psi, H.x) - 0.5 * H.x;
    b.d[i] = {psi, motion::add_cross(H.x, psi, turned)};  // T(psi)^-T x
    b.inverse[i] = motion::dual_inverse_tangent(b.d[i], x, k);
  }
}

/// Rates and accelerations too, as far as they are looked at.
template <class S, int N>
void eval_beam_rates(const PortMotion<S>* p, const Surroundings<S>& around, bool has_mass, bool has_damping,
                     BeamRates<S, N>& b) {
  constexpr int r = Beam<N>::reference;
  eval_relative_motions<S, N>(p, b);
  const bool moves = around.has_inertia && (has_mass || has_damping);
  if (moves) {
    b.v = motion::motion_dual(p[r].v);
    for (int i = 0; i < N; ++i) {
      if (i == r) continue;
      b.w[i] = motion::motion_dual(p[i].v) - b.v;
      b.z[i] = times(b.inverse[i], b.w[i]);
      b.rate[i] = add_cross(b.z[i], b.d[i], b.v);
    }
  }
  if (!has_mass) return;
  b.b = eval_weighed_acceleration(p[r], around);
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    b.c[i] = eval_weighed_acceleration(p[i], around) - b.b;
    if (N == 2) continue;  // screw_blend.hpp does without
    b.zz[i] = times(b.inverse[i], b.c[i]);
    if (moves) b.zz[i] = b.zz[i] + slope_times(b.inverse[i], b.rate[i], b.w[i]);
  }
}

/// sum_i w_i x_i over the nodes other than the reference.
template <class S, int N>
DualVec<S> blend(const double* w, const DualVec<S>* x) {
  constexpr int r = Beam<N>::reference;
  DualVec<S> sum = motion::scaled(w[r == 0 ? 1 : 0], x[r == 0 ? 1 : 0]);
  for (int i = 1; i < N; ++i)
    if (i != r && !(r == 0 && i == 1)) sum = add_scaled(sum, w[i], x[i]);
  return sum;
}

}  // namespace bough::elements
