#pragma once
/// The profile of a tree as one self-contained page without scripts.
#include <string>

#include "bough/records/profile.hpp"

namespace bough::report {

/// Icicle of the hierarchy coloured by time, size or condition; the scene coloured by sub-domains, level by level;
/// timeline of tasks; tables of levels and of the sub-domains that cost most; speed-up; memory; other trees. `data`:
/// name of the JSON file beside the page.
std::string profile_page(const records::Profile& profile, const std::string& data);

/// The drawings alone, each as HTML with its own choice of colours (radio buttons and styles, no scripts).
std::string icicle_html(const records::Profile& profile);
std::string subdomains_html(const records::Profile& profile);
/// One <svg>: a few steps, one row a thread.
std::string timeline_svg(const records::Profile& profile);

}  // namespace bough::report
