#pragma once
/// A walk along a chain of frames, gathering what one of them sees of another.
#include "bough/motion/frame_chain.hpp"

namespace bough::motion {

/// Motion of the frame reached seen from the frame started at (g); all components in the axes of g.
struct Walk {
  Frame<double> pose = Frame<double>::identity();
  Vec3<double> velocity = Vec3<double>::zero();          ///< of the origin, from g
  Vec3<double> acceleration = Vec3<double>::zero();      ///< of the origin, from g
  Vec3<double> angular_velocity = Vec3<double>::zero();  ///< W
  Vec3<double> local = Vec3<double>::zero();             ///< sum of the a_i
  Vec3<double> transport = Vec3<double>::zero();         ///< sum of the W_gi x w_i
};

/// From frame g to frame b, up or down the chain. Both have to be in it.
Walk walk(const FrameChain& chain, int g, int b);

/// Carries components from the axes of one frame to those of another.
class Axes {
 public:
  Axes(const FrameChain& chain, int from, In to) : R_(walk(chain, to.frame, from).pose.R), to_(to) {}
  Resolved operator()(const Vec3<double>& components) const { return {R_ * components, to_}; }

 private:
  Mat3<double> R_;
  In to_;
};

}  // namespace bough::motion
