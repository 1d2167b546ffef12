#pragma once
/// Measured errors of a run as bands about its curves.
#include <vector>

#include "bough/io/history.hpp"

namespace bough::report {

/// By column of the history: half the width of its band at each row, the magnitudes of the known errors in time and of
/// the mesh added; not a number where neither is known. errors: rows of errors.csv. Empty where these are not at the
/// times of the history.
std::vector<std::vector<double>> error_bands(const io::History& history, const io::History& errors);

}  // namespace bough::report
