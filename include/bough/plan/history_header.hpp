#pragma once
/// What the history of a scene shows: a column for each component of each sensor.
#include "bough/plan/plan.hpp"
#include "bough/records/run.hpp"

namespace bough::plan {

/// Names, units and subjects of the columns, in the order of Plan::sensors.
records::HistoryHeader make_header(const Plan& plan);

}  // namespace bough::plan
