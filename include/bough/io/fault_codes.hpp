#pragma once
/// Codes of the rules that a file can break: one word for each, which stays the same when the wording of a message
/// changes. The manual has a section for each (data/manual/guides/messages.md), which `bough explain CODE` prints.
#include <span>
#include <string_view>

namespace bough::io {

struct FaultCode {
  std::string_view code;   ///< "unknown-name"
  std::string_view about;  ///< one sentence
};

/// All codes, in the order of the manual.
std::span<const FaultCode> fault_codes();

/// The code of a rule as it is told. pointer: of the value at fault; faults of formulas are told in the words of the
/// formula. "contradiction" where no other fits.
std::string_view code_of(std::string_view rule, std::string_view pointer = {});

}  // namespace bough::io
