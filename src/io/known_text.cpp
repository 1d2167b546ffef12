#include "bough/io/known_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "bough/io/number_text.hpp"

namespace bough::io {

namespace {

int exponent_of(double x) { return static_cast<int>(std::floor(std::log10(std::abs(x)))); }

std::string printed(const char* format, int digits, double x) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, digits, x);
  return text.data();
}

}  // namespace

std::string known_text(double value, double error) {
  constexpr int least_exponent = -5, most_exponent = 9, most_digits = 15;
  error = std::abs(error);
  if (!std::isfinite(value)) return rounded_text(value, 3);
  if (!std::isfinite(error)) return rounded_text(value, 3) + " +- ?";
  if (error == 0.0) return rounded_text(value, 10);
  int place = exponent_of(error);  // of the last digit
  double digit = std::ceil(error / std::pow(10.0, place) * (1.0 - 1e-9));
  if (digit >= 10.0) {
    digit = 1.0;
    ++place;
  }
  const std::string told = rounded_text(digit * std::pow(10.0, place), 6);
  const double rounded = std::round(value / std::pow(10.0, place)) * std::pow(10.0, place);
  if (rounded == 0.0) return "0 +- " + told;
  const int exponent = exponent_of(rounded);
  if (place >= 0 && exponent < most_exponent) return printed("%.*f", 0, rounded) + " +- " + told;
  if (exponent >= least_exponent && exponent < most_exponent)
    return printed("%.*f", std::min(-place, most_digits), value) + " +- " + told;
  return printed("%.*e", std::clamp(exponent - place, 0, most_digits), value) + " +- " + told;
}

}  // namespace bough::io
