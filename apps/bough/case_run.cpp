#include "case_run.hpp"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <unordered_map>

#include "arguments.hpp"
#include "bough/io/input_file.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "bough/io/read_study.hpp"
#include "bough/io/run_store.hpp"
#include "bough/run/estimate.hpp"
#include "bough/study/case_folders.hpp"
#include "bough/study/journal.hpp"
#include "case_process.hpp"
#include "memory_limit.hpp"
#include "pages.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

/// Tells of cases as they end: each of a few; of many those that did not end well, and about once a second how far it
/// is.
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
  LivePage(const std::string& title, io::OutputCollection& collection) : title_(title), collection_(collection) {}

  void take(const study::CaseTable& results, bool goes_on) {
    constexpr double least_seconds = 5.0, part = 0.02;
    const auto start = Clock::now();
    if (seconds(start - written_at_) < std::max(least_seconds, took_ / part) || !goes_on) return;
    write_batch_page(collection_, results, title_, {}, true);
    written_at_ = Clock::now();
    took_ = seconds(written_at_ - start);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }
  const std::string& title_;
  io::OutputCollection& collection_;
  Clock::time_point written_at_ = Clock::now();
  double took_ = 0.0;
};

/// Large cases first, so that none is left to run alone at the end. Only a thousand are looked at: of more, the last
/// ones are a small part of the whole.
void sort_by_size(std::vector<std::size_t>& order, const study::CaseList& cases, int threads,
                  const CaseSource& source) {
  constexpr std::size_t most = 1000;
  if (threads < 2 || order.size() > most) return;
  std::unordered_map<std::size_t, double> seconds;
  for (const std::size_t i : order) {
    const io::SceneFile file = source.read(cases.at(i));
    seconds[i] = file.ok() ? run::estimate_run(file.scene).seconds() : 0.0;
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return seconds.at(a) > seconds.at(b); });
}

}  // namespace

namespace {

/// Whether what is to be kept of a case that is done is there.
bool has_results(const study::BatchCase& which, const study::CaseResult& done, const CaseSettings& settings) {
  const Kept kept = settings.kept_as(which);
  const study::CaseReport& report = done.report;
  const bool left_none = report.directory.empty() && !report.stored;  // bad input, say
  if (kept == Kept::nothing || left_none) return true;
  if (std::filesystem::exists(which.directory / "summary.json") && study::holds_case(which.directory, which.key, done))
    return true;
  return kept == Kept::store && report.stored && io::read_stored(settings.out, *report.stored, which.key);
}

/// Takes from the journal what is done, with its results where these are to be kept; returns which cases are left.
std::vector<std::size_t> take_over(const study::Records& records, const CaseSettings& settings,
                                   study::CaseTable& results) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const study::BatchCase which = results.cases().at(i);
    std::optional<study::CaseResult> done = records.find(which.key);
    if (!done || !study::is_final(*done) || !has_results(which, *done, settings)) {
      left.push_back(i);
      continue;
    }
    if (!done->report.directory.empty()) done->report.directory = which.directory;  // its name may have changed since
    results.set(i, *done);
  }
  return left;
}

/// Brings the folders of cases to the names that the cases have now.
void settle_folders(const CaseSettings& settings, const study::CaseList& cases, const study::Records& records) {
  for (const std::filesystem::path& folder : study::settle_case_folders(settings.out, cases, records))
    std::cerr << "bough: " << folder.string()
              << " holds what bough did not write, beside results of a case that the batch no longer has there\n";
}

/// Few scenes ask for threads: only those are read here that may.
int threads_asked_for(const study::BatchCase& which, const CaseSource& source) {
  constexpr std::string_view key = "threads";
  const bool may_ask = std::any_of(which.overrides.begin(), which.overrides.end(),
                                   [&](const std::string& o) { return o.find(key) != std::string::npos; }) ||
                       source.text(which).find(key) != std::string::npos;
  if (!may_ask) return 1;
  const io::SceneFile file = source.read(which);
  return file.ok() ? file.scene.solver.threads : 1;
}

/// What each case is: its scene with all that the case changes, formulas, copies and defaults written out, and the
/// policy. Where it may name files, the hash of these and of its text, too. One with problems is the text of its file
/// and what it changes there. Of cases that are the same each has a key of its own, so that none takes the results of
/// another.
std::vector<std::string> keys_of(const study::CaseList& cases, const CaseSettings& settings, const CaseSource& source) {
  std::vector<std::string> keys;
  std::unordered_map<std::string, std::size_t> met;
  const std::string policy = policy_of(settings);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const study::BatchCase c = cases.at(i);
    const std::string text = source.text(c), scene = io::canonical_scene(text, c.overrides);
    const bool may_name_files = text.find("file") != std::string::npos || scene.find("file") != std::string::npos;
    const std::string files = may_name_files ? source.read(c).hash : std::string();
    std::string key = scene.empty() ? study::key_of(io::canonical_text(text) + files + policy, c.overrides)
                                    : study::key_of(scene + files + policy);
    if (const std::size_t before = met[key]++; before > 0) key += "." + std::to_string(before + 1);
    keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace

Kept CaseSettings::kept_as(const study::BatchCase& which) const {
  const bool is_chosen = std::find(keep_cases.begin(), keep_cases.end(), which.name) != keep_cases.end();
  return is_chosen ? Kept::folder : kept;
}

Kept kept_of(const CaseArguments& arguments, std::size_t num_cases) {
  constexpr std::size_t most_folders = 200, most_if_asked = 9000;
  if (arguments.keep == "none") return Kept::nothing;
  if (arguments.keep == "few") return num_cases <= most_folders ? Kept::folder : Kept::store;
  if (num_cases > most_if_asked)
    throw io::OutputRefused("--keep all makes a folder a case, and " + std::to_string(num_cases) +
                            " are too many for one folder: leave it out, and `bough view DIR --case NAME` takes single "
                            "ones out of the store");
  return Kept::folder;
}

std::string policy_of(const CaseArguments& arguments) {
  return arguments.retries > 0 ? "retries " + std::to_string(arguments.retries) : std::string();
}

namespace {

/// Whether a folder lists cases with their keys, as a batch does before its first case ends.
bool has_keys(const std::filesystem::path& folder) try {
  return io::read_text(folder / study::keys_file).starts_with("case,key\n");
} catch (const io::Unreadable&) {
  return false;
}

}  // namespace

io::Owner take_folder(const CaseSettings& settings, const std::string& verb, const std::filesystem::path& source) {
  io::Owner owner{.verb = verb, .source = source, .replaces = settings.replace};
  const std::filesystem::path journal = settings.out / study::journal_file;
  std::size_t num_rows = 0;
  study::for_each_record(journal, [&](const auto&, const auto&, const auto&) { ++num_rows; });
  if (settings.resume && (num_rows > 0 || has_keys(settings.out)) &&
      io::repair_manifest(settings.out, owner,
                          {study::journal_file, study::keys_file, study::cases_file, study::shard_file, io::store_names,
                           "batch.csv", "batch.json", "batch.html", "cost.csv", "sensitivities.csv"}))
    std::cerr << "bough: " << (settings.out / io::manifest_name).string()
              << " was damaged, and is made anew, since the journal beside it has " << num_rows << " whole rows\n";
  if (num_rows == 0 || settings.replace || settings.resume) return owner;
  io::require_ours(settings.out, owner);
  throw io::OutputRefused(settings.out.string() + " holds results of " + std::to_string(num_rows) +
                          (num_rows == 1 ? " case" : " cases") +
                          " of this batch: --resume takes over those of cases that have not changed, and --replace "
                          "begins anew");
}

study::CaseTable run_cases(const study::CaseList& cases, const CaseSettings& given, const CaseSource& source,
                           io::OutputCollection& collection) {
  const auto start = std::chrono::steady_clock::now();
  CaseSettings settings = given;
  if (settings.threads <= 0) settings.threads = default_threads();
  const std::size_t side_by_side = std::clamp<std::size_t>(cases.size(), 1, static_cast<std::size_t>(settings.threads));
  if (settings.memory_limit <= 0.0) settings.memory_limit = available_memory();
  settings.memory_limit /= static_cast<double>(side_by_side);
  collection.list(study::journal_file);
  study::Journal journal(settings.out / study::journal_file, settings.resume);
  if (settings.kept == Kept::store) collection.list(io::store_names);
  if (!source.cases_table.empty())
    collection.write(study::cases_file, source.cases_table);  // the folder is this batch's now
  const auto keys = std::make_shared<const std::vector<std::string>>(keys_of(cases, settings, source));
  collection.write(study::keys_file, study::keys_csv(cases, *keys));
  if (settings.shard_record) collection.write(study::shard_file, study::shard_text(*settings.shard_record));
  const auto threads = std::make_shared<std::unordered_map<std::size_t, int>>();  // of cases that ask for more than one
  study::CaseTable results(study::CaseList(cases.size(), [cases, threads, keys](std::size_t i) {
    study::BatchCase one = cases.at(i);
    one.key = (*keys)[i];
    if (const auto at = threads->find(i); at != threads->end()) one.threads = at->second;
    return one;
  }));
  study::BatchOptions options;
  settle_folders(settings, results.cases(), journal.records());
  options.order = take_over(journal.records(), settings, results);
  journal.forget_records();
  const std::size_t num_left = options.order.size();
  if (settings.resume && !settings.quiet)
    std::cout << cases.size() - num_left << " of " << cases.size() << " cases are done" << std::endl;
  for (const std::size_t i : options.order)
    if (const int asked = threads_asked_for(cases.at(i), source); asked > 1) (*threads)[i] = asked;
  catch_interrupts();
  constexpr double program_bytes = 128e6;  // what the program itself and its reader take
  options.threads = settings.threads;
  options.time_limit = settings.time_limit;
  options.resident_limit = settings.memory_limit + program_bytes;
  sort_by_size(options.order, cases, settings.threads, source);
  constexpr std::size_t most_failed_folders = 1000;
  FolderAllowance failed_folders(most_failed_folders);
  CaseProgress progress(settings.quiet);
  LivePage page(settings.title, collection);
  std::size_t done = 0;
  results = study::run_batch(
      std::move(results), options,
      [&](const study::BatchCase& which, study::CaseReport& report, io::SharedText& rows) {
        return run_case(which, settings, source, failed_folders, report, rows);
      },
      [&](const study::CaseResult& result, std::size_t which, const study::CaseTable& all) {
        if (study::is_final(result)) journal.add((*keys)[which], result);
        progress.tell(result, ++done, num_left);
        page.take(all, done < num_left);
      },
      [&] {
        const std::chrono::duration<double> age = std::chrono::steady_clock::now() - start;
        return interrupted() || (settings.stop_after > 0.0 && age.count() >= settings.stop_after);
      });
  io::sync_stores(settings.out);
  return results;
}

int finish_cases(const study::CaseTable& results, const std::vector<study::MeasureSensitivity>& sensitivities,
                 const CaseSettings& settings, io::OutputCollection& collection, const study::Collected* collected) {
  std::function<std::string(std::size_t)> machine_of;
  if (collected != nullptr && !collected->machines.empty())
    machine_of = [collected](std::size_t i) { return collected->machine_of_case(i); };
  collection.write("batch.csv", [&](const io::TextSink& sink) { study::write_batch_csv(results, sink, machine_of); });
  collection.write("batch.json", [&](const io::TextSink& sink) {
    study::write_batch_json(results, settings.title, sensitivities, sink);
  });
  collection.write("cost.csv", [&](const io::TextSink& sink) { study::write_cost_csv(results, sink); });
  write_batch_page(collection, results, settings.title, sensitivities, false);
  if (!sensitivities.empty()) collection.write("sensitivities.csv", study::sensitivities_csv(sensitivities));

  std::size_t num_failed = 0, num_not_as_expected = 0, num_stopped = 0, num_doubted = 0;
  for (const study::CaseResult& r : results) {
    const bool is_done = r.status == study::CaseStatus::ok || r.status == study::CaseStatus::figures_fail;
    num_failed += is_done ? 0 : 1;
    num_doubted += is_done && !r.report.doubts.empty() ? 1 : 0;
    num_not_as_expected += r.report.expected_fails > 0 ? 1 : 0;
    num_stopped += r.status == study::CaseStatus::interrupted ? 1 : 0;
  }
  const std::optional<std::filesystem::path> former = collection.publish(num_stopped > 0  ? io::FolderState::unfinished
                                                                         : num_failed > 0 ? io::FolderState::failed
                                                                                          : io::FolderState::good);
  if (former)
    std::cerr << "bough: the former results are kept in " << former->string() << ", since not all cases are done\n";
  if (!settings.quiet) {
    std::cout << results.size() << " cases, " << num_failed << " not done, " << num_doubted
              << " not to be trusted without a closer look, " << num_not_as_expected
              << " with an expected figure that fails: " << (settings.out / "batch.csv").string() << "\n";
  }
  if (settings.quiet && num_failed > num_stopped)  // those that were taken over were told when they ended
    std::cerr << "bough: " << num_failed - num_stopped << " of " << results.size()
              << " cases are not done: column cause of " << (settings.out / "batch.csv").string() << "\n";
  if (settings.quiet && num_doubted > 0)
    std::cerr << "bough: " << num_doubted << " of " << results.size()
              << " cases are not to be trusted without a closer look: column doubts of "
              << (settings.out / "batch.csv").string() << "\n";
  if (num_stopped > 0) {
    std::cerr << (collected == nullptr ? "stopped: " : "not whole: ") << num_stopped
              << " cases are left; the same command with --resume goes on\n";
    return exit_stopped;
  }
  if (settings.strict && num_doubted > 0) return exit_failed;
  return num_failed > 0 || (settings.check_expected && num_not_as_expected > 0) ? exit_failed : exit_done;
}

}  // namespace bough::app
