#pragma once
/// Quantities with a fitting unit, for text that people read.
#include <string>

namespace bough::io {

/// Three digits and s, ms, us or ns; "-" where not finite, "0" for zero.
std::string seconds_text(double seconds);
/// Three digits and k, M, G or T: 12.3k.
std::string amount_text(double amount);
/// The same in bytes: 12.3 MB (powers of 1000).
std::string bytes_text(double bytes);

}  // namespace bough::io
