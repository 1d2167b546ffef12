#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "bough/run/measures.hpp"

namespace bough::run {
namespace {

double duration_of(const Series& s) { return s.times.empty() ? 0.0 : s.times.back() - s.times.front(); }

/// Sum of f(width, value at begin, value at end) over all intervals, divided by the whole duration.
template <class F>
double average(const Series& s, const F& f) {
  double sum = 0.0;
  for (std::size_t k = 1; k < s.times.size(); ++k) sum += f(s.times[k] - s.times[k - 1], s.values[k - 1], s.values[k]);
  return sum / duration_of(s);
}

}  // namespace

double mean_of(const Series& s) {
  if (!(duration_of(s) > 0.0)) return s.values.back();
  return average(s, [](double h, double a, double b) { return 0.5 * h * (a + b); });
}

double rms_of(const Series& s) {
  if (!(duration_of(s) > 0.0)) return std::abs(s.values.back());
  return std::sqrt(average(s, [](double h, double a, double b) { return h * (a * a + a * b + b * b) / 3.0; }));
}

double percentile_of(const Series& s, double percent) {
  const auto [low, high] = std::minmax_element(s.values.begin(), s.values.end());
  if (!(duration_of(s) > 0.0) || *low == *high) return s.values.back();
  // Share of the time spent at or below x, with straight lines between values. It increases with x.
  const auto part_below = [&](double x) {
    return average(s, [x](double h, double a, double b) {
      const double least = std::min(a, b), most = std::max(a, b);
      return x >= most ? h : x <= least ? 0.0 : h * (x - least) / (most - least);
    });
  };
  const double wanted = 0.01 * percent;
  double below = *low, above = *high;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * below + 0.5 * above;
    if (!(middle > below && middle < above)) break;
    (part_below(middle) < wanted ? below : above) = middle;
  }
  return above;
}

std::optional<double> settling_time_of(const Series& s, double target, double band) {
  const auto distance = [&](std::size_t k) { return std::abs(s.values[k] - target); };
  std::size_t k = s.times.size();
  while (k > 0 && distance(k - 1) <= band) --k;
  if (k == s.times.size()) return std::nullopt;
  if (k == 0) return s.times.front();
  // The quantity enters the band between k - 1 and k, at the edge on the side on which it was outside.
  const double edge = target + std::copysign(band, s.values[k - 1] - target);
  const double part = (edge - s.values[k - 1]) / (s.values[k] - s.values[k - 1]);
  return s.times[k - 1] + std::clamp(part, 0.0, 1.0) * (s.times[k] - s.times[k - 1]);
}

namespace {

/// Discrete Fourier transform in place, of 2^k values (Cooley, Tukey 1965).
void transform(std::vector<std::complex<double>>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1u;
    for (; (j & bit) != 0; bit >>= 1u) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t length = 2; length <= n; length <<= 1u)
    for (std::size_t k = 0; k < length / 2; ++k) {
      const std::complex<double> w =
          std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length));
      for (std::size_t begin = 0; begin < n; begin += length) {
        const std::complex<double> a = x[begin + k], b = w * x[begin + k + length / 2];
        x[begin + k] = a + b;
        x[begin + k + length / 2] = a - b;
      }
    }
}

/// Samples of the straight lines at n equal intervals, less the mean and times a Hann window. The end is left out, as
/// for a period.
std::vector<std::complex<double>> equal_samples(const Series& s, std::size_t n) {
  std::vector<std::complex<double>> samples(n);
  const double mean = mean_of(s), duration = duration_of(s);
  std::size_t k = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(n), t = s.times.front() + share * duration;
    while (k + 1 < s.times.size() && s.times[k] < t) ++k;
    const double h = s.times[k] - s.times[k - 1];
    const double part = h > 0.0 ? std::clamp((t - s.times[k - 1]) / h, 0.0, 1.0) : 1.0;
    const double window = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * share);
    samples[i] = window * (std::lerp(s.values[k - 1], s.values[k], part) - mean);
  }
  return samples;
}

}  // namespace

std::optional<double> dominant_frequency_of(const Series& s) {
  constexpr std::size_t least_steps = 8, most_samples = std::size_t{1} << 22u;
  const auto [low, high] = std::minmax_element(s.values.begin(), s.values.end());
  if (s.times.size() <= least_steps || !(duration_of(s) > 0.0) || *low == *high) return std::nullopt;
  std::size_t n = 16;
  while (n < 2 * s.times.size() && n < most_samples) n *= 2;
  std::vector<std::complex<double>> spectrum = equal_samples(s, n);
  transform(spectrum);
  std::size_t peak = 1;
  for (std::size_t k = 2; k < n / 2; ++k)
    if (std::norm(spectrum[k]) > std::norm(spectrum[peak])) peak = k;
  const auto level = [&](std::size_t k) { return 0.5 * std::log(std::max(std::norm(spectrum[k]), 1e-300)); };
  const double before = level(peak - 1), at = level(peak), after = level(peak + 1);
  const double bend = before - 2.0 * at + after;
  const double shift = bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
  return (static_cast<double>(peak) + shift) / duration_of(s);
}

std::vector<LoadCycle> rainflow_of(std::span<const double> values) {
  std::vector<LoadCycle> cycles;
  std::vector<double> points;  // turning points not yet counted
  const auto range = [&](std::size_t from_end) {
    return std::abs(points[points.size() - from_end] - points[points.size() - from_end - 1]);
  };
  const auto count = [&](double a, double b, double n) { cycles.push_back({std::abs(a - b), 0.5 * (a + b), n}); };
  const auto take = [&](double point) {
    points.push_back(point);
    while (points.size() >= 3 && range(1) >= range(2)) {
      const std::size_t n = points.size();
      if (n == 3) {  // the earlier range contains the start: half a cycle
        count(points[0], points[1], 0.5);
        points.erase(points.begin());
      } else {
        count(points[n - 3], points[n - 2], 1.0);
        points.erase(points.end() - 3, points.end() - 1);
      }
    }
  };
  // A value is a turning point if the change to the next different value has the opposite sign of the change before.
  std::optional<double> before, last;
  for (const double x : values) {
    if (last && x == *last) continue;
    if (last && (!before || (x > *last) != (*last > *before))) take(*last);
    before = last;
    last = x;
  }
  if (last) take(*last);
  for (std::size_t k = 1; k < points.size(); ++k) count(points[k - 1], points[k], 0.5);
  return cycles;
}

double equivalent_range(std::span<const LoadCycle> cycles, double exponent, double number) {
  double most = 0.0, sum = 0.0;
  for (const LoadCycle& c : cycles) most = std::max(most, c.range);
  if (most == 0.0) return 0.0;
  for (const LoadCycle& c : cycles) sum += c.count * std::pow(c.range / most, exponent);  // no power overflows
  return most * std::pow(sum / number, 1.0 / exponent);
}

}  // namespace bough::run
