/// Independent tasks beside each other.
#include "bough/schedule/side_by_side.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace bough::schedule {
namespace {

TEST(SideBySide, every_task_runs_once_for_any_number_of_threads) {
  for (const int threads : {1, 2, 5, 40}) {
    std::vector<std::atomic<int>> runs(17);
    std::vector<std::function<void()>> tasks;
    for (std::atomic<int>& count : runs) tasks.emplace_back([&count] { ++count; });
    run_side_by_side(threads, tasks);
    for (const std::atomic<int>& count : runs) EXPECT_EQ(count, 1);
  }
  run_side_by_side(4, {});
}

TEST(SideBySide, on_one_thread_they_follow_each_other_in_their_order) {
  std::vector<int> order;
  std::vector<std::function<void()>> tasks;
  for (int k = 0; k < 5; ++k) tasks.emplace_back([&order, k] { order.push_back(k); });
  run_side_by_side(1, tasks);
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(SideBySide, the_exception_of_the_first_task_in_order_is_passed_on_after_all_have_ended) {
  for (const int threads : {1, 3}) {
    std::atomic<int> ended{0};
    const auto failing = [&ended](const char* what) {
      return [&ended, what] {
        ++ended;
        throw std::runtime_error(what);
      };
    };
    try {
      run_side_by_side(threads, {[&ended] { ++ended; }, failing("second"), failing("third"), [&ended] { ++ended; }});
      ADD_FAILURE() << "no exception";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "second");
    }
    EXPECT_EQ(ended, 4);
  }
}

}  // namespace
}  // namespace bough::schedule
