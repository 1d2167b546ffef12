#pragma once
/// The kinds of the catalogue as plain data, for layers that do not see the kernels.
#include <span>

#include "bough/scene/coupling_kind.hpp"

namespace bough::elements {

/// In the order of the catalogue.
std::span<const scene::CouplingKind* const> coupling_kinds();

}  // namespace bough::elements
