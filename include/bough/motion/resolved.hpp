#pragma once
/// Vectors that know the axes they are resolved in and the frame they are differentiated from. Frames are the indices
/// of one FrameChain; a mistake (a sum across axes, components asked for in other axes) throws std::invalid_argument at
/// once instead of giving a wrong number. What is not known: the chain itself and its time; vectors of two chains or of
/// two times have to be kept apart by the caller.
#include "bough/motion/se3.hpp"

namespace bough::motion {

/// What a frame's index stands for in a call. Explicit, so that two frames cannot change places unnoticed:
///   angular_velocity(chain, Of(2), RelativeTo(0), In(1))
template <class Role>
struct FrameRole {
  int frame;
  explicit constexpr FrameRole(int frame_in) : frame(frame_in) {}
};
using Of = FrameRole<struct OfRole>;                  ///< the frame that moves, the subject
using RelativeTo = FrameRole<struct RelativeToRole>;  ///< the frame in which it moves
using From = FrameRole<struct FromRole>;              ///< the frame from which a derivative is taken, the observer
using In = FrameRole<struct InRole>;                  ///< the frame in whose axes components are given

/// A vector by its components in the axes of one frame. Sums and products need both sides in the same axes, else
/// std::invalid_argument. Value type; no allocation unless it throws.
class Resolved {
 public:
  Resolved(const Vec3<double>& components, In axes) : components_(components), axes_(axes.frame) {}
  static Resolved zero(In axes) { return {Vec3<double>::zero(), axes}; }

  In axes() const { return In(axes_); }
  /// Components; `axes` says in which axes the caller takes them to be and has to be right.
  const Vec3<double>& components(In axes) const;

  Resolved& operator+=(const Resolved& b);
  Resolved& operator-=(const Resolved& b);
  friend Resolved operator+(Resolved a, const Resolved& b) { return a += b; }
  friend Resolved operator-(Resolved a, const Resolved& b) { return a -= b; }
  friend Resolved operator-(const Resolved& a) { return {-a.components_, a.axes()}; }
  friend Resolved operator*(double s, const Resolved& a) { return {s * a.components_, a.axes()}; }
  friend Resolved cross(const Resolved& a, const Resolved& b);
  friend double dot(const Resolved& a, const Resolved& b);
  /// Magnitude, without overflow or underflow of the squares.
  friend double norm(const Resolved& a);

 private:
  Vec3<double> components_;
  int axes_;
};

/// The derivative of a vector in time with the frame it is taken from: d_from x. Derivatives taken from different
/// frames are different vectors; value() hands one out only to who names its frame.
class Rate {
 public:
  Rate(const Resolved& value, From observer) : value_(value), observer_(observer.frame) {}
  From observer() const { return From(observer_); }
  const Resolved& value(From observer) const;

 private:
  Resolved value_;
  int observer_;
};

}  // namespace bough::motion
