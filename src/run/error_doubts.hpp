#pragma once
#include "bough/records/errors.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

/// Whether a run is right to a bound though its twins do not differ as errors of the theoretical order do at all times. Let
/// d be the difference between the finest two members, one of which is the run, and D that of the next two. If differences
/// shrink by the largest ratio r = D/d, the finest member has the error d / (r - 1), and the run d more if it is not the
/// finest. Twice d / (r - 1) is allowed for, and r no more than second order gives. Where d is small beside the bound
/// the order does not matter: of first order the error is d or 2 d, and of order 1/2 it is 2.4 d or 3.4 d.
bool agrees(const records::ErrorPart& part, double bound);

/// Lets the verdict on a run rest on the errors that its twins have measured: a doubt of the estimate in time is dropped
/// where twins know the error in time of all columns that are doubted, or doubt it themselves; measured errors above the bound of TrustLimits
/// are doubted, and differences of twins above it that are not resolved; what could not be measured is added to what is
/// not judged.
void judge_errors(const records::MeasuredErrors& errors, const scene::ErrorsWanted& wanted, records::Summary& summary);

/// Whether the estimate of the error in time doubts a run, in a doubt about `estimate_beside_twins`.
bool is_estimate_doubted(const records::Summary& summary);

/// Lets twins in time, run because the estimate doubts a run, decide on the columns that it doubts. Errors that they
/// know, or on which they agree, take the place of estimates: the doubt goes, or is one of the measured error. False:
/// they do not decide, and nothing is changed. runs: the twins, in words.
bool check_estimate(const records::MeasuredErrors& errors, const std::string& runs, records::Summary& summary);

/// The largest difference between a run and the twin next to it, over the range of a column that the estimate doubts.
double difference_from_twins(const records::MeasuredErrors& errors, const records::Summary& summary);

/// The doubt of the estimate, if there is one, is one about the error; `more` is added to its text.
void keep_estimates_doubt(records::Summary& summary, const std::string& more = {});

}  // namespace bough::run
