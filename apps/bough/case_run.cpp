#include "case_run.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <numeric>
#include <unordered_map>

#include "arguments.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/study/estimate.hpp"
#include "bough/study/journal.hpp"
#include "bough/study/simulate.hpp"
#include "bough/version.hpp"
#include "memory_limit.hpp"
#include "pages.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// Enough to know what is meant; `bough check` tells all.
std::string first_problems(const io::SceneFile& file) {
  constexpr std::size_t shown = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(shown, file.problems.size()); ++k) text += file.problems[k].text() + "\n";
  if (file.problems.size() > shown) text += "and " + std::to_string(file.problems.size() - shown) + " more problems";
  return text;
}

/// Takes a run whose results nobody keeps.
struct NoRecorder final : results::Recorder {
  void begin(const results::HistoryHeader&) override {}
  void row(const results::HistoryRow&) override {}
  void motion(const results::MotionFrame&) override {}
  void end(const results::Summary&) override {}
};

results::Summary simulate(const scene::Scene& scene, const CaseSettings& settings,
                          std::chrono::steady_clock::time_point start, results::Recorder& recorder) {
  study::SimulateOptions options{.threads = 1};
  options.stopped_by = [&]() -> std::string {
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - start;
    const bool is_late = settings.time_limit > 0.0 && age.count() >= 0.99 * settings.time_limit;
    return is_late ? "the time limit of " + io::rounded_text(settings.time_limit, 6) + " s" : "the user";
  };
  return study::simulate(scene, options, recorder, [](const results::Progress&) { return !interrupted(); });
}

/// What was not foreseen for a case by its estimate ends as a lack of memory in this case, not as one of the machine.
void limit_memory(double bytes) {
  constexpr double program = 128e6;  // what the program itself and its reader take
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_cur, static_cast<rlim_t>(std::min(bytes + program, 1e18)));
  (void)::setrlimit(RLIMIT_DATA, &limit);
}

/// Runs in the case's own process.
int run_case_within(const study::BatchCase& which, const CaseSettings& settings, const CaseSource& source,
                    study::CaseReport& report) {
  catch_interrupts(Repeated::ignored);
  const auto start = std::chrono::steady_clock::now();
  const io::SceneFile file = source.read(which);
  if (!file.ok()) {
    report.cause = first_problems(file);
    return exit_bad_input;
  }
  report.cause = study::refusal(file.scene, settings.memory_limit);
  if (!report.cause.empty()) return exit_bad_input;
  results::Summary summary;
  if (!settings.keeps_results) {
    NoRecorder nothing;
    summary = simulate(file.scene, settings, start, nothing);
    report.take(summary);
    return summary.status == results::RunStatus::ok ? exit_done : exit_failed;
  }
  io::RunDirectory directory(which.directory, std::string(version), origin_of(which.scene, file, which.overrides));
  try {
    directory.open();
    summary = simulate(file.scene, settings, start, directory);
  } catch (const std::exception& error) {
    report.cause = cause_of(error);
    summary.scene = file.scene.name;
    directory.end_as_failed(summary, cause_of(error));
    if (directory.has_ended()) report.directory = directory.directory();
    return exit_failed;
  }
  report.take(summary);
  report.directory = directory.directory();
  return summary.status == results::RunStatus::ok ? exit_done : exit_failed;
}

/// What a case that failed changes to be tried again: half the step, or twice the load steps; `which` names what it did.
std::string smaller_steps(const study::BatchCase& which, const CaseSource& source) {
  const io::SceneFile file = source.read(which);
  if (!file.ok()) return {};
  const scene::Analysis& analysis = file.scene.analysis;
  std::string change = "/analysis/";
  if (analysis.kind == scene::AnalysisKind::statics)
    return change + "load_steps=" + std::to_string(2 * analysis.load_steps);
  change += "step_size=";
  io::append_number(change, 0.5 * analysis.step_size);
  return change;
}

int run_case(const study::BatchCase& which, const CaseSettings& settings, const CaseSource& source,
             study::CaseReport& report) {
  limit_memory(settings.memory_limit);
  try {
    int code = run_case_within(which, settings, source, report);
    study::BatchCase again = which;
    for (int k = 0; k < settings.retries && code == exit_failed && !interrupted(); ++k) {
      const std::string change = smaller_steps(again, source);
      const std::string why = report.cause;
      again.overrides.push_back(change);
      report = {};
      code = run_case_within(again, settings, source, report);
      const std::string retried = "tried again with " + change;
      report.cause = code == exit_done ? retried + ", for it had failed: " + why : retried + ": " + report.cause;
    }
    return code;
  } catch (const std::exception& error) {
    report.cause = cause_of(error);
    return exit_failed;
  }
}

/// Tells of cases as they end: each of a few; of many those that did not end well, and about once a second how far it is.
class CaseProgress {
 public:
  explicit CaseProgress(bool quiet) : quiet_(quiet) {}

  void tell(const study::CaseResult& result, std::size_t done, std::size_t all) {
    constexpr std::size_t few = 50;
    const bool good = result.status == study::CaseStatus::ok;
    failed_ += good ? 0 : 1;
    if (!good || (!quiet_ && all <= few))
      (good ? std::cout : std::cerr) << "[" << done << "/" << all << "] " << result.which.name << ": "
                                     << study::text_of(result.status) << (result.cause.empty() ? "" : ": ")
                                     << result.cause << std::endl;
    if (quiet_ || all <= few || (done < all && Clock::now() - told_at_ < std::chrono::seconds(1))) return;
    told_at_ = Clock::now();
    const double seconds = std::chrono::duration<double>(told_at_ - start_).count();
    const double rate = static_cast<double>(done) / std::max(seconds, 1e-9);
    std::cout << "[" << done << "/" << all << "] " << io::rounded_text(rate, 3) << " cases a second, " << failed_
              << " not ok, about " << io::seconds_text(static_cast<double>(all - done) / rate) << " left" << std::endl;
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  std::size_t failed_ = 0;
  Clock::time_point start_ = Clock::now(), told_at_ = start_;
};

/// The page of what has ended so far, rewritten so rarely that it takes a small part of the time.
class LivePage {
 public:
  /// results: those of all cases but `left`, which are to come.
  LivePage(const std::string& title, const io::OutputCollection& collection,
           const std::vector<study::CaseResult>& results, const std::vector<std::size_t>& left)
      : title_(title), collection_(collection) {
    for (std::size_t i = 0, next = 0; i < results.size(); ++i) {
      if (next < left.size() && left[next] == i)
        ++next;
      else
        done_.push_back(results[i]);
    }
    num_before_ = done_.size();
  }

  void take(const study::CaseResult& result, std::size_t left) {
    const std::size_t all = num_before_ + left;
    constexpr double least_seconds = 5.0, part = 0.02;
    done_.push_back(result);
    const auto start = Clock::now();
    if (seconds(start - written_at_) < std::max(least_seconds, took_ / part) || done_.size() == all) return;
    write_batch_page(collection_, done_, title_, {}, all);
    written_at_ = Clock::now();
    took_ = seconds(written_at_ - start);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }
  const std::string& title_;
  const io::OutputCollection& collection_;
  std::vector<study::CaseResult> done_;
  std::size_t num_before_ = 0;
  Clock::time_point written_at_ = Clock::now();
  double took_ = 0.0;
};

/// Large cases first, so that none is left to run alone at the end. Only a thousand are looked at: of more, the last ones
/// are a small part of the whole.
std::vector<std::size_t> order_of(const std::vector<study::BatchCase>& cases, int threads, const CaseSource& source) {
  constexpr std::size_t most = 1000;
  std::vector<std::size_t> order(cases.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (threads < 2 || cases.size() > most) return order;
  std::vector<double> seconds;
  for (const study::BatchCase& c : cases) {
    const io::SceneFile file = source.read(c);
    seconds.push_back(file.ok() ? study::estimate_run(file.scene).seconds() : 0.0);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return seconds[a] > seconds[b]; });
  return order;
}

}  // namespace

namespace {

/// Takes from the journal what is done, with its results where these are to be kept; returns which cases are left.
std::vector<std::size_t> take_over(const std::vector<study::BatchCase>& cases, const std::vector<std::string>& keys,
                                   const study::Journal& journal, bool keeps_results,
                                   std::vector<study::CaseResult>& results) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const study::CaseResult* done = journal.find(keys[i]);
    const bool has_results = !keeps_results || done == nullptr || done->report.directory.empty() ||
                             std::filesystem::exists(cases[i].directory / "summary.json");
    if (done == nullptr || !study::is_final(done->status) || !has_results) {
      left.push_back(i);
      continue;
    }
    results[i] = *done;
    results[i].which = cases[i];
  }
  return left;
}

}  // namespace

std::string policy_of(const CaseArguments& arguments) {
  return arguments.retries > 0 ? "retries " + std::to_string(arguments.retries) : std::string();
}

std::vector<study::CaseResult> run_cases(const std::vector<study::BatchCase>& cases, const CaseSettings& given,
                                         const CaseSource& source, const io::OutputCollection& collection) {
  const auto start = std::chrono::steady_clock::now();
  CaseSettings settings = given;
  if (settings.threads <= 0) settings.threads = default_threads();
  const std::size_t side_by_side = std::clamp<std::size_t>(cases.size(), 1, static_cast<std::size_t>(settings.threads));
  if (settings.memory_limit <= 0.0) settings.memory_limit = available_memory();
  settings.memory_limit /= static_cast<double>(side_by_side);
  collection.list(study::journal_file);
  study::Journal journal(settings.out / study::journal_file, settings.resume);
  if (!source.cases_table.empty())
    collection.write(study::cases_file, source.cases_table);  // the folder is this batch's now
  std::vector<std::string> keys;
  for (const study::BatchCase& c : cases) keys.push_back(study::key_of(c, source.text(c) + policy_of(settings)));
  if (settings.shard_record) {
    collection.write(study::keys_file, study::keys_csv(cases, keys));
    collection.write(study::shard_file, study::shard_text(*settings.shard_record));
  }
  std::vector<study::CaseResult> results(cases.size());
  const std::vector<std::size_t> left = take_over(cases, keys, journal, settings.keeps_results, results);
  if (settings.resume && !settings.quiet)
    std::cout << cases.size() - left.size() << " of " << cases.size() << " cases are done" << std::endl;

  std::vector<study::BatchCase> to_run;
  for (const std::size_t i : left) to_run.push_back(cases[i]);
  catch_interrupts();
  const study::BatchOptions options{settings.threads, settings.time_limit, order_of(to_run, settings.threads, source)};
  CaseProgress progress(settings.quiet);
  LivePage page(settings.title, collection, results, left);
  std::unordered_map<std::string, std::string> key_of_name;
  for (const std::size_t i : left) key_of_name[cases[i].name] = keys[i];
  std::vector<study::CaseResult> run = study::run_batch(
      to_run, options,
      [&](const study::BatchCase& which, study::CaseReport& report) {
        journal.release();
        return run_case(which, settings, source, report);
      },
      [&](const study::CaseResult& result, std::size_t done, std::size_t all) {
        if (study::is_final(result.status)) journal.add(key_of_name.at(result.which.name), result);
        progress.tell(result, done, all);
        page.take(result, all);
      },
      [&] {
        const std::chrono::duration<double> age = std::chrono::steady_clock::now() - start;
        return interrupted() || (settings.stop_after > 0.0 && age.count() >= settings.stop_after);
      });
  for (std::size_t k = 0; k < left.size(); ++k) results[left[k]] = std::move(run[k]);
  return results;
}

int finish_cases(const std::vector<study::CaseResult>& results,
                 const std::vector<study::MeasureSensitivity>& sensitivities, const CaseSettings& settings,
                 const io::OutputCollection& collection, const std::string& table) {
  collection.write("batch.csv", table.empty() ? study::batch_csv(results) : table);
  collection.write("batch.json", study::batch_json(results, settings.title, sensitivities));
  collection.write("cost.csv", study::cost_csv(results));
  write_batch_page(collection, results, settings.title, sensitivities, results.size());
  if (!sensitivities.empty()) collection.write("sensitivities.csv", study::sensitivities_csv(sensitivities));

  const auto count = [&](const auto& condition) { return std::count_if(results.begin(), results.end(), condition); };
  const auto num_failed = count([](const study::CaseResult& r) {
    return r.status != study::CaseStatus::ok && r.status != study::CaseStatus::figures_fail;
  });
  const auto num_not_as_expected = count([](const study::CaseResult& r) { return r.report.expected_fails > 0; });
  if (!settings.quiet) {
    std::cout << results.size() << " cases, " << num_failed << " not done, " << num_not_as_expected
              << " with an expected figure that fails: " << (settings.out / "batch.csv").string() << "\n";
  }
  const auto num_stopped = count([](const study::CaseResult& r) { return r.status == study::CaseStatus::interrupted; });
  if (num_stopped > 0) {
    std::cerr << (table.empty() ? "stopped: " : "not whole: ") << num_stopped
              << " cases are left; the same command with --resume goes on\n";
    return exit_stopped;
  }
  return num_failed > 0 || (settings.check_expected && num_not_as_expected > 0) ? exit_failed : exit_done;
}

}  // namespace bough::app
