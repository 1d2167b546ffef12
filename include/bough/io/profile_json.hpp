#pragma once
/// Files of a profile: `profile.json` with everything, `trace.json` in Chrome's trace event format (opens in Perfetto
/// and chrome://tracing).
#include <string>
#include <string_view>

#include "bough/records/profile.hpp"

namespace bough::io {

/// Everything but drawing and events. Times in seconds, sizes in bytes; what is not known is the string "nan".
std::string profile_text(const records::Profile& profile, std::string_view version);

/// Complete events ("ph": "X"), times in microseconds, one thread of the trace for each thread of the run and one for
/// the steps. As many events as Profile::events holds (which is capped); what was left out is counted in the
/// metadata.
std::string trace_text(const records::Profile& profile);

}  // namespace bough::io
