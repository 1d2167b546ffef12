#pragma once
/// Screws: a 6-vector as a line with a pitch and a magnitude, S = p (s0 x n + h n; n) [1.68]. The magnitude p is an odd
/// function of the angle for the screw of a motion (the parameterization), h = n.m stands for the alpha d of the
/// source. Under a change of frame S = C S* the line moves; p and h do not change [1.69-1.71]. Doubles, pure, no
/// allocation.
#include "bough/motion/motion_tensor.hpp"

namespace bough::motion {

/// kind `screw`: an axis; `translation`: no angular part, S = p (n; 0), where h would be infinite and is set to 0;
/// `none`: S = 0. The magnitude has the unit of the angular part, or of the linear part for a translation.
struct Screw {
  MotionKind kind = MotionKind::none;
  double magnitude = 0.0;                     ///< p >= 0
  double h = 0.0;                             ///< advance per unit of magnitude [m]
  Vec3<double> point = Vec3<double>::zero();  ///< s0, of the axis [m]
  Vec3<double> n = Vec3<double>::zero();      ///< unit direction
};

/// Screw of a 6-vector S = (m; l): p = |l|, h = l.m/l^2, the point nearest the origin s0 = l x m/l^2.
Screw screw_of(const Vec6<double>& S);

/// S of a screw.
Vec6<double> vector_of(const Screw& s);

/// The screw in the parent frame, S = C S* [1.69]: n = R n*, s0 = u + R s0*; p and h do not change [1.70-1.71].
Screw moved_screw(const Frame<double>& motion, const Screw& s);

/// p N [1.73], the screw of a motion for a magnitude p and any alpha (screw_vector). With p = phi and
/// alpha = 2 sin(phi/2)/phi these are the exponential coordinates, with p = 2 tan(phi/2) and alpha = 1/cos(phi/2)
/// Cayley's, with p = 4 tan(phi/4) and alpha = 1 Wiener-Milenkovic's (parameterization.hpp). This holds for screws; a
/// translation gives d (n; 0) for any magnitude and alpha.
Vec6<double> motion_screw(const IntrinsicMotion& m, double magnitude, double alpha);

}  // namespace bough::motion
