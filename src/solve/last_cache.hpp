#pragma once
/// The last cache of the machine. Internal to solve.
#include <cstddef>

namespace bough::solve {

/// Whether so many bytes exceed the part of the last cache that a run can count on beside other programs: an eighth of
/// it, but at least 16 MB.
bool exceeds_share_of_caches(std::size_t bytes);

}  // namespace bough::solve
