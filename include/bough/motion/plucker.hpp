#pragma once
/// Lines by Plücker coordinates Q = (moment about the origin [m]; direction [-]), m = r x l for any point r of the
/// line. A line has m.l = 0; coordinates scale with |l|, which need not be 1. Lines move as C Q* [1.15]. With l = 0
/// they are the line at infinity of the planes normal to m, which moves as well but has no nearest point. Pure, no
/// allocation.
#include <optional>

#include "bough/motion/se3.hpp"

namespace bough::motion {

/// Line through a point along a direction, of unit direction; none where the direction is zero.
std::optional<Vec6<double>> line_along(const Vec3<double>& point, const Vec3<double>& direction);

/// Line from a to b, of unit direction; none where the points coincide. Error in the moment: round-off of |a| |b|/|b
/// - a|.
std::optional<Vec6<double>> line_through(const Vec3<double>& a, const Vec3<double>& b);

/// Point nearest the origin, l x m/l^2; none for a line at infinity.
std::optional<Vec3<double>> nearest_point(const Vec6<double>& line);

/// Distance of a point from the line, |m - p x l|/|l| [m]; none for a line at infinity. Error: round-off of |m|/|l| +
/// |p|.
std::optional<double> distance_from(const Vec6<double>& line, const Vec3<double>& point);

/// The same line with its moment taken about p: (m - p x l; l).
Vec6<double> line_about(const Vec6<double>& line, const Vec3<double>& p);

/// Q = C Q* [1.15]: a line of the body, in the parent frame.
Vec6<double> moved_line(const Frame<double>& motion, const Vec6<double>& line);

/// Column k of C, k = 0 .. 5 [1.16-1.18]: for k >= 3 the moved axis k - 3 of the body through its reference point,
/// (~u R e; R e); for k < 3 the moved line at infinity (R e; 0).
Vec6<double> moved_axis(const Frame<double>& motion, int k);

/// Mutual moment m1.l2 + m2.l1 of two lines. It is 0 where they meet or are parallel and does not change when both
/// move. For unit directions its modulus is the distance times the sine of the angle [m].
double mutual_moment(const Vec6<double>& a, const Vec6<double>& b);

}  // namespace bough::motion
