#pragma once
/// How many elements of each kind are evaluated in lockstep, and how many alone. Internal to step.
#include <vector>

#include "bough/plan/plan.hpp"

namespace bough::step {

/// Of elements that differ only in the values of their data.
struct EvaluationWork {
  std::size_t first = 0;  ///< one of them
  int elements = 0;
  int packs = 0, alone = 0;  ///< evaluations of eight in lockstep, and of single elements
};

/// Of all elements that have unknowns. They are counted as LaneBatches puts them together where all are visited
/// together: the result does not depend on the number of threads.
std::vector<EvaluationWork> count_evaluations(const plan::Plan& plan);

}  // namespace bough::step
