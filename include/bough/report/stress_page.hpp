#pragma once
/// stress.html: the table of stiff and extreme cases as a page.
#include <string>
#include <vector>

#include "bough/stress/stress.hpp"

namespace bough::report {

/// A self-contained page: what fails first, a table of all cases, and per case its promise, figures and work. Numbers
/// name their places in stress.json, which is to lie beside it.
std::string stress_page(const std::vector<stress::StressCase>& cases, const stress::StressOptions& options);

}  // namespace bough::report
