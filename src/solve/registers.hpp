#pragma once
/// A register of doubles, as wide as the instruction set has them, for the kernels of one front and of eight. Internal
/// to solve.
///
/// Products are fused (rounded once) if the instruction set supports it, in registers as well as in single numbers, so
/// the bits of an entry do not depend on its position in a register.
#include <cstring>

#include "bough/lanes/pack.hpp"

namespace bough::solve::registers {

constexpr int width = lanes::register_doubles;
static_assert(width >= 2, "bough needs the vector extensions of GCC or Clang on a machine with SSE2");

using Lanes = lanes::detail::Register<width>::Real;
using Flag = lanes::detail::Register<width>::Flag;

inline Lanes load(const double* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void store(double* p, const Lanes& v) { std::memcpy(p, &v, sizeof v); }
inline Lanes all(double x) { return Lanes{} + x; }

/// a b + c.
inline Lanes add_product(const Lanes& a, const Lanes& b, const Lanes& c) { return lanes::detail::fused(a, b, c); }
inline double add_product(double a, double b, double c) { return lanes::detail::fused(a, b, c); }
/// c - a b.
inline Lanes take_product(const Lanes& a, const Lanes& b, const Lanes& c) {
#if defined(__AVX512F__)
  return Lanes(_mm512_fnmadd_pd(__m512d(a), __m512d(b), __m512d(c)));
#elif defined(__FMA__)
  return Lanes(_mm256_fnmadd_pd(__m256d(a), __m256d(b), __m256d(c)));
#else
  return c - a * b;
#endif
}
inline double take_product(double a, double b, double c) { return lanes::detail::fused(-a, b, c); }

constexpr long long infinite_bits = 0x7ff0000000000000LL;
inline Flag bits_of(const Lanes& x) {
  Flag bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
inline Lanes from_bits(const Flag& bits) {
  Lanes x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
inline Lanes magnitude(const Lanes& x) { return from_bits(bits_of(x) & (Flag{} + 0x7fffffffffffffffLL)); }
/// Greater magnitude, compared as bits, in which infinity and NaN are the largest. Precondition: neither is negative.
inline Lanes greater_of(const Lanes& a, const Lanes& b) {
  const Flag x = bits_of(a), y = bits_of(b);
  return from_bits(x > y ? x : y);
}

}  // namespace bough::solve::registers
