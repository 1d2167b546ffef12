#include "mode_search.hpp"

#include <algorithm>
#include <cmath>

namespace bough::step {

namespace {

using Part = Linearisation::Part;
using Vector = std::vector<double>;

Vector each(const std::vector<std::complex<double>>& x, double (*part)(const std::complex<double>&)) {
  Vector y(x.size());
  std::transform(x.begin(), x.end(), y.begin(), part);
  return y;
}

}  // namespace

Vector random_vector(const Linearisation& linear, unsigned seed) {
  Vector x(linear.size());
  unsigned long long next = 20 + 7919ULL * seed;
  for (std::size_t i = 0; i < x.size(); ++i) {
    next = next * 6364136223846793005ULL + 1442695040888963407ULL;
    const double w = linear.weights()[i];
    x[i] = w > 0.0 ? (static_cast<double>(next >> 11) * 0x1p-52 - 1.0) / std::sqrt(w) : 0.0;
  }
  return x;
}

Vector motion_of(const Linearisation& linear, const Vector& x) {
  Vector motion = x;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (linear.weights()[i] == 0.0) motion[i] = 0.0;
  return motion;
}

Vector real_part(const std::vector<std::complex<double>>& x) {
  return each(x, [](const std::complex<double>& value) { return value.real(); });
}
Vector imaginary_part(const std::vector<std::complex<double>>& x) {
  return each(x, [](const std::complex<double>& value) { return value.imag(); });
}

/// Rows are weighed as the unknowns to which they belong, and those of constraints not at all. Of a rigid motion, which
/// may strain nothing, the terms are those of the fastest vibration of this shape.
double residual_of(const Linearisation& linear, const Mode& mode, bool with_damping) {
  const Vector re = real_part(mode.shape), im = imaginary_part(mode.shape);
  std::vector<std::complex<double>> sum(linear.size());
  Vector terms(linear.size(), 0.0), a(linear.size()), b(linear.size());
  const std::complex<double> factors[] = {1.0, with_damping ? mode.eigenvalue : 0.0, mode.eigenvalue * mode.eigenvalue};
  for (const Part part : {Part::stiffness, Part::damping, Part::mass}) {
    const std::complex<double> factor = factors[static_cast<std::size_t>(part)];
    const double size_of_terms = mode.is_rigid && part == Part::mass ? linear.fastest() : std::abs(factor);
    if (size_of_terms == 0.0) continue;
    linear.multiply(part, re, a);
    linear.multiply(part, im, b);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * std::complex<double>(a[i], b[i]);
    linear.multiply_magnitudes(part, re, a);
    linear.multiply_magnitudes(part, im, b);
    for (std::size_t i = 0; i < sum.size(); ++i) terms[i] += size_of_terms * (a[i] + b[i]);
  }
  double left = 0.0, size = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (!(linear.weights()[i] > 0.0)) continue;
    left += std::norm(sum[i]) / linear.weights()[i];
    size += terms[i] * terms[i] / linear.weights()[i];
  }
  return size > 0.0 ? std::sqrt(left / size) : 0.0;
}

}  // namespace bough::step
