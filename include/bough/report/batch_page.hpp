#pragma once
/// batch.html: the cases of a batch or sweep as a page.
#include <string>
#include <vector>

#include "bough/study/batch.hpp"

namespace bough::report {

/// A self-contained page: what came of the cases and why some failed, what was measured over all of them,
/// sensitivities, and, where scripts run, a table that sorts, filters and selects with a chart of any column against
/// any. Of many cases the table holds the extreme ones of every measure, those that failed and a sample, at most 2000
/// in all; figures are of all. is_live: the batch goes on.
std::string batch_page(const std::vector<study::CaseResult>& results, const std::string& title,
                       const std::vector<study::MeasureSensitivity>& sensitivities, std::size_t num_cases);

/// The cases of the table, ascending: all up to `most`, else as above.
std::vector<std::size_t> cases_shown(const std::vector<study::CaseResult>& results, std::size_t most = 2000);

}  // namespace bough::report
