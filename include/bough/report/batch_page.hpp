#pragma once
/// batch.html: the cases of a batch or sweep as a page.
#include <string>
#include <vector>

#include "bough/study/batch.hpp"

namespace bough::report {

/// A self-contained page: outcomes of the cases and causes of failures, measures over all cases, and sensitivities.
/// Where scripts run, also a table that sorts, filters and selects, with a chart of any column against any other. Of
/// many cases the table has those with the extreme values of every measure, the failed ones and a sample, at most
/// `most_cases_shown` in all; figures are of all cases. goes_on: the batch is still running, and the page is of the
/// cases that have ended.
std::string batch_page(const study::CaseTable& results, const std::string& title,
                       const std::vector<study::MeasureSensitivity>& sensitivities, bool goes_on = false);

inline constexpr std::size_t most_cases_shown = 2000;

}  // namespace bough::report
