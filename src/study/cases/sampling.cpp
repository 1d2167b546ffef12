#include "bough/study/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace bough::study {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> key) {
  const auto product = [](std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} * b; };
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p = product(0xD2511F53u, c[0]), q = product(0xCD9E8D57u, c[2]);
    c = {static_cast<std::uint32_t>(q >> 32u) ^ c[1] ^ key[0], static_cast<std::uint32_t>(q),
         static_cast<std::uint32_t>(p >> 32u) ^ c[3] ^ key[1], static_cast<std::uint32_t>(p)};
    key[0] += 0x9E3779B9u;  // golden ratio
    key[1] += 0xBB67AE85u;  // sqrt(3) - 1
  }
  return c;
}

double uniform_draw(std::uint64_t seed, std::uint32_t stream, std::uint64_t row) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32u); };
  const auto bits = philox({low(row), high(row), stream, 0}, {low(seed), high(seed)});
  const std::uint64_t word = (std::uint64_t{bits[1]} << 32u) | bits[0];
  // 52 bits and a half, so that the largest is no 1 and the smallest no 0.
  return (static_cast<double>(word >> 12u) + 0.5) * 0x1p-52;
}

std::vector<std::uint32_t> permutation(std::uint64_t seed, std::uint32_t stream, std::uint32_t n) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  for (std::uint32_t i = n; i > 1; --i) {
    const auto j = static_cast<std::uint32_t>(uniform_draw(seed, stream, i) * i);
    std::swap(order[i - 1], order[std::min(j, i - 1)]);
  }
  return order;
}

namespace {

/// x^degree + ... + 1 with the inner coefficients in the bits of `inner`, and the first direction numbers.
struct SobolDimension {
  unsigned degree, inner;
  std::array<std::uint32_t, 7> first;
};

// new-joe-kuo-6, dimensions 2 to 21; the first dimension is van der Corput's sequence.
constexpr std::array<SobolDimension, most_sobol_dimensions - 1> sobol_dimensions{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
}};

constexpr unsigned bits = 32;
using Directions = std::array<std::uint32_t, bits>;

Directions directions_of(std::size_t dimension) {
  Directions v{};
  if (dimension == 0) {
    for (unsigned k = 0; k < bits; ++k) v[k] = 1u << (bits - 1 - k);
    return v;
  }
  const SobolDimension& d = sobol_dimensions[dimension - 1];
  for (unsigned k = 0; k < bits; ++k) {
    if (k < d.degree) {
      v[k] = d.first[k] << (bits - 1 - k);
      continue;
    }
    v[k] = v[k - d.degree] ^ (v[k - d.degree] >> d.degree);
    for (unsigned j = 1; j < d.degree; ++j)
      if (((d.inner >> (d.degree - 1 - j)) & 1u) != 0) v[k] ^= v[k - j];
  }
  return v;
}

}  // namespace

double sobol_point(std::uint32_t row, std::size_t dimension) {
  static const auto table = [] {
    std::array<Directions, most_sobol_dimensions> all{};
    for (std::size_t d = 0; d < all.size(); ++d) all[d] = directions_of(d);
    return all;
  }();
  const std::uint32_t gray = row ^ (row >> 1u);
  std::uint32_t x = 0;
  for (unsigned k = 0; k < bits; ++k)
    if (((gray >> k) & 1u) != 0) x ^= table[dimension][k];
  return static_cast<double>(x) * 0x1p-32;
}

double normal_quantile(double u) {
  const double tail = std::min(u, 1.0 - u);
  const double r = std::sqrt(-2.0 * std::log(tail));
  double x = (2.515517 + r * (0.802853 + r * 0.010328)) / (1.0 + r * (1.432788 + r * (0.189269 + r * 0.001308))) - r;
  for (int k = 0; k < 3; ++k) {  // cubic from 4.5e-4
    const double error = 0.5 * std::erfc(-x / std::numbers::sqrt2) - tail;
    const double step = error * std::sqrt(2.0 * std::numbers::pi) * std::exp(0.5 * x * x);
    x -= step / (1.0 + 0.5 * x * step);
  }
  return u < 0.5 ? x : -x;
}

double quantile(const Distribution& d, double u) {
  switch (d.kind) {
    case Distribution::Kind::uniform:
      return d.low + (d.high - d.low) * u;
    case Distribution::Kind::normal:
      return d.mean + d.deviation * normal_quantile(u);
    case Distribution::Kind::lognormal:
      return std::exp(d.mean + d.deviation * normal_quantile(u));
    case Distribution::Kind::discrete:
      break;
  }
  if (d.weights.empty())
    return d.values[std::min(d.values.size() - 1, static_cast<std::size_t>(u * static_cast<double>(d.values.size())))];
  double below = 0.0;
  const double wanted = u * std::accumulate(d.weights.begin(), d.weights.end(), 0.0);
  for (std::size_t k = 0; k + 1 < d.values.size(); ++k)
    if (wanted < (below += d.weights[k])) return d.values[k];
  return d.values.back();
}

}  // namespace bough::study
