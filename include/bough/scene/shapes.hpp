#pragma once
/// Sections and bodies from their shapes.
#include <optional>
#include <variant>

#include "bough/scene/scene.hpp"

namespace bough::scene {

struct Rectangle {
  double width = 0.0;   ///< along section axis 2 [m]
  double height = 0.0;  ///< along section axis 3 [m]
};
struct Circle {
  double radius = 0.0;  ///< [m]
};
struct Tube {
  double outer_radius = 0.0, inner_radius = 0.0;  ///< [m], inner < outer
};
using SectionShape = std::variant<Rectangle, Circle, Tube>;

/// Figures of a plane area, axes through its centroid.
struct AreaFigures {
  double area = 0.0;                                  ///< A [m^2]
  double second_moment_2 = 0.0;                       ///< I2, int x3^2 dA: bending about axis 2 [m^4]
  double second_moment_3 = 0.0;                       ///< I3, int x2^2 dA [m^4]
  double torsion = 0.0;                               ///< J of Saint-Venant [m^4]
  double shear_factor_2 = 0.0, shear_factor_3 = 0.0;  ///< Cowper (1966) for Poisson's ratio 0 [-]
};
AreaFigures area_figures(const SectionShape& shape);

/// Saint-Venant's torsion constant of an a x b rectangle, a >= b [m^4], by its series to round-off:
///   J = a b^3 (1/3 - 64/pi^5 (b/a) sum_{n odd} tanh(n pi a / 2b) / n^5)                 [Timoshenko, Goodier, Theory of elasticity, 109]
double rectangle_torsion_constant(double a, double b);

/// Stiffness diag(EA, k2 GA, k3 GA, GJ, EI2, EI3), mass per length diag(rho A (3 times), rho (I2 + I3), rho I2, rho I3); no damping.
Section make_section(const std::string& name, const SectionShape& shape, const Material& material,
                     std::optional<double> shear_factor_2 = std::nullopt,
                     std::optional<double> shear_factor_3 = std::nullopt);

/// Mass matrix per length of a section about its reference axis:
///   M = [m I, -m ~c; m ~c, J - m ~c ~c]
/// m [kg/m]; rotary: J, diagonal, about the centre of mass [kg m]; c: centre of mass in section axes [m].
Mat6 section_mass_matrix(double mass_per_length, const Vec3& rotary, const Vec3& center);

struct Box {
  Vec3 size;  ///< edges along axes 1, 2, 3 [m]
};
struct Cylinder {
  double radius = 0.0, length = 0.0;  ///< [m]
  int axis = 1;                       ///< 1, 2 or 3
};
struct Sphere {
  double radius = 0.0;  ///< [m]
};
struct Rod {
  double length = 0.0;  ///< [m]
  int axis = 1;
};
using BodyShape = std::variant<Box, Cylinder, Sphere, Rod>;

/// Volume [m^3]; a rod has none (0).
double volume_of(const BodyShape& shape);

/// Inertia of a homogeneous body of mass m [kg] about its centre, in the axes of the shape [kg m^2].
Mat3 inertia_of(const BodyShape& shape, double mass);

}  // namespace bough::scene
