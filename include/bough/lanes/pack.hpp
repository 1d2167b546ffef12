#pragma once
/// W doubles in lockstep: one arithmetic operation acts on every lane, a comparison gives a mask, and select chooses
/// lane by lane. The value of a lane is the value that double arithmetic gives, bit for bit. It depends neither on the
/// values in the other lanes nor on the width of the registers (this needs -ffp-contract=off, as in the whole project).
///
/// A pack is an array of register-sized vectors (8 doubles on AVX-512, 4 on AVX, 2 on SSE2, single doubles elsewhere),
/// since compilers generate poor code for vectors wider than a register. The size and the alignment of a pack are the
/// same on all of them. The inline namespace carries the register width into symbol names, so that the linker never
/// mixes instruction sets.
#include "bough/lanes/jet.hpp"
#include "bough/lanes/small.hpp"
#include "bough/lanes/taylor.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#if defined(__GNUC__) && defined(__AVX512F__)
#define BOUGH_REGISTER_DOUBLES 8
#define BOUGH_REGISTER_NAMESPACE registers_of_8
#elif defined(__GNUC__) && defined(__AVX__)
#define BOUGH_REGISTER_DOUBLES 4
#define BOUGH_REGISTER_NAMESPACE registers_of_4
#elif defined(__GNUC__) && defined(__SSE2__)
#define BOUGH_REGISTER_DOUBLES 2
#define BOUGH_REGISTER_NAMESPACE registers_of_2
#else
#define BOUGH_REGISTER_DOUBLES 1
#define BOUGH_REGISTER_NAMESPACE registers_of_1
#endif

namespace bough::lanes {
inline namespace BOUGH_REGISTER_NAMESPACE {

/// Number of doubles in one register of this build.
inline constexpr int register_doubles = BOUGH_REGISTER_DOUBLES;

namespace detail {
template <int C>
struct Register;
template <>
struct Register<1> {
  using Real = double;
  using Flag = long long;
};
#if BOUGH_REGISTER_DOUBLES >= 2
template <>
struct Register<2> {
  typedef double Real __attribute__((vector_size(16)));
  typedef long long Flag __attribute__((vector_size(16)));
};
inline Register<2>::Real root(const Register<2>::Real& x) { return Register<2>::Real(_mm_sqrt_pd(x)); }
#endif
#if BOUGH_REGISTER_DOUBLES >= 4
template <>
struct Register<4> {
  typedef double Real __attribute__((vector_size(32)));
  typedef long long Flag __attribute__((vector_size(32)));
};
inline Register<4>::Real root(const Register<4>::Real& x) { return Register<4>::Real(_mm256_sqrt_pd(x)); }
#endif
#if BOUGH_REGISTER_DOUBLES >= 8
template <>
struct Register<8> {
  typedef double Real __attribute__((vector_size(64)));
  typedef long long Flag __attribute__((vector_size(64)));
};
inline Register<8>::Real root(const Register<8>::Real& x) { return Register<8>::Real(_mm512_maskz_sqrt_pd(0xff, x)); }
#endif
inline double root(double x) { return std::sqrt(x); }

// Whether all or any flags are set, by instructions that test a whole register. Code that reads flags one by one makes
// compilers store the register and load its parts, and the processor stalls until the store has completed.
#if BOUGH_REGISTER_DOUBLES >= 8
inline bool is_set(const Register<8>::Flag& f) { return _mm512_test_epi64_mask(__m512i(f), __m512i(f)) != 0; }
#endif
#if BOUGH_REGISTER_DOUBLES >= 4
inline bool is_set(const Register<4>::Flag& f) { return _mm256_testz_si256(__m256i(f), __m256i(f)) == 0; }
#endif
#if BOUGH_REGISTER_DOUBLES >= 2
inline bool is_set(const Register<2>::Flag& f) { return _mm_movemask_epi8(__m128i(f)) != 0; }
#endif
inline bool is_set(long long f) { return f != 0; }

// a b + c; every lane has the bits of lanes::multiply_add on doubles.
#if BOUGH_REGISTER_DOUBLES >= 8
inline Register<8>::Real fused(const Register<8>::Real& a, const Register<8>::Real& b, const Register<8>::Real& c) {
  return Register<8>::Real(_mm512_fmadd_pd(a, b, c));
}
#endif
#if BOUGH_REGISTER_DOUBLES >= 4 && defined(__FMA__)
inline Register<4>::Real fused(const Register<4>::Real& a, const Register<4>::Real& b, const Register<4>::Real& c) {
  return Register<4>::Real(_mm256_fmadd_pd(a, b, c));
}
inline Register<2>::Real fused(const Register<2>::Real& a, const Register<2>::Real& b, const Register<2>::Real& c) {
  return Register<2>::Real(_mm_fmadd_pd(a, b, c));
}
#endif
template <class R>
inline R fused(const R& a, const R& b, const R& c) {
#if defined(__FMA__)
  if constexpr (std::same_as<R, double>) return lanes::multiply_add(a, b, c);
#endif
  return a * b + c;
}
}  // namespace detail

/// One flag per lane.
template <int W>
struct alignas(8 * W) Mask {
  static constexpr int chunk = W < register_doubles ? W : register_doubles, chunks = W / chunk;
  using Flag = typename detail::Register<chunk>::Flag;
  Flag f[chunks];  ///< every lane is 0 (false) or -1 (true)
  bool operator[](int lane) const {
    if constexpr (chunk == 1)
      return f[lane] != 0;
    else
      return f[lane / chunk][lane % chunk] != 0;
  }
};

template <int W>
struct alignas(8 * W) Pack {
  static_assert(W >= 1 && (W & (W - 1)) == 0, "the number of lanes is a power of two");
  static constexpr int width = W;
  static constexpr int chunk = W < register_doubles ? W : register_doubles, chunks = W / chunk;
  using Real = typename detail::Register<chunk>::Real;
  Real r[chunks];

  Pack() = default;
  Pack(double x) {  // NOLINT(google-explicit-constructor): numbers must mix with packs in kernels
    for (int i = 0; i < chunks; ++i) r[i] = Real{} + x;
  }
  double operator[](int lane) const {
    if constexpr (chunk == 1)
      return r[lane];
    else
      return r[lane / chunk][lane % chunk];
  }
  void set(int lane, double x) {
    if constexpr (chunk == 1)
      r[lane] = x;
    else
      r[lane / chunk][lane % chunk] = x;
  }
  /// Loads W consecutive doubles of any alignment.
  static Pack load(const double* from) {
    Pack p;
    __builtin_memcpy(&p.r, from, sizeof(double) * W);
    return p;
  }
  void store(double* to) const { __builtin_memcpy(to, &r, sizeof(double) * W); }
};

// Arithmetic, register by register; a double is the same number in every lane.
#define BOUGH_PACK_OPERATOR(op)                                          \
  template <int W>                                                       \
  inline Pack<W> operator op(const Pack<W>& a, const Pack<W>& b) {       \
    Pack<W> c;                                                           \
    for (int i = 0; i < Pack<W>::chunks; ++i) c.r[i] = a.r[i] op b.r[i]; \
    return c;                                                            \
  }                                                                      \
  template <int W>                                                       \
  inline Pack<W> operator op(const Pack<W>& a, double b) {               \
    return a op Pack<W>(b);                                              \
  }                                                                      \
  template <int W>                                                       \
  inline Pack<W> operator op(double a, const Pack<W>& b) {               \
    return Pack<W>(a) op b;                                              \
  }                                                                      \
  template <int W>                                                       \
  inline Pack<W>& operator op##=(Pack<W>& a, const Pack<W>& b) {         \
    return a = a op b;                                                   \
  }
BOUGH_PACK_OPERATOR(+)
BOUGH_PACK_OPERATOR(-)
BOUGH_PACK_OPERATOR(*)
BOUGH_PACK_OPERATOR(/)
#undef BOUGH_PACK_OPERATOR

template <int W>
Pack<W> operator-(const Pack<W>& a) {
  Pack<W> c;
  for (int i = 0; i < Pack<W>::chunks; ++i) c.r[i] = -a.r[i];
  return c;
}

template <int W>
Pack<W> multiply_add(const Pack<W>& a, const Pack<W>& b, const Pack<W>& c) {
  Pack<W> r;
  for (int i = 0; i < Pack<W>::chunks; ++i) r.r[i] = detail::fused(a.r[i], b.r[i], c.r[i]);
  return r;
}
template <int W>
Pack<W> multiply_add(double a, const Pack<W>& b, const Pack<W>& c) {
  return multiply_add(Pack<W>(a), b, c);
}

/// Applies f to each lane: functions of the standard library, with the bits that they give for a double.
template <int W, class F>
Pack<W> lane_by_lane(const F& f, const Pack<W>& a) {
  Pack<W> c;
  for (int i = 0; i < W; ++i) c.set(i, f(a[i]));
  return c;
}
template <int W>
Pack<W> sqrt(const Pack<W>& a) {
  Pack<W> c;
  for (int i = 0; i < Pack<W>::chunks; ++i) c.r[i] = detail::root(a.r[i]);
  return c;
}
template <int W>
Pack<W> abs(const Pack<W>& a) {
  Pack<W> c;
  for (int i = 0; i < Pack<W>::chunks; ++i) {
    if constexpr (Pack<W>::chunk == 1) {
      c.r[i] = std::abs(a.r[i]);
    } else {
      using Flag = typename Mask<W>::Flag;
      c.r[i] = typename Pack<W>::Real(Flag(a.r[i]) & (Flag{} + 0x7fffffffffffffffLL));  // clear the sign bit
    }
  }
  return c;
}
template <int W>
Pack<W> sin(const Pack<W>& a) {
  return lane_by_lane([](double x) { return std::sin(x); }, a);
}
template <int W>
Pack<W> cos(const Pack<W>& a) {
  return lane_by_lane([](double x) { return std::cos(x); }, a);
}
template <int W>
Pack<W> atan2(const Pack<W>& y, const Pack<W>& x) {
  Pack<W> c;
  for (int i = 0; i < W; ++i) c.set(i, std::atan2(y[i], x[i]));
  return c;
}

/// a < b lane by lane; false in lanes where a or b is not a number.
template <int W>
Mask<W> less(const Pack<W>& a, const Pack<W>& b) {
  Mask<W> m;
  for (int i = 0; i < Mask<W>::chunks; ++i) {
    if constexpr (Mask<W>::chunk == 1)
      m.f[i] = a.r[i] < b.r[i] ? -1 : 0;
    else
      m.f[i] = a.r[i] < b.r[i];
  }
  return m;
}
template <int W>
Mask<W> operator&(const Mask<W>& a, const Mask<W>& b) {
  Mask<W> m;
  for (int i = 0; i < Mask<W>::chunks; ++i) m.f[i] = a.f[i] & b.f[i];
  return m;
}
template <int W>
Mask<W> operator|(const Mask<W>& a, const Mask<W>& b) {
  Mask<W> m;
  for (int i = 0; i < Mask<W>::chunks; ++i) m.f[i] = a.f[i] | b.f[i];
  return m;
}
template <int W>
Mask<W> operator!(const Mask<W>& a) {
  Mask<W> m;
  for (int i = 0; i < Mask<W>::chunks; ++i) m.f[i] = ~a.f[i];
  return m;
}
template <int W>
bool any(const Mask<W>& m) {
  typename Mask<W>::Flag f = m.f[0];
  for (int i = 1; i < Mask<W>::chunks; ++i) f |= m.f[i];
  return detail::is_set(f);
}
template <int W>
bool all(const Mask<W>& m) {
  return !any(!m);
}

/// Choice lane by lane, between packs and between aggregates of packs.
template <int W>
Pack<W> select(const Mask<W>& take_first, const Pack<W>& a, const Pack<W>& b) {
  Pack<W> c;
  for (int i = 0; i < Pack<W>::chunks; ++i) c.r[i] = take_first.f[i] ? a.r[i] : b.r[i];
  return c;
}
template <int W, class S, int N>
Jet<S, N> select(const Mask<W>& take_first, const Jet<S, N>& a, const Jet<S, N>& b) {
  Jet<S, N> c;
  c.a = select(take_first, a.a, b.a);
  for (int i = 0; i < N; ++i) c.d[i] = select(take_first, a.d[i], b.d[i]);
  return c;
}
template <int W, class S, int K>
Taylor<S, K> select(const Mask<W>& take_first, const Taylor<S, K>& a, const Taylor<S, K>& b) {
  Taylor<S, K> c;
  for (int k = 0; k <= K; ++k) c.c[k] = select(take_first, a.c[k], b.c[k]);
  return c;
}
template <int W, class S, int N>
Vec<S, N> select(const Mask<W>& take_first, const Vec<S, N>& a, const Vec<S, N>& b) {
  Vec<S, N> c;
  for (int i = 0; i < N; ++i) c[i] = select(take_first, a[i], b[i]);
  return c;
}

/// Evaluates both sides where the lanes disagree, otherwise only the side that all lanes take. This saves time and
/// changes no value.
template <int W, class First, class Second>
auto choose(const Mask<W>& take_first, const First& first, const Second& second) -> decltype(first()) {
  if (all(take_first)) return first();
  if (!any(take_first)) return second();
  return select(take_first, first(), second());
}

/// Reads and writes one lane of a vector or matrix of packs.
template <int W, int N>
Vec<double, N> get_lane(const Vec<Pack<W>, N>& a, int lane) {
  Vec<double, N> r;
  for (int i = 0; i < N; ++i) r[i] = a[i][lane];
  return r;
}
template <int W, int N>
void set_lane(Vec<Pack<W>, N>& a, int lane, const Vec<double, N>& value) {
  for (int i = 0; i < N; ++i) a[i].set(lane, value[i]);
}
template <int W, int R, int C>
Mat<double, R, C> get_lane(const Mat<Pack<W>, R, C>& a, int lane) {
  Mat<double, R, C> r;
  for (int i = 0; i < R * C; ++i) r.m[i] = a.m[i][lane];
  return r;
}
template <int W, int R, int C>
void set_lane(Mat<Pack<W>, R, C>& a, int lane, const Mat<double, R, C>& value) {
  for (int i = 0; i < R * C; ++i) a.m[i].set(lane, value.m[i]);
}

}  // namespace BOUGH_REGISTER_NAMESPACE
}  // namespace bough::lanes
