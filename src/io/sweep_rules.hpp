#pragma once
#include "bough/io/schema_rule.hpp"

namespace bough::io {

/// The table of sweep files.
const RuleTable& sweep_rules();

}  // namespace bough::io
