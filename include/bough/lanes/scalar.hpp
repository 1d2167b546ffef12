#pragma once
/// Scalar vocabulary shared by every kernel scalar: double, std::complex (derivative checks), Jet (forward
/// derivatives), Taylor (time derivatives) and Pack (lanes in lockstep). A kernel written on these names runs on all
/// of them.
#include <cmath>
#include <complex>
#include <concepts>

/// For the few-line functions on 3-vectors that kernels are made of: inlined whatever the compiler thinks of its
/// caller's size.
#if defined(__GNUC__)
#define BOUGH_INLINE inline __attribute__((always_inline))
#else
#define BOUGH_INLINE inline
#endif

// Before a short loop of fixed length over registers, which stay in registers only where it is written out.
#if defined(__clang__)
#define BOUGH_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define BOUGH_UNROLL _Pragma("GCC unroll 8")
#else
#define BOUGH_UNROLL
#endif

namespace bough::lanes {

/// Value that decides a branch: the scalar itself, the real part of a complex, the value of a derivative type.
inline double decide(double x) { return x; }
inline double decide(const std::complex<double>& x) { return x.real(); }

/// Choice without a jump: both sides are evaluated, so a denominator in the side not taken must be made safe.
template <class S>
S select(bool take_first, const S& a, const S& b) {
  return take_first ? a : b;
}

/// Order by the deciding part; found by argument-dependent look-up for the library's own scalars.
inline bool less(double a, double b) { return a < b; }
inline bool less(const std::complex<double>& a, const std::complex<double>& b) { return a.real() < b.real(); }

/// The same for long double, which checks kernels; a template, so that other arithmetic types keep converting to
/// double.
template <std::same_as<long double> T>
double decide(T x) {
  return static_cast<double>(x);
}
template <std::same_as<long double> T>
bool less(T a, T b) {
  return a < b;
}

/// Choice between two costly sides, given as functions without arguments: one flag runs one side only. Packs run both
/// where their lanes disagree (pack.hpp), so the side not taken must still be free of traps. Values are those of
/// select.
template <class First, class Second>
auto choose(bool take_first, const First& first, const Second& second) {
  return take_first ? first() : second();
}

/// a b + c. Rounded once for doubles and packs where the instruction set has it (every lane as a double), as two
/// operations elsewhere and for all other scalars. The compiler itself never fuses (-ffp-contract=off): only what is
/// written so is.
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
/// a b + c and c - a b with a plain number beside a derivative type or a complex number.
template <class A, class S>
requires(!std::same_as<A, S>) S multiply_add(const A& a, const S& b, const S& c) { return a * b + c; }
template <class A, class S>
S negative_multiply_add(const A& a, const S& b, const S& c) {
  return multiply_add(A(-a), b, c);
}

/// A scalar made from a plain number.
template <class S>
S constant(double x) {
  return S(x);
}

/// atan2 of complex arguments, analytic: the complex step of atan2 [needs |y|,|x| not both 0].
inline std::complex<double> atan2(const std::complex<double>& y, const std::complex<double>& x) {
  const double r2 = x.real() * x.real() + y.real() * y.real();
  return {std::atan2(y.real(), x.real()), (x.real() * y.imag() - y.real() * x.imag()) / r2};
}

}  // namespace bough::lanes
