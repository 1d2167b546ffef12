#pragma once
/// The serial walk: the reference for all other walks, and their fallback.
#include "bough/tree/walker.hpp"

namespace bough::schedule {

/// Postorder on the way up, reverse postorder on the way down, chunks in order, all in the calling thread. Does not
/// allocate and cannot fail.
tree::Walker make_serial_walker();

}  // namespace bough::schedule
