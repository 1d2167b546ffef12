#include "bough/io/quantity_text.hpp"

#include <cmath>

#include "bough/io/number_text.hpp"

namespace bough::io {

namespace {

struct Scaled {
  double value;
  const char* prefix;
};

Scaled scale(double x) {
  static constexpr const char* prefixes[] = {"", "k", "M", "G", "T"};
  int k = 0;
  while (k < 4 && std::abs(x) >= 999.5) {
    x /= 1000.0;
    ++k;
  }
  return {x, prefixes[k]};
}

}  // namespace

std::string seconds_text(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  if (seconds == 0.0) return "0";
  static constexpr const char* units[] = {" s", " ms", " us", " ns"};
  int k = 0;
  double x = seconds;
  while (k < 3 && std::abs(x) < 0.9995) {
    x *= 1000.0;
    ++k;
  }
  return rounded_text(x, 3) + units[k];
}

std::string amount_text(double amount) {
  if (!std::isfinite(amount)) return "-";
  const Scaled s = scale(amount);
  return rounded_text(s.value, 3) + s.prefix;
}

std::string bytes_text(double bytes) {
  if (!std::isfinite(bytes)) return "-";
  const Scaled s = scale(bytes);
  return rounded_text(s.value, 3) + " " + s.prefix + "B";
}

}  // namespace bough::io
