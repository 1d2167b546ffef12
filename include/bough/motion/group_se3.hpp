#pragma once
/// The group SE(3) for elements: poses, plain vectors and matrices (dof = 6), and the algebra in its compact form. By
/// transference, motions are dual vectors and operators on motions are dual 3x3 matrices (dual.hpp), so formulas for
/// rotations hold for motions as well. Elements are written in these operations, with D = ad(d):
///
///   motion, wrench     vectors (linear; angular) and (force; moment) in compact form
///   bracket            ad(x) y                    dual_bracket       ad(x)^T n
///   pairing            <x, y>: the slope of X = <d, d> along e is 2 <d, e>, and D^3 = -X D
///   power              n . y, a number like X     covector           the wrench f <x, .>
///   number             a function of X            real               the value X itself
///   Map                motions to motions         BracketMap         motions to brackets, which may be a smaller space
///   WrenchMap          motions to wrenches, the derivative of a transposed operator; symmetric blocks are full
///     matrices
///
/// The same names exist in every group, so an element is written once. All functions are pure and do not allocate.
#include "bough/motion/group_se3_blocks.hpp"

namespace bough::motion {

struct Se3 : Se3Blocks {
  using Se3Blocks::log;

  template <class S>
  static Pose<S> exp(const Vec6<S>& d) {
    return exp_se3(d);
  }
  template <class S>
  static Vec6<S> log(const Frame<S>& H) {
    return log_se3(H);
  }
  template <class S>
  static Pose<S> compose(const Frame<S>& a, const Frame<S>& b) {
    return motion::compose(a, b);
  }
  template <class S>
  static Pose<S> relative(const Frame<S>& a, const Frame<S>& b) {
    return motion::relative(a, b);
  }
  template <class S>
  static Vec6<S> inverse_adjoint_times(const Frame<S>& H, const Vec6<S>& v) {
    return motion::inverse_adjoint_times(H, v);
  }
  template <class S>
  static Vec6<S> inverse_adjoint_transpose_times(const Frame<S>& H, const Vec6<S>& f) {
    return motion::inverse_adjoint_transpose_times(H, f);
  }
};

}  // namespace bough::motion
