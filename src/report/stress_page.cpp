#include "bough/report/stress_page.hpp"

#include <algorithm>
#include <limits>

#include "bough/io/number_text.hpp"
#include "bough/report/document.hpp"
#include "bough/version.hpp"

namespace bough::report {
namespace {

using stress::StressCase;
using stress::StressFigure;
using stress::StressStatus;

Tone tone_of(const StressCase& c) {
  if (c.status == StressStatus::fails) return Tone::bad;
  return c.is_as_expected() ? Tone::good : Tone::bad;
}

std::string pointer(std::size_t k, const std::string& key) { return "/cases/" + std::to_string(k) + "/" + key; }

Cell status_cell(const StressCase& c) { return {stress::text_of(c.status), tone_of(c)}; }

Cell count_cell(long count, std::size_t k, const char* key) {
  return number_cell(static_cast<double>(count), 9, pointer(k, key));
}

Table overview(const std::vector<StressCase>& cases) {
  Table table;
  table.head = {"case",         "status",      "largest error", "digits lost", "condition", "backward error",
                "LAPACK ratio", "constraints", "steps",         "iterations",  "seconds"};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const StressCase& c = cases[k];
    const auto number = [k](double value, const char* key, int digits = 2) {
      return value == 0.0 ? Cell{"-", Tone::soft, true} : number_cell(value, digits, pointer(k, key));
    };
    table.rows.push_back({{c.name + (c.is_shortened ? " *" : ""), Tone::plain, false, {}, "#" + c.name},
                          status_cell(c),
                          number(c.largest_error, "largest_error"),
                          number(c.digits_lost, "digits_lost"),
                          number(c.condition, "condition"),
                          number(c.backward_error, "backward_error"),
                          number(c.lapack_ratio, "lapack_ratio"),
                          number(c.constraint_violation, "constraint_violation"),
                          count_cell(c.steps, k, "steps"),
                          count_cell(c.iterations, k, "iterations"),
                          number(c.seconds, "seconds", 3)});
  }
  return table;
}

Table figures(const StressCase& c, std::size_t k) {
  Table table;
  table.head = {"figure", "measured", "at most", ""};
  for (std::size_t f = 0; f < c.figures.size(); ++f) {
    const StressFigure& figure = c.figures[f];
    const std::string at = pointer(k, "figures/" + std::to_string(f));
    const bool is_promised = figure.limit < std::numeric_limits<double>::infinity();
    table.rows.push_back({{figure.name},
                          number_cell(figure.value, 4, at + "/value"),
                          is_promised ? number_cell(figure.limit, 3, at + "/limit") : Cell{"-", Tone::soft, true},
                          !is_promised     ? Cell{"told", Tone::soft}
                          : figure.holds() ? Cell{"holds", Tone::good}
                                           : Cell{"fails", Tone::bad}});
  }
  return table;
}

/// Describes what is not as promised: the figures beyond their limits, or why the case ended early.
std::string failure_text(const StressCase& c) {
  std::string text;
  for (const StressFigure& f : c.figures)
    if (!f.holds())
      text += (text.empty() ? "" : "; ") + f.name + ": " + io::rounded_text(f.value, 3) + " instead of at most " +
              io::rounded_text(f.limit, 3);
  if (text.empty()) text = c.measured.substr(0, c.measured.find("; "));
  return c.name + ": " + text + (c.reason.empty() ? ". Not listed as failing." : ". Listed as failing: " + c.reason);
}

}  // namespace

std::string stress_page(const std::vector<StressCase>& cases, const stress::StressOptions& options) {
  const auto count = [&](StressStatus status) {
    return std::to_string(
        std::count_if(cases.begin(), cases.end(), [status](const StressCase& c) { return c.status == status; }));
  };
  Document page("Stiff and extreme cases",
                count(StressStatus::holds) + " cases hold what is promised, " + count(StressStatus::fails) + " fail, " +
                    count(StressStatus::refused) + " are refused by name, as they have to be." +
                    (options.quick ? " Long runs are shortened, those with a star." : ""),
                "stress.json");
  std::vector<std::string> failing;
  for (const StressCase& c : cases)
    if (c.status == StressStatus::fails)
      failing.push_back(failure_text(c));
    else if (!c.is_as_expected())
      failing.push_back(c.name + " is listed as " + stress::text_of(c.expected) + " and " + stress::text_of(c.status));
  page.section("What fails");
  if (failing.empty())
    page.paragraph("Nothing.", Tone::good);
  else
    page.list(failing);
  page.section("All cases");
  page.paragraph(
      "Condition: estimate for a tangent in scaled variables. LAPACK ratio: residual over norm, unknowns and unit "
      "round-off, largest of all linear solutions, at most 30. Constraints in m or rad. Seconds of CPU. Digits lost: "
      "where round-off alone makes the error, those of the result; else what the condition allows. A dash: not "
      "measured, or zero. A star: shortened.");
  page.table(overview(cases));
  std::string family;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const StressCase& c = cases[k];
    page.section(c.family + ": " + c.name, c.name);
    page.paragraph("Promise: " + c.promise + ".");
    page.paragraph(std::string(stress::text_of(c.status)) + (c.is_shortened ? ", shortened" : "") +
                       (c.refusal.empty() ? "" : ". The refusal: " + c.refusal),
                   tone_of(c));
    if (c.status == StressStatus::fails) page.paragraph(failure_text(c), Tone::bad);
    const Table table = figures(c, k);
    if (c.status == StressStatus::fails)
      page.table(table);
    else
      page.folded(std::to_string(table.rows.size()) + (table.rows.size() == 1 ? " figure" : " figures"), table, false);
  }
  page.section("How this was made");
  page.paragraph(
      "bough " + std::string(version) + ", bough stress" + (options.quick ? " --quick" : "") +
      ", cases side by side on " + std::to_string(options.threads) +
      " threads, each on one. References are closed forms, boundary value problems by shooting, equations of motion "
      "in minimal coordinates, extended precision, or tables of data/reference.");
  return page.html();
}

}  // namespace bough::report
