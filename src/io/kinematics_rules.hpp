#pragma once
#include "bough/io/schema_rule.hpp"

namespace bough::io {

/// The table of chains of moving frames.
const RuleTable& frame_rules();
/// The table of single motions.
const RuleTable& motion_rules();

}  // namespace bough::io
