#pragma once
/// Pages of studies: work and precision, convergence, what to choose.
#include <string>
#include <vector>

#include "bough/study/sweep.hpp"

namespace bough::report {

/// One study. Its numbers name their places in study.json, which lies beside it.
std::string study_html(const study::SweepResult& result);

/// A line of the index of several studies.
struct StudyEntry {
  std::string name, title;  ///< the page is <name>/study.html
  std::size_t num_runs = 0, num_failed = 0, num_orders_held = 0, num_orders_failed = 0;
  std::string trouble;  ///< of its references
};
StudyEntry entry_of(const study::SweepResult& result);
std::string study_index_html(const std::vector<StudyEntry>& entries);

}  // namespace bough::report
