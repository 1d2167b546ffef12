#pragma once
#include "bough/records/errors.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

/// Lets the verdict on a run rest on the errors that its twins have measured: a doubt of the estimate in time is dropped
/// where twins know the error in time of all columns that are doubted, or doubt it themselves; measured errors above the bound of TrustLimits
/// are doubted, and differences of twins above it that are not resolved; what could not be measured is added to what is
/// not judged.
void judge_errors(const records::MeasuredErrors& errors, const scene::ErrorsWanted& wanted, records::Summary& summary);

}  // namespace bough::run
