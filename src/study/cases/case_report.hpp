#pragma once
#include <string>
#include <string_view>

#include "bough/study/batch.hpp"

namespace bough::study {

/// What a case tells, as it goes through a pipe or into a file; numbers keep their bits.
std::string text_of(const CaseReport& report);
/// False where the text is not whole.
bool report_of(std::string_view text, CaseReport& report);

}  // namespace bough::study
