#pragma once
/// The cases of a batch as the table and the data of its page.
#include <cstdint>
#include <string>
#include <vector>

#include "bough/report/document.hpp"
#include "bough/study/batch.hpp"

namespace bough::report {

/// The values of one measure over all cases that have one.
struct Measured {
  std::string name;
  std::vector<double> values;        ///< ascending
  std::vector<std::uint32_t> cases;  ///< of these values
  std::string unit = {};             ///< empty: a pure number, or not known
  bool is_indicator = false;         ///< 1 where something happens and 0 elsewhere, by what it is
  /// "tip.x [m]"
  std::string title() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

/// The cases that the page shows.
struct Cases {
  std::vector<std::string> inputs;
  std::vector<std::string> columns, headings;  ///< names, as conditions of the filter use them; with units
  std::vector<study::CaseResult> shown;
};

/// All measures, in the order of their columns.
std::vector<Measured> measured_in(const study::CaseTable& results);

/// By index; of a batch that goes on those that have ended.
std::vector<std::uint32_t> ended_cases(const study::CaseTable& results, bool goes_on);

/// Of the cases with these indices those that the page shows, ascending.
std::vector<std::size_t> cases_shown(const study::CaseTable& results, const std::vector<std::uint32_t>& ended,
                                     const std::vector<Measured>& measured, std::size_t most);

Cases cases_of(const study::CaseTable& results, const std::vector<std::uint32_t>& ended,
               const std::vector<Measured>& measured);

inline bool is_good(study::CaseStatus status) { return status == study::CaseStatus::ok; }

Table case_table(const Cases& cases, const std::vector<Measured>& measured);

/// What the script of the page reads (batch_script.hpp), with the rows and columns of the table.
std::string cases_json(const Cases& cases, const std::vector<Measured>& measured);

}  // namespace bough::report
