#pragma once
/// Elastic and viscous coupling of all relative motions of two frames.
#include "bough/elements/coupling.hpp"
#include "bough/elements/relative_force.hpp"
#include "bough/elements/screw_beam.hpp"

namespace bough::elements {

/// With d = log(H_a^-1 H_b):
///   F_b = T(d)^-T (k K (d - d0) + D d'),  F_a = -Ad(H_ab^-1)^T F_b,
/// with a factor k of the stiffness alone [-]: the value of a law, or 1. With k = 1 it is equivalent to a two-node beam
/// of length 1 without mass.
template <class G, class C = double>
struct BushingOn : CouplingOn<G, C> {
  using Matrix = typename G::template Matrix<C>;
  Matrix stiffness = Matrix::zero(), damping = Matrix::zero();
  int factor = -1;  ///< the law that is k; -1: k = 1
  typename G::template Vector<C> rest = G::template Vector<C>::zero();
  bool has_damping = false;

  static constexpr Cost cost{240e-9, 870e-9, 33e-9, 184e-9};
  static constexpr bool has_stiffness_matrix = true, has_closed_tangent = true;
  static constexpr scene::CouplingStart start = scene::CouplingStart::frame;
  static constexpr CouplingWords words{
      "bushings", "bushing",
      "Elastic and viscous coupling of all relative motions of two frames: of the origin of the second as seen from "
      "the first, and of its rotation; both in the axes of the first, wherever those of the second are drawn. At rest "
      "at the start.",
      "One side.", "The other side."};
  static constexpr auto declared() {
    return std::tuple{
        elements::matrix("stiffness", &BushingOn::stiffness, "N/m, N or N m/rad", "Stiffness."),
        elements::matrix("damping", &BushingOn::damping, "N s/m, N s or N m s/rad", "Damping of rates."),
        law("stiffness_factor", &BushingOn::factor, "stiffness", "Factor of the stiffness alone, which changes.")};
  }
  template <class A, class B, class Visit>
  static void visit_data(A& a, B& b, Visit& visit) {
    visit.flag(a.has_damping, b.has_damping);
    visit.vector(a.rest, b.rest);
    visit_declared(a, b, visit);
  }
};
template <class G, class C>
inline constexpr bool exists<BushingOn<G, C>> = G::turns;
using Bushing = BushingOn<motion::Se3>;

template <class G, class C>
bool looks_at_rates(const BushingOn<G, C>& e) {
  return e.has_damping;
}
template <class G, class C>
int stiffness_law(const BushingOn<G, C>& e) {
  return e.factor;
}
inline void take_start(Bushing& e, const Frame<double>& at_start) {
  e.has_damping = std::any_of(std::begin(e.damping.m), std::end(e.damping.m), [](double x) { return x != 0.0; });
  e.rest = motion::Se3::log(at_start);
}

/// The force conjugate to d,  n = k K (d - d0) + D d'.
template <class G, class S, class C>
BOUGH_INLINE typename G::template Wrench<S> eval_resultant(const BushingOn<G, C>& e, const ScrewRates<G, S>& r,
                                                           const SurroundingsOn<G, S>& around, bool viscous) {
  auto n = G::matrix_times(e.stiffness, G::strain(C(1.0), r.inverse.d, e.rest));
  if (e.factor >= 0) n = G::scaled(around.laws[e.factor], n);
  if (viscous) n = G::add(n, C(1.0), G::matrix_times(e.damping, r.rate));
  return n;
}

template <class G, class S, class C>
BOUGH_INLINE void eval_residual(const BushingOn<G, C>& bushing, const PortMotionOn<G, S>* p,
                                const SurroundingsOn<G, S>& around, S* out) {
  const bool viscous = around.has_inertia && bushing.has_damping;
  ScrewRates<G, S> r;
  eval_screw_rates<G, S>(p, around, false, viscous, r);
  const auto n = eval_resultant<G, S>(bushing, r, around, viscous);
  put_screw_wrenches<G, S>(r, n, out);
}

/// Strain energy at k = 1: its derivative by k [J].
template <class G, class S, class C>
S eval_energy_by_factor(const BushingOn<G, C>& bushing, const PortMotionOn<G, S>* p) {
  const auto inverse = motion::eval_log<G, S>(G::relative(p[0].H, p[1].H));
  typename G::template Vector<S> d = G::vector_of_motion(inverse.d);
  for (int k = 0; k < G::dof; ++k) d[k] = d[k] - bushing.rest[k];
  const typename G::template Vector<S> n = bushing.stiffness * d;
  return 0.5 * lanes::dot(d, n);
}
/// laws: values of all laws, used where one is the factor.
template <class G, class S, class C>
S eval_strain_energy(const BushingOn<G, C>& bushing, const PortMotionOn<G, S>* p, const Constant<S>* laws) {
  const S energy = eval_energy_by_factor(bushing, p);
  return bushing.factor < 0 ? energy : S(laws[bushing.factor] * energy);
}

/// f = U^T n,  n = k K (d - d0) + D U xi,  U = T(d)^-1,  dd = U zeta (see relative_force.hpp).
template <class G, class S, class C, class Put>
BOUGH_INLINE void eval_tangent(const BushingOn<G, C>& bushing, const PortMotionOn<G, S>* p,
                               const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                               const Put& put) {
  const bool viscous = around.has_inertia && bushing.has_damping;
  ScrewRates<G, S> r;
  eval_screw_rates<G, S>(p, around, false, viscous, r);
  const auto n = eval_resultant<G, S>(bushing, r, around, viscous);
  RelativeForce<G, S> e;
  e.Q = G::inverse_adjoint_map(G::relative(p[0].H, p[1].H));
  e.f = put_screw_wrenches<G, S>(r, n, residual);
  const auto U = matrix(r.inverse);
  auto n_d = lanes::cast<S>(bushing.stiffness);
  if (bushing.factor >= 0) n_d = around.laws[bushing.factor] * n_d;
  if (viscous) {
    e.has_twist = true;
    const auto xi = G::motion(p[1].v) - G::times(e.Q, G::motion(p[0].v));
    G::add_block_product(n_d, bushing.damping, jacobian(r.inverse, xi));
    e.by_twist = G::transposed_product(U, G::block_product(bushing.damping, U));
  }
  auto f_d = G::transposed_product(U, n_d);
  G::add_wrench_map(f_d, transpose_jacobian(r.inverse, n));
  e.by_pose = G::block_product(f_d, U);
  carry_to_ports<G, S>(e, p, ports, put);
}

}  // namespace bough::elements
