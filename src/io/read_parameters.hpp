#pragma once
#include <functional>

#include "bough/io/json_value.hpp"
#include "named_numbers.hpp"

namespace bough::io {

/// Called for each fault at a value; at_key: the fault is at the key of the member.
using TellFault = std::function<void(const JsonValue& at, const std::string& pointer, std::string rule,
                                     std::string hint, bool at_key)>;

/// Evaluates the member `parameters` of a scene in the order in which they depend on each other. A parameter that is at
/// fault, or depends on one that is, becomes defective.
void read_parameters(const JsonValue& parameters, NamedNumbers& names, const TellFault& tell);

}  // namespace bough::io
