#pragma once
#include <string>

#include "bough/records/errors.hpp"

namespace bough::app {

/// The errors that twins have measured, as lines of the text of a run.
std::string errors_text(const records::MeasuredErrors& errors);

}  // namespace bough::app
