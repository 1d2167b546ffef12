#pragma once
/// The serial walk: oracle and fallback of every other one.
#include "bough/tree/walker.hpp"

namespace bough::schedule {

/// Postorder up, reverse postorder down, chunks in order; all in the calling thread. No allocation, no failure.
tree::Walker make_serial_walker();

}  // namespace bough::schedule
