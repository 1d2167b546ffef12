#pragma once
/// batch.html: the cases of a batch or sweep as a page.
#include <string>
#include <vector>

#include "bough/study/batch.hpp"

namespace bough::report {

/// A self-contained page: outcomes of the cases and causes of failures, measures over all cases, and sensitivities.
/// Where scripts run, also a table that sorts, filters and selects, with a chart of any column against any other. Of
/// many cases the table has those with the extreme values of every measure, the failed ones and a sample, at most 2000
/// in all; figures are of all cases. is_live: the batch is still running.
std::string batch_page(const std::vector<study::CaseResult>& results, const std::string& title,
                       const std::vector<study::MeasureSensitivity>& sensitivities, std::size_t num_cases);

/// The cases of the table, ascending: all if there are at most `most`, otherwise the selection described above.
std::vector<std::size_t> cases_shown(const std::vector<study::CaseResult>& results, std::size_t most = 2000);

}  // namespace bough::report
