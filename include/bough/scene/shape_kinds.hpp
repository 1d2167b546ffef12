#pragma once
/// Shapes of cross-sections and bodies, as a scene names them, and the polygons and triangles by which they are drawn.
#include <array>
#include <variant>
#include <vector>

#include "bough/motion/se3.hpp"

namespace bough::scene {

/// Closed polygons in section axes 2 and 3 [m], the last point joined to the first: the outer one counter-clockwise
/// (from axis 2 to axis 3), holes clockwise.
struct Outline {
  std::vector<std::vector<std::array<double, 2>>> loops;
};

/// Triangles, counter-clockwise as seen from outside.
struct Mesh {
  std::vector<std::array<double, 3>> points;  ///< in the axes of the body, from the centre of mass [m]
  std::vector<std::array<int, 3>> triangles;
};

// ---- cross-sections: width along section axis 2, height along section axis 3, all lengths in [m] ----

struct Rectangle {
  double width = 0.0, height = 0.0;
};
struct Circle {
  double radius = 0.0;
};
struct Tube {
  double outer_radius = 0.0, inner_radius = 0.0;  ///< inner < outer
};
struct Ellipse {
  double width = 0.0, height = 0.0;
};
/// Hollow rectangle with walls of one thickness.
struct HollowBox {
  double width = 0.0, height = 0.0, thickness = 0.0;
};
/// Web along axis 3, flanges along axis 2.
struct IProfile {
  double width = 0.0, height = 0.0, web = 0.0, flange = 0.0;  ///< thicknesses of web and flanges
};
/// Web along axis 3, flanges to the positive side of axis 2.
struct CProfile {
  double width = 0.0, height = 0.0, web = 0.0, flange = 0.0;
};
/// Legs along the positive axes 2 and 3 from the corner.
struct LProfile {
  double width = 0.0, height = 0.0, thickness = 0.0;
};
/// Any polygon; it is moved so that its centroid is on the reference axis.
struct Polygon {
  Outline outline;
};
using SectionShape = std::variant<Rectangle, Circle, Tube, Ellipse, HollowBox, IProfile, CProfile, LProfile, Polygon>;

// ---- bodies, centred on their centre of mass; axis: 1, 2 or 3 ----

struct Box {
  motion::Vec3<double> size;  ///< edges along axes 1, 2, 3 [m]
};
struct Cylinder {
  double radius = 0.0, length = 0.0;  ///< [m]
  int axis = 1;
};
struct Sphere {
  double radius = 0.0;  ///< [m]
};
struct Rod {
  double length = 0.0;  ///< [m]
  int axis = 1;
};
/// Cylinder of the given length closed by two half spheres.
struct Capsule {
  double radius = 0.0, length = 0.0;
  int axis = 1;
};
/// Cone, or its lower part where the radius at the far end of the axis is above 0.
struct Cone {
  double radius = 0.0, end_radius = 0.0, length = 0.0;
  int axis = 1;
};
/// Hollow cylinder.
struct Ring {
  double outer_radius = 0.0, inner_radius = 0.0, length = 0.0;
  int axis = 1;
};
/// A polygon, given in the two axes after `axis`, drawn along it.
struct Extrusion {
  Outline outline;
  double length = 0.0;
  int axis = 1;
};
using BodyShape = std::variant<Box, Cylinder, Sphere, Rod, Capsule, Cone, Ring, Extrusion>;

}  // namespace bough::scene
