#pragma once
/// The kinds of the catalogue as plain data, for layers that do not see the kernels.
#include <span>
#include <string_view>

#include "bough/scene/coupling_kind.hpp"

namespace bough::elements {

/// In the order of the catalogue.
std::span<const scene::CouplingKind* const> coupling_kinds();

/// The kind of a scene's list of this name; throws std::invalid_argument if there is none.
const scene::CouplingKind& coupling_kind(std::string_view list);

}  // namespace bough::elements
