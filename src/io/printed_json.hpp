#pragma once
#include <string>

#include "bough/io/json_value.hpp"

namespace bough::io {

/// A value as text for people. Values that fit are written on one line of up to 120 characters; numbers are the
/// shortest that read back to the same bits. Defaults are omitted.
std::string printed(const JsonValue& value);

}  // namespace bough::io
