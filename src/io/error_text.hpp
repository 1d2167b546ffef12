#pragma once
#include <string>
#include <system_error>

namespace bough::io {

/// What the system says of an error number (errno).
inline std::string error_text(int error) { return std::error_code(error, std::generic_category()).message(); }

}  // namespace bough::io
