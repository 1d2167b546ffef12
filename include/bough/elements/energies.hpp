#pragma once
/// Energies, momentum and weight of elements: alone, or eight of one kind in lanes (evaluate_lanes.hpp).
#include "bough/elements/evaluate_lanes.hpp"

namespace bough::elements {

/// Energies and momenta with respect to the inertial frame, in the axes of the frame in which nodes are described, in
/// the coordinates of the group; moments are about the origin of these coordinates. The potential of gravity g is -g .
/// mass_moment, in space its resultant (mass g; mass_moment x g).
template <class G, class S>
struct EnergiesOn {
  S kinetic = S(0.0);                                                       ///< [J]; 0 in statics
  S strain = S(0.0);                                                        ///< [J]
  typename G::template Vector<S> momentum = G::template Vector<S>::zero();  ///< (linear; angular); 0 in statics
  S mass = S(0.0);                                                          ///< [kg]
  typename G::template Translation<S> mass_moment = G::template Translation<S>::zero();  ///< sum of m x [kg m]
};
template <class S>
using EnergiesOf = EnergiesOn<motion::Se3, S>;
using Energies = EnergiesOf<double>;

/// `turns`: of joints (see evaluate).
template <class E>
EnergiesOn<typename E::Group, double> eval_energies(const E& e, const FieldOn<typename E::Group, double>& field,
                                                    double turns);

/// Lane l agrees with eval_energies of that element alone to round-off. Arguments as for evaluate_lanes.
template <class E>
void eval_energies_lanes(const LaneElement<E>& e, const FieldOn<typename E::Group, LanePack>& field,
                         const LanePack& turns, EnergiesOn<typename E::Group, LanePack>& out);

}  // namespace bough::elements
