#pragma once
/// Constraint rows that depend on others and that the plan of a run has left out.
#include <optional>
#include <string>

#include "bough/scene/scene.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

struct RowsInSpace {
  int dependent = 0;   ///< constraint rows that depend on others, of all joints as the scene describes them
  std::string groups;  ///< the joints whose reactions are not unique for that (dependent_groups_text)
};

/// A plan for motions in a plane, along a line or without rotations omits rows that these motions cannot violate, and
/// rigid parts that were welded have no rows at all. Whether reactions are unique is a property of the scene: where rows
/// were omitted and joints form loops, the state is examined once with all rows, by a plan without these decisions.
/// Nothing where no row can be hidden. Allocates; costs a plan and one factorization.
std::optional<RowsInSpace> find_rows_in_space(const scene::Scene& scene, const step::System& system,
                                              const step::State& state);

}  // namespace bough::run
