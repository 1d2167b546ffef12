#pragma once
/// Eight entries of a row, in one register or in several narrower ones. Internal to solve.
#include <cstdint>

#include "lane_registers.hpp"

namespace bough::solve::rows {

using packs::Real;
using packs::width;

constexpr int eight = 8;
constexpr int parts = eight / width;  ///< registers of the machine

struct Eight {
  Real r[parts];
};

using Mask = std::uint8_t;  ///< bit l: lane l
enum class LastLane { as_it_comes, of_low, of_high };

inline Eight load(const double* p) {
  Eight v;
  for (int i = 0; i < parts; ++i) v.r[i] = packs::load(p + i * width);
  return v;
}
inline void store(double* p, const Eight& v) {
  for (int i = 0; i < parts; ++i) packs::store(p + i * width, v.r[i]);
}

#if defined(__AVX512F__)
inline Eight load(const double* p, Mask mask) { return {{Real(_mm512_maskz_loadu_pd(mask, p))}}; }
inline void store(double* p, Mask mask, const Eight& v) { _mm512_mask_storeu_pd(p, mask, __m512d(v.r[0])); }
inline Eight choose(Mask mask, const Eight& yes, const Eight& no) {
  return {{Real(_mm512_mask_mov_pd(__m512d(no.r[0]), mask, __m512d(yes.r[0])))}};
}
inline Real all_of(const Eight& v, int lane) {
  return Real(_mm512_permutexvar_pd(_mm512_set1_epi64(lane), __m512d(v.r[0])));
}
/// c - a b in the lanes of the mask, c in the others.
inline void take_product(Eight& c, Mask mask, const Real& a, const Eight& b) {
  c.r[0] = Real(_mm512_mask3_fnmadd_pd(__m512d(a), __m512d(b.r[0]), __m512d(c.r[0]), mask));
}
/// a b in the lanes of the mask, a in the others.
inline Eight product(const Eight& a, Mask mask, const Real& b) {
  return {{Real(_mm512_mask_mul_pd(__m512d(a.r[0]), mask, __m512d(a.r[0]), __m512d(b)))}};
}
/// a b in the lanes of the mask, zero in the others.
inline Eight product_or_zero(const Eight& a, Mask mask, const Real& b) {
  return {{Real(_mm512_maskz_mul_pd(mask, __m512d(a.r[0]), __m512d(b)))}};
}
/// v, `lane` of `from` in the lane `to`.
inline void take_lane(Eight& v, int to, const Eight& from, int lane) {
  v.r[0] = Real(_mm512_mask_permutexvar_pd(__m512d(v.r[0]), static_cast<Mask>(1 << to), _mm512_set1_epi64(lane),
                                           __m512d(from.r[0])));
}
/// Lanes [shift, shift + 8) of `low` followed by `high`; if requested, the last lane is the last of `low` or of `high`
/// instead.
template <int shift, LastLane last>
inline Eight shifted(const Eight& low, const Eight& high) {
  const auto lane = [](int l) {
    return static_cast<long long>(l < eight - 1 || last == LastLane::as_it_comes ? l + shift
                                  : last == LastLane::of_low                     ? eight - 1
                                                                                 : 2 * eight - 1);
  };
  const __m512i lanes = _mm512_setr_epi64(lane(0), lane(1), lane(2), lane(3), lane(4), lane(5), lane(6), lane(7));
  return {{Real(_mm512_permutex2var_pd(__m512d(low.r[0]), lanes, __m512d(high.r[0])))}};
}
#else
#if defined(__AVX__)
/// Four words, with all bits set where the mask is set.
inline __m256i words_of(int mask) {
  alignas(32) static constexpr long long words[8] = {0, 0, 0, 0, -1, -1, -1, -1};
  return _mm256_setr_epi64x(words[(mask << 2 & 4)], words[(mask << 1 & 4)], words[mask & 4], words[(mask >> 1 & 4)]);
}
inline Eight load(const double* p, Mask mask) {
  return {{Real(_mm256_maskload_pd(p, words_of(mask))), Real(_mm256_maskload_pd(p + width, words_of(mask >> width)))}};
}
inline void store(double* p, Mask mask, const Eight& v) {
  _mm256_maskstore_pd(p, words_of(mask), __m256d(v.r[0]));
  _mm256_maskstore_pd(p + width, words_of(mask >> width), __m256d(v.r[1]));
}
#else
inline Eight load(const double* p, Mask mask) {
  if (mask == 0xff) return load(p);
  alignas(64) double lanes[eight];
  for (int l = 0; l < eight; ++l) lanes[l] = (mask >> l & 1) != 0 ? p[l] : 0.0;
  return load(lanes);
}
inline void store(double* p, Mask mask, const Eight& v) {
  if (mask == 0xff) return store(p, v);
  alignas(64) double lanes[eight];
  store(lanes, v);
  for (int l = 0; l < eight; ++l)
    if ((mask >> l & 1) != 0) p[l] = lanes[l];
}
#endif
inline Eight choose(Mask mask, const Eight& yes, const Eight& no) {
  Eight v;
  for (int i = 0; i < parts; ++i)
    for (int l = 0; l < width; ++l) v.r[i][l] = (mask >> (i * width + l) & 1) != 0 ? yes.r[i][l] : no.r[i][l];
  return v;
}
inline Real all_of(const Eight& v, int lane) { return Real{} + v.r[lane / width][lane % width]; }
inline void take_product(Eight& c, Mask mask, const Real& a, const Eight& b) {
  for (int i = 0; i < parts; ++i) {
    const Real taken = packs::minus_product(c.r[i], a, b.r[i]);
    const int of_part = mask >> (i * width) & ((1 << width) - 1);
    if (of_part == (1 << width) - 1)
      c.r[i] = taken;
    else
      for (int l = 0; l < width; ++l)
        if ((of_part >> l & 1) != 0) c.r[i][l] = taken[l];
  }
}
inline Eight product_or_zero(const Eight& a, Mask mask, const Real& b) {
  Eight v;
  for (int i = 0; i < parts; ++i) v.r[i] = a.r[i] * b;
  return choose(mask, v, Eight{});
}
inline Eight product(const Eight& a, Mask mask, const Real& b) {
  Eight v;
  for (int i = 0; i < parts; ++i) v.r[i] = a.r[i] * b;
  return choose(mask, v, a);
}
inline void take_lane(Eight& v, int to, const Eight& from, int lane) {
  v.r[to / width][to % width] = from.r[lane / width][lane % width];
}
template <int shift, LastLane last>
inline Eight shifted(const Eight& low, const Eight& high) {
  alignas(64) double lanes[2 * eight];
  store(lanes, low);
  store(lanes + eight, high);
  const double end = last == LastLane::of_low ? lanes[eight - 1] : lanes[2 * eight - 1];
  Eight v = load(lanes + shift);
  if (last != LastLane::as_it_comes) v.r[parts - 1][width - 1] = end;
  return v;
}
#endif

inline double lane_of(const Eight& v, int lane) { return v.r[lane / width][lane % width]; }
inline void take_product(Eight& c, const Real& a, const Eight& b) {
  for (int i = 0; i < parts; ++i) c.r[i] = packs::minus_product(c.r[i], a, b.r[i]);
}

}  // namespace bough::solve::rows
