#pragma once
/// Names of the motion layer: small vectors and matrices of a kernel scalar S, and the pose of a frame.
/// S is double, long double, std::complex<double>, lanes::Jet, lanes::Taylor, lanes::Pack or a nesting of those.
#include <type_traits>

#include "bough/lanes/small.hpp"

namespace bough::motion {

template <class S>
using Vec3 = lanes::Vec<S, 3>;
template <class S>
using Vec6 = lanes::Vec<S, 6>;  ///< (linear; angular)
template <class S>
using Mat3 = lanes::Mat<S, 3, 3>;
template <class S>
using Mat6 = lanes::Mat<S, 6, 6>;

using lanes::choose;
using lanes::cross;
using lanes::dot;
using lanes::less;
using lanes::multiply_add;
using lanes::negative_multiply_add;
using lanes::select;

/// Type of the literals used with a scalar: long double for long double, double for all others.
template <class S>
using Literal = std::conditional_t<std::is_same_v<S, long double>, long double, double>;

/// Pose of a frame in its parent: a point with body components p* is at p = x + R p* [m]; R is a rotation.
template <class S>
struct Frame {
  Mat3<S> R;  ///< body components to parent components [-]
  Vec3<S> x;  ///< origin of the frame, in the parent [m]
  static Frame identity() { return {Mat3<S>::identity(), Vec3<S>::zero()}; }
};

/// The same pose in another scalar.
template <class T, class S>
Frame<T> cast(const Frame<S>& a) {
  return {lanes::cast<T>(a.R), lanes::cast<T>(a.x)};
}

}  // namespace bough::motion
