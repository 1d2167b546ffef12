#pragma once
/// Stiffness, mass and inertia of sections and bodies from their shapes.
#include <optional>

#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Properties of a plane area, for axes through its centroid.
struct AreaFigures {
  double area = 0.0;                                  ///< A [m^2]
  double second_moment_2 = 0.0;                       ///< I2, int x3^2 dA: bending about axis 2 [m^4]
  double second_moment_3 = 0.0;                       ///< I3, int x2^2 dA [m^4]
  double product_moment = 0.0;                        ///< I23, int x2 x3 dA [m^4]
  double torsion = 0.0;                               ///< J of Saint-Venant [m^4]; polygon: 0, not known
  double shear_factor_2 = 0.0, shear_factor_3 = 0.0;  ///< [-]; polygon: 0, not known
  double shear_factor_23 = 0.0;                       ///< Q2 = G A (k2 g2 + k23 g3), Q3 = G A (k23 g2 + k3 g3) [-]
  double shear_center_2 = 0.0, shear_center_3 = 0.0;  ///< from the centroid [m]
};
/// Area and second moments are exact. Torsion constants: rectangle, ellipse, circle, tube exact; hollow box by Bredt's
/// formula for the middle line, 4 A_m^2 t / perimeter; I, C and L profiles  1/3 sum l t^3  over their walls. Shear
/// factors: rectangle, circle, tube and ellipse Cowper's (1966) for Poisson's ratio 0; profiles from the energy of the
/// shear flow in their walls, which tells the shear centre, too (profiles.hpp).
AreaFigures area_figures(const SectionShape& shape);

/// Saint-Venant's torsion constant of an a x b rectangle, a >= b [m^4], by its series to round-off:
///   J = a b^3 (1/3 - 64/pi^5 (b/a) sum_{n odd} tanh(n pi a / 2b) / n^5)                 [Timoshenko, Goodier, Theory
///     of elasticity, 109]
double rectangle_torsion_constant(double a, double b);

/// Stiffness and mass about the centroid; no damping. With the shear centre at (e2, e3) the strains of shear are those
/// there, g2 - e3 k1 and g3 + e2 k1:
///   (Q2; Q3) = G A [k2 k23; k23 k3] (g2 - e3 k1; g3 + e2 k1),  T = G J k1 - e3 Q2 + e2 Q3,  N = E A e1
///   M2 = E (I2 k2 - I23 k3),  M3 = E (I3 k3 - I23 k2);  mass per length rho A, inertia rho [I2 + I3, 0, 0; 0, I2,
///     -I23; 0, -I23, I3]
Section make_section(const std::string& name, const SectionShape& shape, const AreaFigures& figures,
                     const Material& material);

/// Mass matrix per length of a section about its reference axis:
///   M = [m I, -m ~c; m ~c, J - m ~c ~c]
/// m [kg/m]; rotary: J, diagonal, about the centre of mass [kg m]; c: centre of mass in section axes [m].
Mat6 section_mass_matrix(double mass_per_length, const Vec3& rotary, const Vec3& center);

/// Volume [m^3]; a rod has none (0).
double volume_of(const BodyShape& shape);

/// Inertia of a homogeneous body of mass m [kg] about its centre, in the axes of the shape [kg m^2].
Mat3 inertia_of(const BodyShape& shape, double mass);

}  // namespace bough::scene
