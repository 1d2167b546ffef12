#pragma once
#include <vector>

#include "bough/records/table.hpp"
#include "bough/report/chart.hpp"

namespace bough::report {

/// What a table of an analysis shows as charts: of frequency responses amplitudes and phases, of spectra their densities.
/// Empty: nothing beside its rows.
std::vector<Chart> charts_of(const records::Table& table);

}  // namespace bough::report
