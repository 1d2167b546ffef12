#pragma once
#include <string>

#include "bough/io/json_text.hpp"
#include "bough/records/errors.hpp"

namespace bough::io {

/// errors.csv: in the format of a history, with its times.
std::string errors_csv(const records::MeasuredErrors& errors);

/// The member "errors" of a summary: twins, columns, expected figures and measures with their errors, remarks.
void write_measured_errors(JsonText& json, const records::MeasuredErrors& errors);

}  // namespace bough::io
