#pragma once
/// Functions that every scalar of a kernel provides: double, std::complex (derivative checks), Jet (forward
/// derivatives), Taylor (time derivatives) and Pack (lanes in lockstep). A kernel that uses no others runs on all of
/// them.
#include <cmath>
#include <complex>
#include <concepts>

/// For functions of a few lines on 3-vectors: inlined even where the compiler's heuristic finds the caller too large, but
/// not without optimisation, where it doubles compile times. BOUGH_NOINLINE: for longer ones called at many places.
#if defined(__GNUC__) && defined(__OPTIMIZE__)
#define BOUGH_INLINE inline __attribute__((always_inline))
#define BOUGH_NOINLINE __attribute__((noinline))
#else
#define BOUGH_INLINE inline
#define BOUGH_NOINLINE
#endif

// Put before a short loop of fixed length over registers: the variables stay in registers only if the loop is unrolled.
#if defined(__clang__)
#define BOUGH_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define BOUGH_UNROLL _Pragma("GCC unroll 8")
#else
#define BOUGH_UNROLL
#endif

namespace bough::lanes {

/// The real number that decides a branch: a double itself, the real part of a complex number, the value of a derivative
/// type.
inline double decide(double x) { return x; }
inline double decide(const std::complex<double>& x) { return x.real(); }

/// Choice without a jump. Both sides are evaluated, so a denominator in the side that is not taken must be made safe.
template <class S>
S select(bool take_first, const S& a, const S& b) {
  return take_first ? a : b;
}

/// Order by the deciding value (see decide). The library's own scalars have overloads found by argument-dependent
/// look-up.
inline bool less(double a, double b) { return a < b; }
inline bool less(const std::complex<double>& a, const std::complex<double>& b) { return a.real() < b.real(); }

/// As above for long double, which is used to check kernels. It is a template so that other arithmetic types still
/// convert to double.
template <std::same_as<long double> T>
double decide(T x) {
  return static_cast<double>(x);
}
template <std::same_as<long double> T>
bool less(T a, T b) {
  return a < b;
}

/// Choice between two costly sides, given as functions without arguments. A flag that is a bool runs one side only.
/// Packs run both sides where their lanes disagree (pack.hpp), so the side that is not taken must still be free of
/// floating-point traps. The values are those of select.
template <class First, class Second>
auto choose(bool take_first, const First& first, const Second& second) {
  return take_first ? first() : second();
}

/// a b + c. For doubles and packs it is rounded once where the instruction set has a fused operation, with the same
/// bits in every lane as for a double; elsewhere, and for all other scalars, it is two operations. The compiler never
/// fuses operations by itself (-ffp-contract=off), so only calls of this function are fused.
template <class S>
S multiply_add(const S& a, const S& b, const S& c) {
  return a * b + c;
}
inline double multiply_add(double a, double b, double c) {
#if defined(__FMA__)
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}
/// a b + c and c - a b where a is a plain number and the others are of a derivative type or complex.
template <class A, class S>
requires(!std::same_as<A, S>) S multiply_add(const A& a, const S& b, const S& c) { return a * b + c; }
template <class A, class S>
S negative_multiply_add(const A& a, const S& b, const S& c) {
  return multiply_add(A(-a), b, c);
}

/// Makes a scalar from a plain number.
template <class S>
S constant(double x) {
  return S(x);
}

/// atan2 of complex arguments, analytic, so that the complex step works through it; |y| and |x| must not both be 0.
inline std::complex<double> atan2(const std::complex<double>& y, const std::complex<double>& x) {
  const double r2 = x.real() * x.real() + y.real() * y.real();
  return {std::atan2(y.real(), x.real()), (x.real() * y.imag() - y.real() * x.imag()) / r2};
}

}  // namespace bough::lanes
