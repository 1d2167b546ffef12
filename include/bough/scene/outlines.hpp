#pragma once
/// Outlines of cross-sections and surfaces of bodies, as polygons and triangles, and the figures of polygons.
#include <string>

#include "bough/scene/shape_kinds.hpp"

namespace bough::scene {

/// Polygon of a cross-section's shape, with its centroid at the origin. A round contour becomes a polygon of `sides`
/// sides and of the same area, so that areas and volumes in pictures are those of the scene.
Outline outline_of(const SectionShape& shape, int sides = 24);

/// Rectangle that draws a section without a shape. It has the section's radii of gyration: width^2 = 12 EI3/EA,
/// height^2 = 12 EI2/EA.
Rectangle equivalent_rectangle(const motion::Mat6<double>& stiffness);

/// Moments of a plane area, exactly, by sums over the edges of its polygons, axes of the coordinates:
///   A = 1/2 sum w,  S2 = int x2 dA = 1/6 sum (a2 + b2) w,  int x2^2 dA = 1/12 sum (a2^2 + a2 b2 + b2^2) w,
///   int x2 x3 dA = 1/24 sum (a2 b3 + 2 a2 a3 + 2 b2 b3 + b2 a3) w,  w = a2 b3 - b2 a3 of an edge from a to b
struct PolygonMoments {
  double area = 0.0;                      ///< [m^2]
  double first_2 = 0.0, first_3 = 0.0;    ///< int x2 dA, int x3 dA [m^3]
  double square_2 = 0.0, square_3 = 0.0;  ///< int x2^2 dA, int x3^2 dA [m^4]
  double product = 0.0;                   ///< int x2 x3 dA [m^4]
};
PolygonMoments moments_of(const Outline& outline);

/// The outline moved so that its centroid is at the origin.
Outline centered(Outline outline);

/// What is wrong with an outline, in words: fewer than three corners, corners that are not finite or repeat, an outer
/// loop that is not counter-clockwise, a hole that is not clockwise, edges that cross; empty: nothing. Takes the square
/// of the number of corners: with more than 500 it is refused.
std::string problem_in(const Outline& outline);

/// Triangles that fill an outline, holes left out, on its own corners (all loops one after the other); by cutting ears.
struct Triangulation {
  std::vector<std::array<double, 2>> points;
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise
};
Triangulation triangles_of(const Outline& outline);

/// Surface of a body's shape. A rod has no thickness and is drawn as a bar of a fiftieth of its length. Round parts
/// have 24 sides and the volume of the shape.
Mesh mesh_of(const BodyShape& shape);

/// Height of the centre of mass of a cone above the middle of its large end [m].
double center_height(const Cone& cone);

/// Enclosed volume [m^3]:  1/6 sum a . (b x c)  over the triangles.
double volume_of(const Mesh& mesh);

}  // namespace bough::scene
