#pragma once
/// Points in the unit cube and distributions of numbers, for sweeps. Everything is a function of a seed and of
/// counters: no state, so that cases may be made in any order and on any machine.
#include <array>
#include <cstdint>
#include <vector>

#include "bough/io/sweep_spec.hpp"

namespace bough::study {

/// Philox4x32-10: ten rounds of a bijection of 128 bits by a key of 64 (Salmon, Moraes, Dror, Shaw 2011, Parallel
/// random numbers: as easy as 1, 2, 3).
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// A number in (0, 1), neither of its ends, of 53 bits: the draw of `row` in a stream of a seed.
double uniform_draw(std::uint64_t seed, std::uint32_t stream, std::uint64_t row);

/// A permutation of 0 ... n - 1 (Fisher, Yates) by the draws of a stream.
std::vector<std::uint32_t> permutation(std::uint64_t seed, std::uint32_t stream, std::uint32_t n);

/// Point `row` of Sobol's sequence in `dimension` (from 0), in [0, 1), of 32 bits; direction numbers of Joe and Kuo
/// 2008, Constructing Sobol sequences with better two-dimensional projections. Row 0 is the origin.
double sobol_point(std::uint32_t row, std::size_t dimension);
inline constexpr std::size_t most_sobol_dimensions = 21;

using Distribution = io::SweepDistribution;

/// The value of x that a number of the distribution does not exceed with probability u, 0 < u < 1.
double quantile(const Distribution& d, double u);

/// Quantile of the standard normal distribution: A. and S. 26.2.23, made exact by Halley's steps on erfc.
double normal_quantile(double u);

}  // namespace bough::study
