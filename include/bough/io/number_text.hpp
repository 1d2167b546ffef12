#pragma once
/// Numbers as text and back, in the C locale whatever the process has set.
#include <limits>
#include <string>
#include <string_view>

namespace bough::io {

/// Appends the shortest decimal text that reads back to the same double. Non-finite: `nan`, `inf`, `-inf`.
void append_number(std::string& text, double value);
void append_number(std::string& text, long long value);

/// Appends the value with at most `digits` significant digits (1 to 17), for text that people or pictures read.
void append_rounded(std::string& text, double value, int digits);
std::string rounded_text(double value, int digits);

/// Reads the whole of `text` as a double (also `nan`, `inf`, `-inf`); false where it is anything else.
[[nodiscard]] bool read_number(std::string_view text, double& value);

/// A number of a file as an integer: without its fraction, and the nearest bound of the type where it lies beyond; 0 for
/// NaN. A plain conversion of such numbers is undefined, and a file is converted before all its faults are told.
template <class Integer>
constexpr Integer whole_number(double x) {
  using Limits = std::numeric_limits<Integer>;
  if (!(x > static_cast<double>(Limits::min()))) return x != x ? Integer{0} : Limits::min();
  return x < static_cast<double>(Limits::max()) ? static_cast<Integer>(x) : Limits::max();
}

}  // namespace bough::io
