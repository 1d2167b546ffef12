// The page of a batch: what it counts, what it shows of many cases, and that no text of a scene becomes part of it.
#include "bough/report/batch_page.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "batch_cases.hpp"

namespace bough::report {
namespace {

using study::CaseResult;
using study::CaseStatus;

CaseResult result_of(std::size_t number, double value) {
  CaseResult r;
  r.which.name = std::to_string(number);
  r.which.inputs = {{"k", std::to_string(value)}};
  r.status = CaseStatus::ok;
  r.report.measures = {{"tip", value * value}};
  return r;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

TEST(BatchPage, no_text_of_a_scene_ends_a_script_or_opens_an_element) {
  const std::string evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&";
  std::vector<CaseResult> results = {result_of(1, 2.0), result_of(2, 3.0)};
  results[0].which.name = results[0].cause = evil;
  results[0].status = CaseStatus::failed;
  results[0].which.inputs = {{evil, "\"" + evil + "\""}};
  results[1].report.measures[0].name = evil;
  results[1].report.doubts = {evil};
  study::MeasureSensitivity s{evil, {evil}, {"morris", {"mu"}, {{{1.0, {}, {}}}}, 4, {}, {}}};
  const std::string page = batch_page(results, evil, {s});
  EXPECT_EQ(count_of(page, "<script"), 2u);
  EXPECT_EQ(count_of(page, "</script"), 2u);
  EXPECT_EQ(count_of(page, "<img"), 0u);
  EXPECT_GT(count_of(page, "&lt;img"), 3u);
}

TEST(BatchPage, cases_that_are_doubted_are_no_plain_ok) {
  std::vector<CaseResult> results;
  for (std::size_t k = 1; k <= 9; ++k) results.push_back(result_of(k, static_cast<double>(k)));
  for (const std::size_t k : {1, 4}) results[k].report.doubts = {"error"};
  const std::string page = batch_page(results, "t", {});
  EXPECT_NE(page.find("9 cases, 9 ok, 2 of them not to be trusted without a closer look."), std::string::npos);
  EXPECT_NE(page.find("ok, not to be trusted as it is"), std::string::npos);
}

TEST(BatchPage, failures_are_grouped_by_cause_whatever_numbers_it_holds) {
  std::vector<CaseResult> results;
  for (std::size_t k = 1; k <= 9; ++k) {
    results.push_back(result_of(k, static_cast<double>(k)));
    if (k % 3 != 0) continue;
    results.back().status = CaseStatus::failed;
    results.back().cause = "the step at time 0." + std::to_string(k) + " fails";
  }
  const std::string page = batch_page(results, "t", {});
  EXPECT_EQ(count_of(page, ">failed</td>"), 2u + 3u);  // a status, one cause, and the cases
  EXPECT_NE(page.find("3, 6, 9"), std::string::npos);
  EXPECT_NE(page.find("9 cases, 6 ok."), std::string::npos);
  std::vector<study::BatchCase> cases(20);
  for (std::size_t k = 0; k < results.size(); ++k) cases[2 * k] = results[k].which;
  study::CaseTable some{study::CaseList(cases)};
  for (std::size_t k = 0; k < results.size(); ++k) some.set(2 * k, results[k]);
  const std::string live = batch_page(some, "t", {}, true), stopped = batch_page(some, "t", {});
  EXPECT_NE(live.find("11 of 20 are left"), std::string::npos);
  EXPECT_EQ(count_of(live, "interrupted"), 0u);
  EXPECT_NE(live.find("3, 6, 9"), std::string::npos);
  EXPECT_NE(stopped.find("20 cases, 6 ok."), std::string::npos);
  EXPECT_GT(count_of(stopped, "not started"), 10u);
}

TEST(BatchPage, of_many_cases_extremes_failures_and_a_sample_are_shown) {
  std::vector<CaseResult> results;
  for (std::size_t k = 0; k < 30'000; ++k)
    results.push_back(result_of(k, 1.0 + static_cast<double>((k * 7919) % 30'011)));
  results[12'345].status = CaseStatus::crashed;
  const study::CaseTable table = results;
  const std::vector<std::uint32_t> ended = ended_cases(table, false);
  const std::vector<std::size_t> shown = cases_shown(table, ended, measured_in(table), most_cases_shown);
  EXPECT_LE(shown.size(), 2000u);
  EXPECT_GT(shown.size(), 1500u);
  EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end()));
  const auto is_shown = [&](std::size_t k) { return std::binary_search(shown.begin(), shown.end(), k); };
  EXPECT_TRUE(is_shown(12'345));
  const auto value = [](const CaseResult& r) { return *r.report.measures[0].value; };
  const auto less = [&](const CaseResult& a, const CaseResult& b) { return value(a) < value(b); };
  EXPECT_TRUE(
      is_shown(static_cast<std::size_t>(std::min_element(results.begin(), results.end(), less) - results.begin())));
  EXPECT_TRUE(
      is_shown(static_cast<std::size_t>(std::max_element(results.begin(), results.end(), less) - results.begin())));
  EXPECT_LT(batch_page(results, "t", {}).size(),
            1'500'000u);  // twice 2000 rows: as a table and as numbers
}

TEST(BatchPage, an_empty_batch_is_a_page) {
  const study::CaseTable none(study::CaseList(std::vector<study::BatchCase>(5)));
  EXPECT_NE(batch_page(none, "t", {}, true).find("5 of 5 are left"), std::string::npos);
  EXPECT_NE(batch_page({}, "t", {}).find("0 cases"), std::string::npos);
}

}  // namespace
TEST(BatchPage, tells_units_and_with_what_probability_something_happens) {
  std::vector<CaseResult> results;
  for (int k = 0; k < 10; ++k) {
    results.push_back(result_of(static_cast<std::size_t>(k), 0.1 * k));
    results.back().report.measures = {{"tip", 0.1 * k}, {"too near", k < 2 ? 1.0 : 0.0}, {"cycles", 1.0}};
    results.back().report.units = {"m", "", ""};
    results.back().report.indicators = {1};
  }
  const std::string page = batch_page(results, "t", {});
  EXPECT_GE(count_of(page, "tip [m]"), 4u);  // of the statistics, a histogram, the table of cases and the chart
  // Wilson's interval of 2 of 10: (0.2 + 1.921/10 -+ 1.96 sqrt(0.016 + 0.00960)) / 1.384
  EXPECT_NE(page.find("too near: in 2 of 10 cases, 20 %."), std::string::npos);
  EXPECT_NE(page.find("between 5.67 and 51 %"), std::string::npos);
  EXPECT_EQ(page.find("tip: in"), std::string::npos);
  EXPECT_EQ(page.find("cycles: in"), std::string::npos) << "a number that happens to be 1 in all cases";
}

}  // namespace bough::report
