#pragma once
/// Numbers as text and back, in the C locale whatever the process has set.
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

}  // namespace bough::io
