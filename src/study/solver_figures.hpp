#pragma once
#include "bough/results/records.hpp"
#include "bough/step/system.hpp"

namespace bough::study {

/// Figures of the tree and the linear solver for the summary of a run; conditions of interfaces where these are narrow.
decltype(results::Summary::solver) solver_figures(step::System& system, int dependent_rows);

}  // namespace bough::study
