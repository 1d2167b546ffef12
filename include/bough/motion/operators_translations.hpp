#pragma once
/// The operators of operators.hpp on translations, where D = ad(d) = 0: they are the identity, and their derivatives by
/// d are zero.
#include "bough/motion/group_translations.hpp"

namespace bough::motion {

template <class G, class S>
struct Tangent;
template <class G, class S>
struct InverseTangent;
template <int N, class S>
struct Tangent<Translations<N>, S> {};
template <int N, class S>
struct InverseTangent<Translations<N>, S> {};

template <class G, class S>
requires(!G::turns) BOUGH_INLINE Tangent<G, S> eval_tangent_operator(const typename G::template Motion<S>&) {
  return {};
}
template <class G, class S>
requires(!G::turns)
    BOUGH_INLINE InverseTangent<G, S> eval_inverse_tangent_operator(const typename G::template Motion<S>&) {
  return {};
}
template <template <class, class> class F, int N, class S>
BOUGH_INLINE Multiple<S> matrix(const F<Translations<N>, S>&) {
  return Multiple<S>::identity();
}
template <template <class, class> class F, int N, class S>
BOUGH_INLINE const lanes::Vec<S, N>& times(const F<Translations<N>, S>&, const lanes::Vec<S, N>& y) {
  return y;
}
template <template <class, class> class F, int N, class S>
BOUGH_INLINE const lanes::Vec<S, N>& transpose_times(const F<Translations<N>, S>&, const lanes::Vec<S, N>& f) {
  return f;
}
template <template <class, class> class F, int N, class S>
BOUGH_INLINE Nothing<S> jacobian(const F<Translations<N>, S>&, const lanes::Vec<S, N>&) {
  return {};
}

}  // namespace bough::motion
