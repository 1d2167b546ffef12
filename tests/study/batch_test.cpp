#include "bough/study/batch.hpp"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <map>
#include <thread>

#include "bough/io/atomic_file.hpp"
#include "bough/io/run_directory.hpp"
#include "io/write_samples.hpp"

namespace bough::study {
namespace {

/// A folder of cases named by what becomes of them.
class Batch : public testing::Test {
 protected:
  Batch() { std::filesystem::create_directory(scratch_ / "in"); }
  void add(const std::string& name) { io::write_file(scratch_ / "in" / (name + ".json"), "{}"); }
  BatchOptions options(int threads, double time_limit = 0.0) const {
    return {scratch_ / "in", scratch_ / "out", threads, time_limit};
  }

  static int run_case(const BatchCase& which, std::string& cause) {
    if (which.name.starts_with("bad")) {
      cause = "line 1: no bodies\nline 2: no joints";
      return 2;
    }
    if (which.name.starts_with("throws")) throw std::runtime_error("could not, so did not");
    if (which.name.starts_with("crashes")) std::raise(SIGKILL);
    if (which.name.starts_with("hangs")) std::this_thread::sleep_for(std::chrono::seconds(60));
    if (which.name.starts_with("talks")) cause = std::string(100'000, 'x');
    io::RunDirectory run(which.directory, "1");
    results::Summary summary = io::sample_summary();
    run.begin(summary.header);
    run.row({0.0, 0.0, 0, {1.0, 2.0, 3.0}});
    if (which.name.starts_with("fails")) {
      summary.status = results::RunStatus::failed;
      summary.cause = "no equilibrium";
    }
    run.end(summary);
    return which.name.starts_with("fails") ? 1 : 0;
  }

  std::vector<CaseResult> run(const BatchOptions& o) {
    std::filesystem::create_directories(o.out);
    return run_batch(
        o, run_case, [](const CaseResult&, std::size_t, std::size_t) {}, [] { return false; });
  }

  io::ScratchDirectory scratch_;
};

TEST_F(Batch, every_kind_of_failure_is_told_and_harms_no_other) {
  for (const char* name : {"good_1", "bad", "throws", "crashes", "fails", "talks", "good_2"}) add(name);
  std::map<std::string, CaseResult> by_name;
  for (const CaseResult& result : run(options(2))) by_name[result.which.name] = result;
  ASSERT_EQ(by_name.size(), 7u);
  EXPECT_EQ(by_name["bad"].status, CaseStatus::bad_input);
  EXPECT_EQ(by_name["bad"].cause, "line 1: no bodies; line 2: no joints");
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "out/bad"));
  EXPECT_EQ(by_name["throws"].status, CaseStatus::failed);
  EXPECT_EQ(by_name["throws"].cause, "could not, so did not");
  EXPECT_EQ(by_name["crashes"].status, CaseStatus::crashed);
  EXPECT_EQ(by_name["fails"].status, CaseStatus::failed);
  EXPECT_EQ(by_name["fails"].cause, "no equilibrium");
  EXPECT_EQ(by_name["talks"].status, CaseStatus::ok);
  for (const char* name : {"good_1", "good_2"}) {
    EXPECT_EQ(by_name[name].status, CaseStatus::ok);
    EXPECT_EQ(by_name[name].accepted, 10);
    EXPECT_EQ(by_name[name].expected_holds, 1);
    EXPECT_EQ(by_name[name].expected_fails, 1);
    EXPECT_TRUE(std::filesystem::exists(scratch_ / "out" / name / "summary.json"));
  }
}

TEST_F(Batch, the_table_is_the_same_for_any_number_of_threads) {
  for (const char* name : {"c", "a", "fails", "b", "bad"}) add(name);
  const std::string table = batch_csv(run(options(1)));
  EXPECT_EQ(table, batch_csv(run(options(3))));
  EXPECT_EQ(table.substr(0, table.find('\n')),
            "case,status,cause,steps_accepted,steps_rejected,newton_iterations,expected_holds,expected_fails");
  EXPECT_LT(table.find("\na,ok"), table.find("\nb,ok"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 6);
}

TEST_F(Batch, a_case_that_hangs_is_stopped_at_the_limit) {
  add("good");
  add("hangs");
  const auto results = run(options(2, 0.3));
  EXPECT_EQ(results.at(0).status, CaseStatus::ok);
  EXPECT_EQ(results.at(1).status, CaseStatus::timed_out);
}

TEST_F(Batch, stopping_ends_what_runs_and_starts_nothing_more) {
  for (const char* name : {"hangs_1", "hangs_2", "later"}) add(name);
  std::filesystem::create_directories(scratch_ / "out");
  int asked = 0;
  const auto results = run_batch(
      options(2), run_case, [](const CaseResult&, std::size_t, std::size_t) {}, [&] { return ++asked > 3; });
  EXPECT_EQ(results.at(0).status, CaseStatus::crashed) << "these children do not catch SIGINT";
  EXPECT_EQ(results.at(2).status, CaseStatus::interrupted);
  EXPECT_EQ(results.at(2).cause, "not started");
}

TEST_F(Batch, a_folder_without_scenes_is_refused) {
  EXPECT_THROW((void)cases_in(options(1)), std::runtime_error);
  EXPECT_THROW((void)cases_in({scratch_ / "none", scratch_ / "out"}), std::runtime_error);
}

}  // namespace
}  // namespace bough::study
