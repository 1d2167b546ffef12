#pragma once
/// Operators of a group on plain vectors, (linear; angular) and (force; moment), for code outside the inner loops, such
/// as integrators and momenta. Elements use the compact forms of operators.hpp.
#include <type_traits>

#include "bough/motion/group.hpp"
#include "bough/motion/operators.hpp"
#include "bough/motion/operators_se2.hpp"

namespace bough::motion {

template <class G>
struct VectorsOn {
  template <class S>
  using Vector = typename G::template Vector<S>;
  template <class S>
  using Pose = typename G::template Pose<S>;
  static constexpr bool is_spatial = std::is_same_v<G, Se3>;

  /// |w|^2 of a vector (u; w)
  template <class S>
  static S angular_square(const Vector<S>& v) {
    if constexpr (!G::turns) {
      return S(0.0);
    } else {
      S sum = v[G::translations] * v[G::translations];
      for (int i = G::translations + 1; i < G::dof; ++i) sum = sum + v[i] * v[i];
      return sum;
    }
  }
  /// ad(v) a
  template <class S>
  static Vector<S> bracket(const Vector<S>& v, const Vector<S>& a) {
    if constexpr (is_spatial)
      return cross6_times(v, a);
    else
      return G::widened(G::bracket(v, a));
  }
  /// ad(v)^T f
  template <class S>
  static Vector<S> dual_bracket(const Vector<S>& v, const Vector<S>& f) {
    if constexpr (is_spatial)
      return cross6_transpose_times(v, f);
    else
      return G::dual_bracket(v, f);
  }
  /// T(d) v
  template <class S>
  static Vector<S> tangent_times(const Vector<S>& d, const Vector<S>& v) {
    if constexpr (is_spatial)
      return motion::tangent_times(d, v);
    else
      return times(eval_tangent_operator<G, S>(d), v);
  }
  /// T(d)^-1 v
  template <class S>
  static Vector<S> inverse_tangent_times(const Vector<S>& d, const Vector<S>& v) {
    if constexpr (is_spatial)
      return motion::inverse_tangent_times(d, v);
    else
      return times(eval_inverse_tangent_operator<G, S>(d), v);
  }
  /// T(d)^T f
  template <class S>
  static Vector<S> tangent_transpose_times(const Vector<S>& d, const Vector<S>& f) {
    if constexpr (is_spatial)
      return motion::tangent_transpose_times(d, f);
    else
      return transpose_times(eval_tangent_operator<G, S>(d), f);
  }
  /// T(d)^-T f
  template <class S>
  static Vector<S> inverse_tangent_transpose_times(const Vector<S>& d, const Vector<S>& f) {
    if constexpr (is_spatial)
      return motion::inverse_tangent_transpose_times(d, f);
    else
      return transpose_times(eval_inverse_tangent_operator<G, S>(d), f);
  }
  /// Ad(H)^T f
  template <class S>
  static Vector<S> adjoint_transpose_times(const Pose<S>& H, const Vector<S>& f) {
    if constexpr (is_spatial)
      return motion::adjoint_transpose_times(H, f);
    else
      return G::inverse_adjoint_transpose_times(G::relative(H, Pose<S>::identity()), f);
  }
};

}  // namespace bough::motion
