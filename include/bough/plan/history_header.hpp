#pragma once
/// The columns of a scene's history: one for each component of each sensor.
#include "bough/plan/plan.hpp"
#include "bough/records/run.hpp"

namespace bough::plan {

/// Names, units and subjects of the columns, in the order of Plan::sensors.
records::HistoryHeader make_header(const Plan& plan);

}  // namespace bough::plan
