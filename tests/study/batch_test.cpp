#include "bough/study/batch.hpp"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <thread>

#include "bough/io/atomic_file.hpp"
#include "bough/io/history.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/records/errors.hpp"
#include "cases/case_report.hpp"
#include "io/write_samples.hpp"
#include "support/batch_texts.hpp"

namespace bough::study {
namespace {

using support::batch_csv;
using support::batch_json;

/// A folder of cases named by what becomes of them.
class Batch : public testing::Test {
 protected:
  Batch() { std::filesystem::create_directory(scratch_ / "in"); }
  void add(const std::string& name) { io::write_file(scratch_ / "in" / (name + ".json"), "{}"); }
  static BatchOptions options(int threads, double time_limit = 0.0) {
    BatchOptions o;
    o.threads = threads;
    o.time_limit = time_limit;
    return o;
  }
  CaseTable cases() const { return CaseTable(list()); }
  std::vector<BatchCase> list() const { return cases_in(scratch_ / "in", scratch_ / "out"); }

  static int run_case(const BatchCase& which, CaseReport& report, io::SharedText&) {
    if (which.name.starts_with("bad")) {
      report.cause = "line 1: no bodies\nline 2: no joints";
      return 2;
    }
    if (which.name.starts_with("throws")) throw std::runtime_error("could not, so did not");
    if (which.name.starts_with("crashes")) std::raise(SIGKILL);
    if (which.name.starts_with("hangs")) std::this_thread::sleep_for(std::chrono::seconds(60));
    if (which.name.starts_with("talks")) report.cause = std::string(100'000, 'x');
    io::RunDirectory run(which.directory, "1");
    records::Summary summary = io::sample_summary();
    if (!which.name.starts_with("figures"))
      for (records::ExpectedResult& figure : summary.expected) figure.holds = true;
    run.begin(summary.header);
    run.row({0.0, 0.0, 0, {1.0, 2.0, 3.0}});
    if (which.name.starts_with("late crash")) std::raise(SIGKILL);
    if (which.name.starts_with("stuck")) {
      std::signal(SIGTERM, SIG_IGN);
      std::this_thread::sleep_for(std::chrono::seconds(60));
    }
    if (which.name.starts_with("slow")) {
      static volatile std::sig_atomic_t stop = 0;
      std::signal(SIGTERM, [](int) { stop = 1; });
      while (stop == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      summary.status = records::RunStatus::interrupted;
      summary.cause = "stopped when told so";
    }
    if (which.name.starts_with("fails")) {
      summary.status = records::RunStatus::failed;
      summary.cause = "no equilibrium";
    }
    run.end(summary);
    report.take(summary, {});
    report.directory = run.directory();
    return summary.status == records::RunStatus::ok ? 0 : 1;
  }

  CaseTable run(const BatchOptions& o) {
    std::filesystem::create_directories(scratch_ / "out");
    return run_batch(
        cases(), o, run_case, [](const auto&...) {}, [] { return false; });
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
    EXPECT_EQ(by_name[name].report.accepted, 10);
    EXPECT_EQ(by_name[name].report.expected_holds, 2);
    EXPECT_EQ(by_name[name].report.expected_fails, 0);
    EXPECT_TRUE(std::filesystem::exists(scratch_ / "out" / name / "summary.json"));
  }
}

TEST_F(Batch, the_table_is_the_same_for_any_number_of_threads) {
  for (const char* name : {"c", "a", "fails", "b", "bad"}) add(name);
  const std::string table = batch_csv(run(options(1)));
  EXPECT_EQ(table, batch_csv(run(options(3))));
  EXPECT_EQ(table.substr(0, table.find('\n')),
            "case,status,cause,steps_accepted,steps_rejected,newton_iterations,expected_holds,expected_fails,doubts,"
            "energy_error,constraint_error");
  EXPECT_LT(table.find("\na,ok"), table.find("\nb,ok"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 6);
}

TEST_F(Batch, rows_do_not_depend_on_the_order_in_which_cases_are_started) {
  for (const char* name : {"c", "a", "fails", "b", "bad"}) add(name);
  BatchOptions turned = options(2);
  const std::string table = batch_csv(run(turned));
  for (const std::vector<std::size_t>& order : {std::vector<std::size_t>{4, 3, 2, 1, 0}, {2, 0, 4, 1, 3}}) {
    turned.order = order;
    EXPECT_EQ(batch_csv(run(turned)), table);
  }
}

TEST_F(Batch, rows_have_the_errors_of_measures_that_twins_know) {
  records::Summary summary;
  summary.measures = {{"top", 2.0}, {"low", 1.0}};
  records::MeasuredErrors errors;
  for (const auto& m : summary.measures) errors.measures.emplace_back().name = m.name;
  records::ErrorOf &top = errors.measures[0], &low = errors.measures[1];
  top.unit = "m";
  top.time.state = records::ErrorState::resolved;
  top.time.largest = 0.25;
  top.mesh.state = records::ErrorState::unexamined;
  top.mesh.largest = 0.5;
  low.time.state = records::ErrorState::not_resolved;
  low.time.largest = 0.1;
  summary.errors = std::make_shared<records::MeasuredErrors>(errors);
  CaseReport report;
  report.take(summary, {});
  ASSERT_EQ(report.measures.size(), 4U);
  EXPECT_EQ(report.measures[2].name, "top.error");
  EXPECT_EQ(report.measures[2].value, 0.75);
  EXPECT_EQ(report.units[2], "m");
  EXPECT_EQ(report.measures[3].name, "low.error");
  EXPECT_FALSE(report.measures[3].value) << "it is not resolved";
}

TEST_F(Batch, tables_hold_inputs_and_measures_and_no_formula_of_a_spreadsheet) {
  CaseResult one, two;
  one.which = {"=1+1", "a.json", "out", {}, {{"k", "-1.5"}, {"@word", "\"+cmd\""}}};
  one.status = two.status = CaseStatus::ok;
  one.report.measures = {{"top", 0.1}, {"none", {}}};
  two.which.name = "b";
  two.report.measures = {{"other", -2.0}, {"top", 1e300}};
  two.report.doubts = {"energy", "error"};
  two.report.energy_error = 0.25;
  const std::string table = batch_csv({one, two});
  EXPECT_EQ(table.substr(table.find(",doubts")),
            ",doubts,energy_error,constraint_error,k,'@word,top,none,other\n'=1+1,ok,,0,0,0,0,0,,,,-1.5,'+cmd,0.1,,\n"
            "b,ok,,0,0,0,0,0,energy; error,0.25,,,,1e+300,,-2\n");
  EXPECT_NE(batch_json({one, two}, "t").find("\"k\": -1.5"), std::string::npos);
}

TEST(CaseReports, go_through_a_pipe_with_all_their_bits) {
  CaseReport r;
  r.cause = "line 1\n\"quoted\" \xC3\xA9";
  r.directory = "out/a";
  r.stored = io::StoredPlace{"store_000.pack", 1234567890123};
  r.accepted = 1L << 40u;
  r.expected_fails = 3;
  r.doubts = {"energy", ""};
  r.constraint_error = 1e-17 / 3.0;
  r.measures = {{"a", 0.1 + 0.2}, {"b", {}}, {"c", -5e-324}};
  r.units = {"m", "", "rad/s"};
  r.indicators = {1};
  const std::string text = text_of(r);
  CaseReport back;
  ASSERT_TRUE(report_of(text, back));
  EXPECT_EQ(text_of(back), text);
  EXPECT_EQ(back.measures[2].value, -5e-324);
  EXPECT_EQ(back.units, r.units);
  EXPECT_EQ(back.indicators, r.indicators);
  for (std::size_t n = 0; n + 2 < text.size(); ++n) {
    CaseReport part;
    EXPECT_FALSE(report_of(text.substr(0, n), part)) << n;
  }
}

TEST_F(Batch, a_case_that_hangs_is_stopped_at_the_limit) {
  add("good");
  add("hangs");
  const auto results = run(options(2, 1.0));
  EXPECT_EQ(results.at(0).status, CaseStatus::ok);
  EXPECT_EQ(results.at(1).status, CaseStatus::timed_out);
}

TEST_F(Batch, a_case_whose_figures_fail_is_not_called_ok) {
  add("figures");
  const CaseResult result = run(options(1)).at(0);
  EXPECT_EQ(result.status, CaseStatus::figures_fail);
  EXPECT_EQ(result.cause, "tip.y is -0.1 instead of -0.2 +- 1e-09");
  EXPECT_NE(batch_csv({result}).find("figures,figures_fail,"), std::string::npos);
}

TEST_F(Batch, a_case_past_its_limit_that_stops_by_itself_keeps_its_results) {
  add("slow");
  const CaseResult result = run(options(1, 0.5)).at(0);
  EXPECT_EQ(result.status, CaseStatus::timed_out);
  EXPECT_EQ(result.cause, "stopped when told so");
  EXPECT_EQ(result.report.accepted, 10);
}

TEST_F(Batch, a_case_that_has_to_be_killed_at_its_limit_keeps_the_rows_it_had_written) {
  add("stuck");
  const CaseResult result = run(options(1, 0.5)).at(0);
  EXPECT_EQ(result.status, CaseStatus::timed_out);
  EXPECT_NE(result.cause.find("its rows to the last flush"), std::string::npos) << result.cause;
  EXPECT_EQ(io::read_history(scratch_ / "out/stuck/history.csv").header.columns.size(), 3u);
}

TEST_F(Batch, results_that_a_case_could_not_replace_are_not_told_as_its_own) {
  add("good");
  (void)run(options(1));
  std::filesystem::rename(scratch_ / "in/good.json", scratch_ / "in/fails.json");
  std::filesystem::rename(scratch_ / "out/good", scratch_ / "out/fails");
  const CaseResult result = run(options(1)).at(0);
  EXPECT_EQ(result.status, CaseStatus::failed);
  EXPECT_NE(result.cause.find("fails.failed"), std::string::npos) << result.cause;
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "out/fails.failed/summary.json"));
}

TEST_F(Batch, older_results_are_not_told_as_those_of_a_case_that_left_none) {
  add("good");
  (void)run(options(1));
  std::filesystem::rename(scratch_ / "in/good.json", scratch_ / "in/throws.json");
  std::filesystem::rename(scratch_ / "out/good", scratch_ / "out/throws");
  const CaseResult result = run(options(1)).at(0);
  EXPECT_EQ(result.status, CaseStatus::failed);
  EXPECT_EQ(result.report.accepted, 0);
  EXPECT_EQ(result.cause, "could not, so did not");
}

TEST_F(Batch, a_case_that_crashes_keeps_the_rows_it_had_written) {
  add("late crash");
  const CaseResult result = run(options(1)).at(0);
  EXPECT_EQ(result.status, CaseStatus::crashed);
  EXPECT_NE(result.cause.find("signal 9; its rows to the last flush"), std::string::npos) << result.cause;
  EXPECT_EQ(io::read_history(scratch_ / "out/late crash/history.csv").header.columns.size(), 3u);
}

TEST_F(Batch, rows_of_a_case_without_a_folder_are_kept_when_its_process_dies) {
  for (const char* name : {"a good one", "crashes", "dies before its first row", "large"}) add(name);
  std::filesystem::create_directories(scratch_ / "out");
  constexpr int many = 20'000;  // rows, of more than a megabyte
  const auto results = run_batch(
      cases(), options(1),
      [](const BatchCase& which, CaseReport&, io::SharedText& rows) {
        io::RunInMemory run("1", {}, &rows);
        if (which.name.starts_with("dies")) std::raise(SIGABRT);
        const records::Summary summary = io::sample_summary();
        run.begin(summary.header);
        for (int k = 0; k < (which.name == "large" ? many : 3); ++k)
          run.row({0.1 * k, 0.1, 2, {1.0 / 3.0, k + 0.5, 7e-9}});
        if (which.name != "a good one") std::raise(SIGABRT);
        run.end(summary);
        return 0;
      },
      [](const auto&...) {}, [] { return false; });
  ASSERT_EQ(results.size(), 4u);
  EXPECT_EQ(results[0].status, CaseStatus::ok);
  for (const std::size_t k : {1u, 3u}) {
    EXPECT_EQ(results[k].status, CaseStatus::crashed);
    EXPECT_NE(results[k].cause.find("signal 6; its rows are in "), std::string::npos) << results[k].cause;
    const auto history = io::read_history(results[k].which.directory / "history.csv");
    ASSERT_EQ(history.rows.size(), k == 1 ? 3u : static_cast<std::size_t>(many));
    EXPECT_EQ(history.rows.back().values.at(0), 1.0 / 3.0);
  }
  EXPECT_NE(results[2].cause.find("there are no rows of it"), std::string::npos) << "not those of the case before it";
  EXPECT_FALSE(std::filesystem::exists(results[2].which.directory));
}

/// Memory that all processes of a test share; it counts as resident, but not as data.
template <class T>
T* shared(std::size_t count) {
  void* memory = mmap(nullptr, count * sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory is there to share");
  return static_cast<T*>(memory);
}

TEST_F(Batch, a_case_that_holds_more_memory_than_it_may_is_killed_alone) {
  for (const char* name : {"good_1", "greedy", "good_2"}) add(name);
  std::filesystem::create_directories(scratch_ / "out");
  double pages = 0.0, resident = 0.0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  BatchOptions limited = options(1);
  limited.resident_limit = resident * static_cast<double>(sysconf(_SC_PAGESIZE)) + 100e6;
  const auto results = run_batch(
      cases(), limited,
      [](const BatchCase& which, CaseReport& report, io::SharedText& rows) {
        if (which.name != "greedy") return run_case(which, report, rows);
        std::memset(shared<char>(200'000'000), 1, 200'000'000);
        std::this_thread::sleep_for(std::chrono::seconds(60));
        return 0;
      },
      [](const auto&...) {}, [] { return false; });
  EXPECT_EQ(results.at(0).status, CaseStatus::ok);
  EXPECT_EQ(results.at(1).status, CaseStatus::ok);
  EXPECT_EQ(results.at(2).status, CaseStatus::failed);
  EXPECT_NE(results.at(2).cause.find("MB of memory"), std::string::npos) << results.at(2).cause;
}

TEST_F(Batch, cases_that_ask_for_threads_never_have_more_than_there_are) {
  const std::vector<int> wanted = {1, 2, 3, 1, 9, 2, 1, 1, 0};
  for (std::size_t k = 0; k < wanted.size(); ++k) add("case_" + std::to_string(k));
  std::vector<BatchCase> asking = list();
  for (std::size_t k = 0; k < wanted.size(); ++k) asking[k].threads = wanted[k];
  auto* counts = shared<std::atomic<int>>(2);  // threads in use, and the most of them
  const auto results = run_batch(
      CaseTable(asking), options(3),
      [counts](const BatchCase& which, CaseReport&, io::SharedText&) {
        const int own = std::clamp(which.threads, 1, 3), now = counts[0] += own;
        for (int most = counts[1]; most < now && !counts[1].compare_exchange_weak(most, now);) {
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        counts[0] -= own;
        return 0;
      },
      [](const auto&...) {}, [] { return false; });
  for (const CaseResult& r : results) EXPECT_EQ(r.status, CaseStatus::ok) << r.which.name;
  EXPECT_EQ(counts[1], 3);
}

TEST_F(Batch, its_cases_end_with_it) {
  add("hangs");
  const std::filesystem::path mark = scratch_ / "mark";
  const pid_t batch = fork();
  if (batch == 0) {
    (void)run_batch(
        cases(), options(1),
        [&](const BatchCase&, CaseReport&, io::SharedText&) {
          io::write_file(mark, std::to_string(getpid()));
          std::this_thread::sleep_for(std::chrono::seconds(60));
          return 0;
        },
        [](const auto&...) {}, [] { return false; });
    _exit(0);
  }
  while (!std::filesystem::exists(mark)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const pid_t child = std::stoi(io::text_of(mark));
  kill(batch, SIGKILL);
  waitpid(batch, nullptr, 0);
  bool is_gone = false;
  for (int k = 0; k < 15000 && !is_gone; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    is_gone =
        kill(child, 0) != 0 || io::text_of("/proc/" + std::to_string(child) + "/stat").find(") Z") != std::string::npos;
  }
  EXPECT_TRUE(is_gone);
  if (!is_gone) kill(child, SIGKILL);
}

TEST_F(Batch, names_of_dots_stay_within_the_folder) {
  for (const char* name : {"..", "...", "a"}) add(name);
  for (const BatchCase& which : list())
    EXPECT_EQ(which.directory.lexically_normal().parent_path(), scratch_ / "out") << which.name;
}

TEST_F(Batch, a_worker_serves_many_cases_and_is_replaced_where_it_dies) {
  for (const char* name : {"good_1", "good_2", "crashes", "good_3", "good_4"}) add(name);
  std::filesystem::create_directories(scratch_ / "out");
  const auto results = run_batch(
      cases(), options(1),
      [](const BatchCase& which, CaseReport& report, io::SharedText& rows) {
        const int code = run_case(which, report, rows);
        report.doubts = {std::to_string(getpid())};
        return code;
      },
      [](const auto&...) {}, [] { return false; });
  ASSERT_EQ(results.size(), 5u);  // by name: crashes, good_1 to good_4
  EXPECT_EQ(results[0].status, CaseStatus::crashed);
  for (std::size_t k = 1; k < 5; ++k) {
    EXPECT_EQ(results[k].status, CaseStatus::ok) << results[k].cause;
    EXPECT_EQ(results[k].report.doubts, results[1].report.doubts);
  }
}

TEST_F(Batch, stopping_ends_what_runs_and_starts_nothing_more) {
  for (const char* name : {"hangs_1", "hangs_2", "later"}) add(name);
  std::filesystem::create_directories(scratch_ / "out");
  int asked = 0;
  const auto results = run_batch(
      cases(), options(2), run_case, [](const auto&...) {}, [&] { return ++asked > 3; });
  EXPECT_EQ(results.at(0).status, CaseStatus::crashed) << "these children do not catch SIGTERM";
  EXPECT_EQ(results.at(2).status, CaseStatus::interrupted);
  EXPECT_EQ(results.at(2).cause, "not started");
}

TEST_F(Batch, a_folder_without_scenes_is_refused) {
  EXPECT_THROW((void)list(), std::runtime_error);
  EXPECT_THROW((void)cases_in(scratch_ / "none", scratch_ / "out"), std::runtime_error);
}

}  // namespace
}  // namespace bough::study
