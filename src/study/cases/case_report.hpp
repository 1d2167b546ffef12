#pragma once
#include <string>
#include <string_view>

#include "bough/study/batch.hpp"

namespace bough::study {

/// The report of a case as text for a pipe or a file; numbers keep their bits.
std::string text_of(const CaseReport& report);
/// False if the text is incomplete.
bool report_of(std::string_view text, CaseReport& report);

}  // namespace bough::study
