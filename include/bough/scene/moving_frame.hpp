#pragma once
/// Frames that move in each other by prescribed laws, and a point observed in them. The state of all frames at one time
/// is a motion::FrameChain.
#include <optional>
#include <string>
#include <vector>

#include "bough/laws/law.hpp"
#include "bough/motion/frame_chain.hpp"

namespace bough::scene {

/// A rotation by a law of time about an axis fixed in the axes reached before it.
struct Turn {
  motion::Vec3<double> axis = motion::Vec3<double>::unit(2);  ///< unit vector
  laws::Law angle;                                            ///< [rad], counts turns
};

/// A frame in its parent: x(t) = position(t), R(t) = rotation exp(angle_1(t) axis_1) exp(angle_2(t) axis_2) ...
struct MovingFrame {
  std::string name;
  laws::Law position[3];                                             ///< of the origin, in the parent's axes [m]
  motion::Mat3<double> rotation = motion::Mat3<double>::identity();  ///< of the axes at angles zero
  std::vector<Turn> turns;
};

/// Pose, velocity and acceleration in the parent at t [s]; at a jump, from `side`. The angular velocity and
/// acceleration of several turns are those of nested frames,
///   w = sum_k u_k,  dw/dt = sum_k ( angle_k'' axis_k + w_k x u_k ),  u_k = angle_k' axis_k in the parent's axes,
/// w_k the sum up to k. Does not allocate. Not finite where a law is not: see non_finite_law.
motion::FrameMotion motion_at(const MovingFrame& frame, double t, laws::Side side = laws::Side::right);

/// Names the law of the frame that is not finite at t and says which of its values is not; none where all are finite.
std::optional<std::string> non_finite_law(const MovingFrame& frame, double t);

/// A point of one frame of a chain, and the frame of the observer. Frames are numbered from 1 in the order of `frames`,
/// each moving in the one before; 0 is the inertial frame.
struct FrameStudy {
  std::string name;  ///< file name without ending
  std::string title;
  std::vector<MovingFrame> frames;
  int point_frame = 0;
  laws::Law point[3];       ///< position in the axes of point_frame [m]
  int from = 0;             ///< frame of the observer
  int in = 0;               ///< frame in whose axes the results are resolved
  double start_time = 0.0;  ///< [s]
  double end_time = 1.0;    ///< [s], not before the start
  int num_points = 2;       ///< number of times, both ends included
};

/// Time number k [s], k = 0 .. num_points - 1; the first and the last are exactly the two ends.
double time_of(const FrameStudy& study, int k);

}  // namespace bough::scene
