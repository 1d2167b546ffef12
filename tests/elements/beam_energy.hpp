#pragma once
/// Energies of beams and bodies in space, in any scalar, from relative poses and adjoints of them: the library computes
/// forces and energies from differences of twists (BeamRates), which is another way to the same sections.
#include "bough/elements/beam.hpp"
#include "bough/elements/body.hpp"

namespace bough::elements::check {

/// Pose relative to the reference node of the section at parameter weights `shape`, and its twist.
template <class S>
struct Section {
  Frame<S> relative;
  Vec6<S> v;
};
/// v = Ad(exp d)^-1 v_r + T(d) d'
template <class S, int N>
Section<S> section_at(const double* shape, const BeamShape<S, N>& b, const Vec6<S>* rate, const PortMotion<S>* p) {
  const Vec6<S> d = blend<S, N>(shape, b.d);
  const Frame<S> relative = motion::exp_se3(d);
  return {relative, motion::inverse_adjoint_times(relative, p[Beam<N>::reference].v) +
                        motion::tangent_times(d, blend<S, N>(shape, rate))};
}

template <class S, int N>
S strain_energy_of(const Beam<N>& beam, const PortMotion<S>* ports) {
  const BeamShape<S, N> b = eval_shape<S, N>(ports);
  S sum(0.0);
  for (int g = 0; g < Beam<N>::num_strain_points; ++g) {
    Vec6<S> e = eval_strain<S, N>(b, beam.length, g);
    for (int k = 0; k < 6; ++k) e[k] = e[k] - beam.reference_strain[g][k];
    sum = sum + (0.5 * strain_rule<N>().weight[g] * beam.length) * lanes::dot(e, Vec6<S>(beam.stiffness * e));
  }
  return sum;
}

template <class S, int N>
S kinetic_energy_of(const Beam<N>& beam, const PortMotion<S>* ports) {
  const BeamShape<S, N> b = eval_shape<S, N>(ports);
  Vec6<S> rate[N];
  eval_shape_rates<S, N>(b, ports, rate);
  const auto& rule = mass_rule<N>();
  S sum(0.0);
  for (int g = 0; g < Beam<N>::num_mass_points; ++g) {
    const Vec6<S> v = section_at<S, N>(rule.shape[g], b, rate, ports).v;
    sum = sum + (0.5 * rule.weight[g] * beam.length) * lanes::dot(v, Vec6<S>(beam.mass * v));
  }
  return sum;
}
template <class S>
S kinetic_energy_of(const RigidBody& body, const PortMotion<S>* p) {
  return 0.5 * lanes::dot(p[0].v, Vec6<S>(body.mass * p[0].v));
}

}  // namespace bough::elements::check
