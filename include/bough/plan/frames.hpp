#pragma once
/// Motion of a plan's frames at one instant.
#include "bough/lanes/taylor.hpp"
#include "bough/plan/plan.hpp"

namespace bough::plan {

/// Pose and twist (in its own axes) of a frame as series in time. They are relative to the inertial frame, or, for
/// frames placed in the observer's frame, relative to that frame.
struct FrameCourse {
  using Series = lanes::Taylor<double, 3>;
  motion::Frame<Series> pose;
  motion::Vec6<Series> twist;
};

/// Results of eval_frames, which sizes them in its first call; later calls do not allocate.
struct FrameMotions {
  std::vector<elements::CarrierMotion>
      in_ground;                     ///< of each frame in the ground: the inertial frame, or the observer's
  elements::CarrierMotion observer;  ///< of the observer's frame in the inertial one
  std::vector<FrameCourse> courses;  ///< of each frame: scratch of eval_frames
};

/// Poses, twists and their first two derivatives from the laws' series in time (value, rate, half the acceleration, a
/// sixth of the third derivative; by index of Plan::laws), frame by frame in series arithmetic:
///   X = X_parent Q,  V = Ad(Q^-1) V_parent + V_Q,  Q = (R_0 exp(angle_1 ~axis_1) ..., x)
/// For frames in which the observer's frame is placed:  H = X_o^-1 X,  V - Ad(H^-1) V_o.
void eval_frames(const Plan& plan, const lanes::Taylor<double, 3>* laws, FrameMotions& motions);

/// As eval_frames at time 0, without third derivatives.
FrameMotions frames_at_start(const Plan& plan);

}  // namespace bough::plan
