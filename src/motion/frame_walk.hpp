#pragma once
/// A walk along a chain of frames. It accumulates the motion of one frame as seen from another.
#include "bough/motion/frame_chain.hpp"

namespace bough::motion {

/// Motion of the frame that the walk has reached, as seen from the frame g where it started. All components are in the
/// axes of g.
struct Walk {
  Frame<double> pose = Frame<double>::identity();
  Vec3<double> velocity = Vec3<double>::zero();          ///< of the origin, from g
  Vec3<double> acceleration = Vec3<double>::zero();      ///< of the origin, from g
  Vec3<double> angular_velocity = Vec3<double>::zero();  ///< W
  Vec3<double> local = Vec3<double>::zero();             ///< sum of the a_i
  Vec3<double> transport = Vec3<double>::zero();         ///< sum of the W_gi x w_i
};

/// Walks from frame g to frame b, up or down the chain. Throws std::invalid_argument for a frame outside the chain.
Walk walk(const FrameChain& chain, int g, int b);

/// Transforms components from the axes of one frame to those of another.
class Axes {
 public:
  Axes(const FrameChain& chain, int from, In to) : R_(walk(chain, to.frame, from).pose.R), to_(to) {}
  Resolved operator()(const Vec3<double>& components) const { return {R_ * components, to_}; }

 private:
  Mat3<double> R_;
  In to_;
};

}  // namespace bough::motion
