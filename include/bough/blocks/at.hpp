#pragma once
/// Signed numbers of nodes, blocks and unknowns as indices of containers.
#include <cstddef>
#include <cstdint>

namespace bough {

constexpr std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

}  // namespace bough
