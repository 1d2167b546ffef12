#pragma once
/// Numbers with what is known of them, for people.
#include <string>

namespace bough::io {

/// "0.33523 +- 4e-5": the error with one digit, rounded up, and the value to the digit that the error leaves uncertain. Of an
/// error of 0 ten digits are written and no error; of one that is not finite "0.335 +- ?", with three digits.
std::string known_text(double value, double error);

}  // namespace bough::io
