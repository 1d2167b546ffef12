/// The table of stiff and extreme cases, shortened: each case ends as it is listed, and the report says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "bough/io/json_value.hpp"
#include "bough/stress/stress.hpp"

namespace bough::stress {
namespace {

TEST(VerifyStress, every_case_of_the_quick_table_ends_as_it_is_listed_and_is_reported) {
  const StressOptions options{.quick = true, .threads = 2};
  const std::vector<StressCase> cases = run_stress(options, [](const StressCase& c, std::size_t, std::size_t) {
    std::printf("  %-28s %-8s %6.2f s  %s\n", c.name.c_str(), text_of(c.status), c.seconds, c.measured.c_str());
  });
  const std::vector<std::string> names = stress_names();
  std::set<std::string> families;
  double ratio = 0.0;
  for (const StressCase& c : cases) {
    EXPECT_EQ(c.status, c.expected) << c.name << ": " << c.measured;
    EXPECT_FALSE(c.promise.empty()) << c.name;
    EXPECT_EQ(c.expected == StressStatus::fails, !c.reason.empty()) << c.name;
    EXPECT_LT(c.lapack_ratio, lapack_ratio_limit) << c.name;
    families.insert(c.family);
    ratio = std::max(ratio, c.lapack_ratio);
  }
  std::printf("  LAPACK ratio at most %.3g\n", ratio);
  EXPECT_EQ(cases.size() + families.size(), names.size());

  std::vector<io::JsonFault> faults;
  const std::optional<io::JsonValue> json =
      io::parse_json(stress_json(cases, options, "test"), io::source_file, faults);
  ASSERT_TRUE(json && faults.empty());
  const io::JsonValue* list = json->find("cases");
  ASSERT_NE(list, nullptr);
  ASSERT_EQ(list->items.size(), cases.size());
  for (std::size_t k = 0; k < cases.size(); ++k) {
    EXPECT_EQ(list->items[k].find("name")->text, cases[k].name);
    EXPECT_EQ(list->items[k].find("status")->text, text_of(cases[k].status));
    for (const char* key : {"promise", "measured"})
      EXPECT_FALSE(list->items[k].find(key)->text.empty()) << cases[k].name;
    EXPECT_GT(list->items[k].find("seconds")->number, 0.0) << cases[k].name;
  }
}

}  // namespace
}  // namespace bough::stress
