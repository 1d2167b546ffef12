#pragma once
#include "bough/io/json_value.hpp"
#include "bough/scene/analysis_kinds.hpp"

namespace bough::io {

/// Reads what the kind of an analysis is asked, from a value that its rules have found without fault; all but the frame
/// in which the scene is described.
void read_analysis(const JsonValue& value, scene::Analysis& analysis);

}  // namespace bough::io
