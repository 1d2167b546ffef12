#pragma once
/// The last cache of the machine. Internal to solve.
#include <cstddef>

namespace bough::solve {

/// Whether so many bytes do not stay in what a run may hope for of the last cache beside others: an eighth of it, but
/// 16 MB at least.
bool exceeds_share_of_caches(std::size_t bytes);

}  // namespace bough::solve
