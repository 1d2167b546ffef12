#pragma once
/// stress.html: the table of stiff and extreme cases as a page.
#include <string>
#include <vector>

#include "bough/study/stress.hpp"

namespace bough::report {

/// A self-contained page: what fails first, a table of all cases, and per case its promise, figures and work. Numbers name their places
/// in stress.json, which is to lie beside it.
std::string stress_page(const std::vector<study::StressCase>& cases, const study::StressOptions& options);

}  // namespace bough::report
