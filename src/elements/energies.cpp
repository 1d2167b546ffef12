#include "bough/elements/energies.hpp"

#include "ports_from_inertial.hpp"

namespace bough::elements {

namespace {

/// A mass given by its 6x6 mass in the frame of p, `w` times.
template <class S, class C, class W>
void add_mass(const Mat6<C>& mass, const W& w, const PortMotion<S>& p, const Vec3<S>& anchor, EnergiesOf<S>& sum) {
  const Vec3<S> moment{{w * mass(5, 1), w * mass(3, 2), w * mass(4, 0)}};  // mass times the centre
  const S all = w * mass(0, 0);
  sum.mass = sum.mass + all;
  sum.mass_moment += all * (p.H.x + anchor) + p.H.R * moment;
}

template <class S>
void add_momentum(const Vec6<S>& momentum, const PortMotion<S>& p, const Vec6<S>& twist, const Vec3<S>& anchor,
                  EnergiesOf<S>& sum) {
  sum.kinetic = sum.kinetic + 0.5 * lanes::dot(momentum, twist);
  sum.momentum += to_inertial(p, anchor, momentum);
}

template <class S, int N, class C>
void add_energies(const Beam<N, C>& beam, const PortMotion<S>* p, const Vec3<S>& anchor, const Surroundings<S>& around,
                  const C&, EnergiesOf<S>& sum) {
  const BeamShape<S, N> b = eval_shape<S, N>(p);
  sum.strain = eval_strain_energy<S, N>(beam, b);
  if (!beam.has_mass) return;
  const PortMotion<S>& r = p[Beam<N>::reference];
  const bool moves = around.has_inertia;
  Vec6<S> rate[N];
  if (moves) eval_shape_rates<S, N>(b, p, rate);
  const auto& rule = mass_rule<N>();
  for (int g = 0; g < Beam<N>::num_mass_points; ++g) {
    const C w = rule.weight[g] * beam.length;
    const SectionMotion<S> s = eval_section<S, N>(rule.shape[g], b, moves ? rate : nullptr, nullptr, r);
    PortMotion<S> section;
    section.H = motion::compose(r.H, s.relative);
    if (moves) add_momentum<S>(w * Vec6<S>(beam.mass * s.v), section, s.v, anchor, sum);
    add_mass(beam.mass, w, section, anchor, sum);
  }
}

template <class S, class C>
void add_energies(const RigidBodyOf<C>& body, const PortMotion<S>* p, const Vec3<S>& anchor,
                  const Surroundings<S>& around, const C&, EnergiesOf<S>& sum) {
  if (around.has_inertia) add_momentum<S>(Vec6<S>(body.mass * p[0].v), p[0], p[0].v, anchor, sum);
  add_mass(body.mass, C(1.0), p[0], anchor, sum);
}

template <class S, class C>
void add_energies(const SpringOf<C>& e, const PortMotion<S>* p, const Vec3<S>&, const Surroundings<S>&, const C&,
                  EnergiesOf<S>& sum) {
  sum.strain = eval_strain_energy(e, p);
}
template <class S, class C>
void add_energies(const BushingOf<C>& e, const PortMotion<S>* p, const Vec3<S>&, const Surroundings<S>& around,
                  const C&, EnergiesOf<S>& sum) {
  sum.strain = eval_strain_energy(e, p, around.laws);
}
template <class S, class C>
void add_energies(const JointOf<C>& e, const PortMotion<S>* p, const Vec3<S>&, const Surroundings<S>&, const C& turns,
                  EnergiesOf<S>& sum) {
  sum.strain = eval_strain_energy(e, p, turns);
}

template <class E, class S>
EnergiesOf<S> energies_of(const E& e, const FieldOf<S>& field, const S& turns) {
  PortMotion<S> p[E::num_ports];
  Vec3<S> anchor;
  eval_ports_from_inertial(e, field, p, anchor);
  EnergiesOf<S> sum;
  add_energies(e, p, anchor, field.around, turns, sum);
  return sum;
}

}  // namespace

template <class E>
Energies eval_energies(const E& e, const Field& field, double turns) {
  return energies_of<E, double>(e, field, turns);
}

template <class E>
void eval_energies_lanes(const LaneElement<E>& e, const FieldLanes& field, const LanePack& turns,
                         EnergiesOf<LanePack>& out) {
  out = energies_of<LaneElement<E>, LanePack>(e, field, turns);
}

#define BOUGH_INSTANTIATE_ENERGIES(E)                                                             \
  template Energies eval_energies(const E&, const Field&, double);                                \
  template void eval_energies_lanes<E>(const LaneElement<E>&, const FieldLanes&, const LanePack&, \
                                       EnergiesOf<LanePack>&);

BOUGH_INSTANTIATE_ENERGIES(Beam<2>)
BOUGH_INSTANTIATE_ENERGIES(Beam<3>)
BOUGH_INSTANTIATE_ENERGIES(Beam<4>)
BOUGH_INSTANTIATE_ENERGIES(RigidBody)
BOUGH_INSTANTIATE_ENERGIES(Spring)
BOUGH_INSTANTIATE_ENERGIES(Bushing)
BOUGH_INSTANTIATE_ENERGIES(Joint)

}  // namespace bough::elements
