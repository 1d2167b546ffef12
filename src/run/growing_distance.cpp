#include "growing_distance.hpp"

#include <algorithm>
#include <cmath>

namespace bough::run {

namespace {

constexpr double lost = 0.1;     ///< of the range: half of the amplitude is two tenths of it away from all agreement
constexpr double noise = 1e-12;  ///< of the range: round-off
constexpr double least_share = 0.2;  ///< of the growth, in each half of the time in which it is looked at
constexpr double most_power = 64;    ///< growth while time doubles that a power of time, up to t^6, explains

}  // namespace

void GrowingDistance::add(const MemberDifferences& d, double range) {
  const std::size_t times = d.fine.size() / d.width;
  distance_.resize(std::max(distance_.size(), times), 0.0);
  double largest = 0.0;
  for (std::size_t k = 0; k < times; ++k) {
    double square = 0.0;
    for (std::size_t i = k * d.width; i < (k + 1) * d.width; ++i) square += d.fine[i] * d.fine[i];
    largest = std::max(largest, std::sqrt(square) / range);
    distance_[k] = std::max(distance_[k], largest);
  }
}

std::optional<Sensitivity> GrowingDistance::look(std::span<const double> times) const {
  const std::size_t count = std::min(distance_.size(), times.size());
  if (count < 8) return std::nullopt;
  const double begin = times.front();
  const auto is_lost = [](double d) { return d >= lost; };
  const auto found = std::find_if(distance_.begin(), distance_.begin() + static_cast<std::ptrdiff_t>(count), is_lost);
  const std::size_t end = std::min(static_cast<std::size_t>(found - distance_.begin()), count - 1);
  const auto place = [&](double part) {
    const double time = begin + part * (times[end] - begin);
    return static_cast<std::size_t>(
        std::lower_bound(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(end), time) - times.begin());
  };
  const std::size_t half = place(0.5), later = place(0.75);
  if (!(distance_[half] > noise) || !(distance_[end] > most_power * distance_[half])) return std::nullopt;
  const double first = std::log(distance_[later] / distance_[half]),
               second = std::log(distance_[end] / distance_[later]);
  if (std::min(first, second) < least_share * (first + second)) return std::nullopt;  // something happens at an instant
  Sensitivity s;
  s.grows_in = (times[end] - times[half]) / std::log(distance_[end] / distance_[half]);
  if (found != distance_.begin() + static_cast<std::ptrdiff_t>(count)) s.lost_from = times[end];
  return s;
}

}  // namespace bough::run
