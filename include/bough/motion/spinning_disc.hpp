#pragma once
/// A disc that spins on a shaft that turns: the example of three frames whose axes are not parallel [2.49-2.51].
#include "bough/motion/frame_chain.hpp"

namespace bough::motion {

/// Frame 1, the shaft, turns about axis 3 of frame 0. Frame 2, the disc, spins about its own axis 3, which leans by the
/// tilt from the shaft's axis 3 towards its axis 1: (sin tilt, 0, cos tilt). At psi = 0 the disc's axis 1 is
/// (cos tilt, 0, -sin tilt) in the shaft. All three origins are one point; both speeds are constant.
struct SpinningDisc {
  double spin = 1.0;        ///< psi' of the disc on the shaft [rad/s]
  double precession = 1.0;  ///< phi' of the shaft [rad/s]
  double tilt = 0.0;        ///< theta [rad]
  double radius = 1.0;      ///< of the point, which lies on the disc's axis 1 [m]
};

/// The chain at spin angle psi and precession angle phi [rad].
FrameChain chain_of(const SpinningDisc& disc, double psi, double phi = 0.0);
/// The point at rest on the disc: radius along axis 1 of frame 2.
PointMotion point_of(const SpinningDisc& disc);

/// (phi' x psi') x r, the Razi acceleration of a disc [2.49-2.51]; zero for a fixed axis and for parallel axes.
/// precession and spin as vectors [rad/s], r [m], all in the same axes, else std::invalid_argument.
Resolved razi_acceleration(const Resolved& precession, const Resolved& spin, const Resolved& r);

}  // namespace bough::motion
