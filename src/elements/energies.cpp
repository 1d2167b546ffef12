#include "bough/elements/energies.hpp"

#include "bough/elements/beam_forces.hpp"
#include "emit.hpp"
#include "ports_from_inertial.hpp"

namespace bough::elements {

namespace {

template <class S, class C>
Vec3<C> centre_moment(const motion::Frame<S>&, const Mat6<C>& mass) {
  return {{mass(5, 1), mass(3, 2), mass(4, 0)}};
}
template <class S, class C>
motion::Vec2<C> centre_moment(const motion::PlanePose<S>&, const motion::Mat3<C>& mass) {
  return {{mass(2, 1), -mass(2, 0)}};
}
template <class S, class C, int N>
lanes::Vec<C, N> centre_moment(const motion::Place<S, N>&, const lanes::Mat<C, N, N>&) {
  return lanes::Vec<C, N>::zero();  // what cannot turn is seen at its centre
}

/// A mass given by its matrix in a frame at H, `w` times. centre_moment: mass times the centre.
template <class G, class S, class Mass, class W>
void add_mass(const Mass& mass, const W& w, const typename G::template Pose<S>& H,
              const typename G::template Translation<S>& anchor, EnergiesOn<G, S>& sum) {
  typename G::template Translation<S> moment;
  const auto of_centre = centre_moment(H, mass);
  for (int i = 0; i < G::translations; ++i) moment[i] = w * of_centre[i];
  const S all = w * mass(0, 0);
  sum.mass = sum.mass + all;
  sum.mass_moment += all * (H.x + anchor) + G::turned(H, moment);
}

/// Momentum m v of a mass that moves with the twist v, both in the axes at H.
template <class G, class S>
void add_momentum(const typename G::template Wrench<S>& momentum, const typename G::template Pose<S>& H,
                  const typename G::template Motion<S>& v, const typename G::template Translation<S>& anchor,
                  EnergiesOn<G, S>& sum) {
  sum.kinetic = sum.kinetic + 0.5 * G::real_power(momentum, v);
  sum.momentum += to_origin(H, anchor, typename G::template Vector<S>(G::vector_of_wrench(momentum)));
}

/// Half of n . (e - e0), n = K (e - e0), per length.
template <class G, class S, int N, class C>
S strain_energy_at(const BeamOn<G, N, C>& beam, const typename G::template Motion<S>& slope, int point) {
  const C inverse = 1.0 / beam.length;
  const auto strain = G::strain(inverse, slope, beam.reference_strain[point]);
  return 0.5 * G::real_power(G::matrix_times(beam.stiffness, strain), strain);
}

template <class G, class S, int N, class C>
void add_energies(const BeamOn<G, N, C>& beam, const PortMotionOn<G, S>* p,
                  const typename G::template Translation<S>& anchor, const SurroundingsOn<G, S>& around, const C&,
                  EnergiesOn<G, S>& sum) {
  BeamRates<G, S, N> b;
  const bool moves = around.has_inertia && beam.has_mass;
  eval_beam_rates<G, S, N>(p, around, false, moves, b);
  const auto& strains = strain_rule<N>();
  for (int g = 0; g < N - 1; ++g) {
    auto slope = blend<G, S, N>(strains.slope[g], b.d);
    if constexpr (N > 2)  // with two nodes, d' is parallel to d, and T(d) d = d
      slope = times(motion::eval_tangent_operator<G, S>(blend<G, S, N>(strains.shape[g], b.d)), slope);
    sum.strain = sum.strain + (strains.weight[g] * beam.length) * strain_energy_at<G, S, N, C>(beam, slope, g);
  }
  if (!beam.has_mass) return;
  const auto& rule = mass_rule<N>();
  for (int g = 0; g < BeamOn<G, N, C>::num_mass_points; ++g) {
    const C w = rule.weight[g] * beam.length;
    const auto d = blend<G, S, N>(rule.shape[g], b.d);
    const auto H = G::compose(p[beam_reference<N>].H, G::exp(typename G::template Vector<S>(G::vector_of_motion(d))));
    if (moves) {
      const auto T = motion::eval_tangent_operator<G, S>(d);
      const typename G::template Motion<S> v = b.v + times(T, blend<G, S, N>(rule.shape[g], b.z));
      add_momentum<G, S>(G::scaled(w, G::matrix_times(beam.mass, v)), H, v, anchor, sum);
    }
    add_mass<G, S>(beam.mass, w, H, anchor, sum);
  }
}

template <class G, class S, class C>
void add_energies(const RigidBodyOn<G, C>& body, const PortMotionOn<G, S>* p,
                  const typename G::template Translation<S>& anchor, const SurroundingsOn<G, S>& around, const C&,
                  EnergiesOn<G, S>& sum) {
  const typename G::template Motion<S> v = G::motion(p[0].v);
  if (around.has_inertia) add_momentum<G, S>(G::matrix_times(body.mass, v), p[0].H, v, anchor, sum);
  add_mass<G, S>(body.mass, C(1.0), p[0].H, anchor, sum);
}

template <IsCatalogued E, class G, class S>
void add_energies(const E& e, const PortMotionOn<G, S>* p, const typename G::template Translation<S>&,
                  const SurroundingsOn<G, S>& around, const S&, EnergiesOn<G, S>& sum) {
  if constexpr (requires { eval_strain_energy(e, p, around.laws); })
    sum.strain = eval_strain_energy(e, p, around.laws);
  else
    sum.strain = eval_strain_energy(e, p);
}
template <class G, class S, class C>
void add_energies(const JointOn<G, C>& e, const PortMotionOn<G, S>* p, const typename G::template Translation<S>&,
                  const SurroundingsOn<G, S>&, const C& turns, EnergiesOn<G, S>& sum) {
  sum.strain = eval_strain_energy(e, p, turns);
}

template <class E, class G, class S>
EnergiesOn<G, S> energies_of(const E& e, const FieldOn<G, S>& field, const S& turns) {
  PortMotionOn<G, S> p[E::num_ports];
  typename G::template Translation<S> anchor;
  eval_ports_from_inertial(e, field, p, anchor);
  EnergiesOn<G, S> sum;
  add_energies(e, p, anchor, field.around, turns, sum);
  return sum;
}

}  // namespace

template <class E>
EnergiesOn<typename E::Group, double> eval_energies(const E& e, const FieldOn<typename E::Group, double>& field,
                                                    double turns) {
  return energies_of<E, typename E::Group, double>(e, field, turns);
}

template <class E>
void eval_energies_lanes(const LaneElement<E>& e, const FieldOn<typename E::Group, LanePack>& field,
                         const LanePack& turns, EnergiesOn<typename E::Group, LanePack>& out) {
  out = energies_of<LaneElement<E>, typename E::Group, LanePack>(e, field, turns);
}

template <class E>
constexpr auto energies_of_part = detail::emitted_if<E::role != Role::load>([]<class T = E>() {
  return std::tuple{&eval_energies<T>, &eval_energies_lanes<T>};
});
BOUGH_EMIT_ON_EVERY_GROUP(energies_of_part, ElementsOn)

}  // namespace bough::elements
