#pragma once
/// Energies, momentum and weight of elements: alone, or eight of one kind in lanes (evaluate_lanes.hpp).
#include "bough/elements/evaluate_lanes.hpp"

namespace bough::elements {

/// Energies and momenta with respect to the inertial frame, in the axes of the frame in which nodes are described;
/// moments are about the inertial origin. The potential of gravity g is -g . mass_moment, its resultant (mass g;
/// mass_moment x g).
template <class S>
struct EnergiesOf {
  S kinetic = S(0.0);                     ///< [J]; 0 in statics
  S strain = S(0.0);                      ///< [J]
  Vec6<S> momentum = Vec6<S>::zero();     ///< (linear; angular); 0 in statics
  S mass = S(0.0);                        ///< [kg]
  Vec3<S> mass_moment = Vec3<S>::zero();  ///< sum of m x [kg m]
};
using Energies = EnergiesOf<double>;

/// `turns`: of joints (see evaluate).
template <class E>
Energies eval_energies(const E& e, const Field& field, double turns);

/// Lane l agrees with eval_energies of that element alone to round-off. Arguments as for evaluate_lanes.
template <class E>
void eval_energies_lanes(const LaneElement<E>& e, const FieldLanes& field, const LanePack& turns,
                         EnergiesOf<LanePack>& out);

}  // namespace bough::elements
