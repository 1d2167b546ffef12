#include "extrapolation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/io/number_text.hpp"

namespace bough::run {

using records::ErrorPart;
using records::ErrorState;

namespace {

/// How far D may be from q d, over q times the largest d. Below: an error of first order as large as one third of the
/// second-order one already takes a quarter off, and makes the prediction half of the truth. Above: the next term of
/// the series, which grows sixteenfold, adds a whole q d to D where it is 7 % of the error.
constexpr double most_below = 0.25, most_above = 1.0;

class Magnitudes {
 public:
  Magnitudes(const std::vector<double>& values, std::size_t width) : values_(values), width_(width) {}
  std::size_t size() const { return values_.size() / width_; }
  double at(std::size_t k) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < width_; ++i) sum = std::hypot(sum, values_[k * width_ + i]);
    return sum;
  }
  double largest() const {
    double most = 0.0;
    for (std::size_t k = 0; k < size(); ++k) most = std::max(most, at(k));
    return most;
  }
  double root_mean_square() const {
    double sum = 0.0;
    for (const double v : values_) sum += v * v;
    return size() == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(size()));
  }
  std::size_t place_of_largest() const {
    std::size_t place = 0;
    for (std::size_t k = 1; k < size(); ++k)
      if (at(k) > at(place)) place = k;
    return place;
  }

 private:
  const std::vector<double>& values_;
  std::size_t width_;
};

/// Number of times from the start up to which the differences are those of an error of order log2(q).
std::size_t times_of_order(const MemberDifferences& d, double q, double round_off) {
  const std::size_t times = d.fine.size() / d.width;
  const double largest = std::max(round_off, Magnitudes(d.fine, d.width).largest());
  for (std::size_t k = 0; k < times; ++k) {
    double along = 0.0, off = 0.0;
    for (std::size_t i = k * d.width; i < (k + 1) * d.width; ++i) {
      const double delta = d.coarse[i] - q * d.fine[i];
      along += delta * d.fine[i];
      off += delta * delta;
    }
    if (!(std::sqrt(off) <= (along > 0.0 ? most_above : most_below) * q * largest)) return k;
  }
  return times;
}

double log2_ratio(double above, double below) {
  return above > 0.0 && below > 0.0 ? std::log2(above / below) : std::numeric_limits<double>::quiet_NaN();
}

/// Limit minus run.
std::vector<double> error_of(const MemberDifferences& d, int run, double q) {
  std::vector<double> error = d.fine;
  for (std::size_t i = 0; i < error.size(); ++i) {
    error[i] /= q - 1.0;
    if (run >= 1) error[i] += d.fine[i];
    if (run >= 2) error[i] += d.coarse[i];
  }
  return error;
}

}  // namespace

Extrapolation extrapolate(const MemberDifferences& d, std::span<const double> times, int run,
                          const ErrorTheory& theory) {
  Extrapolation result;
  ErrorPart& part = result.part;
  const Magnitudes fine(d.fine, d.width), coarse(d.coarse, d.width);
  if (fine.size() == 0) return result;
  part.theoretical_order = theory.order;
  part.spread = std::max(fine.largest(), coarse.largest());
  part.has_finer = run > 0;
  const auto tell = [&part, times](const Magnitudes& m) {
    part.largest = m.largest();
    part.root_mean_square = m.root_mean_square();
    part.when = times[m.place_of_largest()];
  };
  // How far the run is from the finest member, which agrees with the limit where it agrees with the next one.
  const double apart = run == 2 ? std::max(fine.largest(), coarse.largest()) : fine.largest();
  if (apart <= theory.round_off) {
    part.state = ErrorState::round_off;
    part.largest = part.root_mean_square = theory.round_off;
    return result;
  }
  const double q = std::exp2(theory.order);
  std::size_t good = 0;
  if (coarse.size() == 0) {
    part.state = ErrorState::unexamined;
  } else {
    part.order_of_largest = log2_ratio(coarse.largest(), fine.largest());
    part.order_of_root_mean_square = log2_ratio(coarse.root_mean_square(), fine.root_mean_square());
    good = times_of_order(d, q, theory.round_off);
    part.state = good == fine.size() ? ErrorState::resolved : ErrorState::not_resolved;
  }
  if (part.state != ErrorState::not_resolved) {
    result.error = error_of(d, run, q);
    tell(Magnitudes(result.error, d.width));
    part.at_end = d.width == 1 ? result.error.back() : Magnitudes(result.error, d.width).at(fine.size() - 1);
    return result;
  }
  if (apart <= theory.floor) {
    part.state = ErrorState::round_off;
    part.largest = part.root_mean_square = theory.floor;
    return result;
  }
  const bool is_of_coarsest = run == 2;
  tell(is_of_coarsest ? coarse : fine);
  if (good > 0 && good < fine.size())
    part.cause = "from " + io::rounded_text(times[good], 4) + " on members do not differ as an error of order " +
                 io::rounded_text(theory.order, 2) + " does";
  return result;
}

}  // namespace bough::run
