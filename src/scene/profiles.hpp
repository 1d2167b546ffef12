#pragma once
/// Shear and torsion of sections made of thin straight walls.
#include <array>
#include <vector>

#include "bough/scene/shape_kinds.hpp"

namespace bough::scene {

/// One wall: the middle line from `begin` to `end` [m] and its thickness. `before`: walls whose flow runs into this one
/// at its beginning. Walls are listed after those that run into them; a wall without any begins at a free edge, where
/// no shear flows.
struct Wall {
  std::array<double, 2> begin, end;
  double thickness = 0.0;
  std::vector<std::size_t> before = {};
};

/// Figures of shear of thin walls, from the shear flow of  int sigma' x dA = Q:
///   q(s) = q(0) - int_0^s sigma' t ds,  sigma' = a2 (x2 - c2) + a3 (x3 - c3),  [I3 I23; I23 I2] (a2; a3) = (Q2; Q3)
///   compliance  G S_ij = sum over walls int q_i q_j / t ds,   torque about the centroid  m_i = int (x2 dx3 - x3 dx2)
///     q_i
///   shear centre  e2 = m_3, e3 = -m_2   (Timoshenko, Strength of materials II, thin-walled open sections)
struct WallFigures {
  double area = 0.0;
  double compliance_22 = 0.0, compliance_33 = 0.0, compliance_23 = 0.0;  ///< G S [1/m^2]
  double shear_center_2 = 0.0, shear_center_3 = 0.0;                     ///< from the centroid of the walls [m]
  double open_torsion = 0.0;                                             ///< 1/3 sum l t^3 [m^4]
};
WallFigures eval_walls(const std::vector<Wall>& walls);

/// Walls of a profile. A closed box is cut where no shear flows for symmetry: for a force along axis 3 in the middles
/// of the walls across it, along axis 2 in those of the others.
std::vector<Wall> walls_of(const IProfile& s);
std::vector<Wall> walls_of(const CProfile& s);
std::vector<Wall> walls_of(const LProfile& s);
std::vector<Wall> walls_of(const HollowBox& s, bool for_force_along_3);

}  // namespace bough::scene
