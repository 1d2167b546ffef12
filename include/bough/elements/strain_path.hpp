#pragma once
/// A path from one shape of a beam to another along which its strains change in proportion. It is used for large Newton
/// corrections in statics. In lanes, the bits of a lane do not depend on its neighbours.
#include "bough/elements/beam.hpp"
#include "bough/elements/evaluate_lanes.hpp"
#include "bough/motion/quaternion.hpp"

namespace bough::elements {

/// How a correction moves the section at node i of a beam relative to the section at the reference node r:
///   H_ri <- H_ri S,   S = (turn, shift),   exp(end) = H_ri S.
template <class S>
struct SectionWay {
  motion::Quaternion<S> turn;
  Vec3<S> shift;
  Vec6<S> end;
};

/// Moves the sections of a beam of N nodes so that every strain changes in proportion to a correction of the nodes:
///
///   e_g(end) = e_g(d) + factor (de_g/dd) T(d)^-1 (eta_i - Ad(H_ri)^-1 eta_r),     g = 1 ... N - 1 strain points.
///
/// A beam of N nodes has as many strains as relative motions, 6 (N - 1), so the strains determine the shape. A slender
/// beam resists axial strain with EA, which is far larger than EI in bending. A correction that is linear in d bends
/// the beam with an axial strain of second order, and the spurious axial force EA (correction)^2 spoils the next
/// tangent of Newton's method. Along this path strains have no second order. With two nodes e = d / L, and the path is
/// linear in d.
///
/// The slopes of d at the strain points solve d'_g = T(d_g)^-1 L e_g, by substitution; no stiffness enters. Where
/// that does not converge (corrections that bend an element by more than a turn) the path is linear in d.
///   ports: poses of the sections at the nodes, relative to the element's anchor; eta: their corrections (linear [m];
///   angular [rad]) in their own axes; length: of the beam [m].
///   ways: of the N - 1 nodes other than r, in order.  strain_rates: L de_g/d(factor) at its end, at the N - 1
///   strain points.
/// Pure, no allocation. Source of the interpolation: see beam.hpp.
template <int N>
void eval_strain_path(const PortMotion<LanePack>* ports, const Vec6<LanePack>* eta, const LanePack& factor,
                      SectionWay<LanePack>* ways, Vec6<LanePack>* strain_rates);

/// Twists of the sections relative to that at the reference node at the end of the path, by unit of the factor, in
/// their own axes. ends: SectionWay::end and strain_rates as eval_strain_path gives them; twists: N - 1.
template <int N>
void eval_strain_path_twists(const Vec6<LanePack>* ends, const Vec6<LanePack>* strain_rates, Vec6<LanePack>* twists);

}  // namespace bough::elements
