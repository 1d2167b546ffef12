#include "bough/study/errors.hpp"

#include <algorithm>
#include <cmath>

#include "bough/motion/quaternion.hpp"

namespace bough::study {
namespace {

using Quaternion = motion::Quaternion<double>;

constexpr double round_off = 1e-13;  // smaller relative errors say nothing about a method

Quaternion quaternion_of(const std::vector<double>& r) {
  if (r.size() == 4) return motion::normalise(Quaternion{r[0], {{r[1], r[2], r[3]}}});
  const double angle = std::hypot(r[0], r[1], r[2]);
  const double f = angle > 0.0 ? std::sin(0.5 * angle) / angle : 0.5;
  return {std::cos(0.5 * angle), {{f * r[0], f * r[1], f * r[2]}}};
}

double norm(const std::vector<double>& v) {
  double largest = 0.0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  if (largest == 0.0) return 0.0;
  double sum = 0.0;
  for (const double x : v) sum += (x / largest) * (x / largest);
  return largest * std::sqrt(sum);
}

}  // namespace

double distance(io::QuantityKind kind, const std::vector<double>& value, const std::vector<double>& reference) {
  if (kind != io::QuantityKind::vector) {
    const Quaternion q = motion::multiply(motion::conjugate(quaternion_of(reference)), quaternion_of(value));
    return 2.0 * std::atan2(std::hypot(q.v[0], q.v[1], q.v[2]), std::abs(q.w));
  }
  std::vector<double> difference = value;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= reference[i];
  return norm(difference);
}

double error_scale(io::QuantityKind kind, const Samples& reference) {
  if (kind != io::QuantityKind::vector) return 1.0;
  double scale = 0.0;
  for (const std::vector<double>& r : reference) scale = std::max(scale, norm(r));
  return scale > 0.0 ? scale : 1.0;
}

ErrorNorms eval_errors(io::QuantityKind kind, const Samples& values, const Samples& reference, double scale) {
  ErrorNorms e;
  double sum = 0.0, largest = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < std::min(values.size(), reference.size()); ++k) {
    if (values[k].empty() || reference[k].empty()) continue;
    const double d = distance(kind, values[k], reference[k]) / scale;
    largest = std::max(largest, d);
    sum += d * d;
    ++count;
    if (k + 1 == reference.size()) e.end = d;
  }
  if (count == 0) return e;
  e.max = largest;
  e.rms = std::sqrt(sum / static_cast<double>(count));
  return e;
}

Samples extrapolated(io::QuantityKind kind, const Samples& fine, const Samples& coarse, double order) {
  const double part = 1.0 / (std::exp2(order) - 1.0);
  Samples limit(std::min(fine.size(), coarse.size()));
  for (std::size_t k = 0; k < limit.size(); ++k) {
    if (fine[k].empty() || coarse[k].empty()) continue;
    if (kind == io::QuantityKind::vector) {
      limit[k] = fine[k];
      for (std::size_t i = 0; i < limit[k].size(); ++i) limit[k][i] += part * (fine[k][i] - coarse[k][i]);
      continue;
    }
    const Quaternion q = quaternion_of(fine[k]), d = motion::multiply(motion::conjugate(quaternion_of(coarse[k])), q);
    const double sine = std::hypot(d.v[0], d.v[1], d.v[2]), half = std::atan2(sine, std::abs(d.w));
    const double f = sine > 0.0 ? std::copysign(std::sin(part * half) / sine, d.w) : 0.0;
    const Quaternion r = motion::multiply(q, Quaternion{std::cos(part * half), {{f * d.v[0], f * d.v[1], f * d.v[2]}}});
    limit[k] = {r.w, r.v[0], r.v[1], r.v[2]};
  }
  return limit;
}

double log_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  if (x.size() < 2) return unmeasured;
  double mean_x = 0.0, mean_y = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    mean_x += std::log(x[k]) / n;
    mean_y += std::log(y[k]) / n;
  }
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double dx = std::log(x[k]) - mean_x;
    sxx += dx * dx;
    sxy += dx * (std::log(y[k]) - mean_y);
  }
  return sxx > 0.0 ? sxy / sxx : unmeasured;
}

OrderFit fit_order(const std::vector<double>& h, const std::vector<double>& error, double uncertainty) {
  std::vector<std::size_t> usable;
  for (std::size_t k = 0; k < h.size(); ++k)
    if (std::isfinite(error[k]) && error[k] > round_off) usable.push_back(k);
  OrderFit fit;
  for (std::size_t end = usable.size(); end >= 2; --end) {
    const std::size_t begin = end > fitted_points ? end - fitted_points : 0;
    const std::size_t first = usable[begin], last = usable[end - 1];
    // the change of the slope between the ends that the reference's own error can cause
    if (!(uncertainty / error[last] <= largest_doubt * std::log(h[first] / h[last]))) continue;
    std::vector<double> x, y;
    for (std::size_t k = begin; k < end; ++k) {
      fit.runs.push_back(usable[k]);
      x.push_back(h[usable[k]]);
      y.push_back(error[usable[k]]);
    }
    fit.order = log_slope(x, y);
    break;
  }
  return fit;
}

void judge(OrderFit& fit) {
  if (std::isnan(fit.expected))
    fit.verdict = Verdict::not_stated;
  else if (std::isnan(fit.order))
    fit.verdict = Verdict::not_measured;
  else if (fit.order < fit.expected - order_tolerance)
    fit.verdict = Verdict::below;
  else if (fit.order <= fit.expected + order_tolerance)
    fit.verdict = Verdict::holds;
  else
    fit.verdict = fit.explanation.empty() ? Verdict::above : Verdict::explained;
}

const char* text_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::not_stated:
      return "not stated";
    case Verdict::not_measured:
      return "not measured";
    case Verdict::holds:
      return "holds";
    case Verdict::explained:
      return "above, explained";
    case Verdict::above:
      return "above";
    case Verdict::below:
      return "below";
  }
  return "";
}

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  const double median = n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
  return {median, values.front(), values.back()};
}

}  // namespace bough::study
