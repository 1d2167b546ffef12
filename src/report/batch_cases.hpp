#pragma once
/// The cases of a batch as the table and the data of its page.
#include <string>
#include <vector>

#include "bough/report/document.hpp"
#include "bough/study/batch.hpp"

namespace bough::report {

/// The values of one measure over all cases that have one.
struct Measured {
  std::string name;
  std::vector<double> values;
  std::vector<std::size_t> cases;  ///< ascending values
  std::string unit = {};           ///< empty: a pure number, or not known
  /// "tip.x [m]"
  std::string title() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

/// The cases that the page shows: names of columns, and of each case its cells.
struct Cases {
  std::vector<std::string> inputs, columns;
  std::vector<std::size_t> shown;
};

Cases cases_of(const std::vector<study::CaseResult>& results, const std::vector<Measured>& measured);

inline bool is_good(const study::CaseResult& r) { return r.status == study::CaseStatus::ok; }

Table case_table(const Cases& cases, const std::vector<study::CaseResult>& results,
                 const std::vector<Measured>& measured);

/// What the script of the page reads (batch_script.hpp), with the rows and columns of the table.
std::string cases_json(const Cases& cases, const std::vector<study::CaseResult>& results,
                       const std::vector<Measured>& measured);

}  // namespace bough::report
