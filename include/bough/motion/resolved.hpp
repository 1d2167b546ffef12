#pragma once
/// Vectors that carry the frame in whose axes they are resolved and the frame from which they are differentiated.
/// Frames are indices in one FrameChain. A mistake (a sum of vectors in different axes, components requested in other
/// axes) throws std::invalid_argument instead of giving a wrong number. The chain and its time are not recorded; the
/// caller must not mix vectors of two chains or of two times.
#include "bough/motion/se3.hpp"

namespace bough::motion {

/// The role of a frame in a call. It is named explicitly, so that two frames cannot be swapped unnoticed:
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

/// A vector by its components in the axes of one frame. Sums and products of vectors in different axes throw
/// std::invalid_argument. A value type; only these errors allocate.
class Resolved {
 public:
  Resolved(const Vec3<double>& components, In axes) : components_(components), axes_(axes.frame) {}
  static Resolved zero(In axes) { return {Vec3<double>::zero(), axes}; }

  In axes() const { return In(axes_); }
  /// Components. `axes` must be the axes that the vector is resolved in; otherwise std::invalid_argument is thrown.
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

/// The derivative of a vector in time with the frame it is seen from: d_from x. Derivatives seen from different frames
/// are different vectors, so value() throws std::invalid_argument unless the caller names the right frame.
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
