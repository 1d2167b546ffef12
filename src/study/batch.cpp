#include "bough/study/batch.hpp"

#include <poll.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "bough/io/read_scene.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/study/collect.hpp"
#include "cases/case_report.hpp"
#include "cases/worker.hpp"

namespace bough::study {
namespace {

namespace fs = std::filesystem;

constexpr int poll_milliseconds = 20;
constexpr double least_grace = 2.0, part_of_limit = 0.1;  // wall time that a case gets to end by itself after its time
                                                          // limit [s], [-]

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "; ");
  return text;
}

CaseStatus status_of(int code) {
  return code == 0 ? CaseStatus::ok : code == 2 ? CaseStatus::bad_input : CaseStatus::failed;
}

/// Describes the results that remain of a case that was killed. rows: of its history, if it has no folder.
std::string kept_rows(const BatchCase& which, std::string_view rows) {
  try {
    if (const std::optional<fs::path> kept = io::RunDirectory::keep_rows_of_killed(which.directory, which.owner()))
      return "its rows to the last flush are in " + kept->string();
    if (rows.empty()) return "there are no rows of it";
    return "its rows are in " + io::RunDirectory::keep_rows(which.directory, which.owner(), rows).string();
  } catch (const std::exception& error) {
    return std::string("its rows are lost: ") + error.what();
  }
}

/// Result of a case that its worker has reported.
CaseResult result_of(const BatchCase& which, const WorkerAnswer& answer, double seconds, bool is_late) {
  CaseResult result;
  result.which = which;
  result.status = is_late ? CaseStatus::timed_out : status_of(answer.code);
  result.cost = {seconds, answer.cpu_seconds, answer.peak_bytes};
  if (!report_of(answer.report, result.report)) {
    result.status = CaseStatus::failed;
    result.report.cause = "what it told of its end did not arrive whole";
  }
  const CaseReport& report = result.report;
  result.cause = one_line(report.cause);
  if (result.status == CaseStatus::ok && report.expected_fails > 0) {
    result.status = CaseStatus::figures_fail;
    result.cause = report.failing;
  }
  if (report.was_interrupted && result.status == CaseStatus::failed) result.status = CaseStatus::interrupted;
  if (!report.directory.empty() && report.directory != which.directory)
    result.cause += " (the former results were good and are kept; see " + report.directory.string() + ")";
  return result;
}

/// Result of a case whose worker has ended without a report. resident: memory for which it was killed; 0: it was not.
CaseResult result_of_ended(const BatchCase& which, int wait_status, double seconds, bool is_late, double resident,
                           std::string_view rows) {
  CaseResult result;
  result.which = which;
  result.status = resident > 0.0 ? CaseStatus::failed : is_late ? CaseStatus::timed_out : CaseStatus::crashed;
  result.cost.wall_seconds = seconds;
  result.cost.peak_bytes = resident;
  if (resident > 0.0) {
    result.cause = "killed, since it held " + std::to_string(std::lround(1e-6 * resident)) +
                   " MB of memory, which is more than it may; " + kept_rows(which, rows);
    return result;
  }
  result.report.is_unwritten = !WIFSIGNALED(wait_status) && !is_late;  // it could not report its end
  const std::string how = WIFSIGNALED(wait_status) ? "signal " + std::to_string(WTERMSIG(wait_status))
                                                   : "status " + std::to_string(WEXITSTATUS(wait_status));
  result.cause = (is_late ? "killed at the time limit, since it did not stop by itself; " : "ended by " + how + "; ") +
                 kept_rows(which, rows);
  return result;
}

}  // namespace

std::vector<BatchCase> cases_in(const fs::path& folder, const fs::path& out) {
  std::error_code error;
  std::vector<BatchCase> cases;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code unknown;  // of a link that leads nowhere, say: its case fails
    if (it->path().extension() != ".json" || it->is_directory(unknown)) continue;
    const std::string name = io::name_of_file(it->path());
    cases.push_back({name, it->path(), out / name});
  }
  if (error) throw std::runtime_error("cannot read the folder " + folder.string() + ": " + error.message());
  if (cases.empty()) throw std::runtime_error("no scene (*.json) in " + folder.string());
  std::sort(cases.begin(), cases.end(), [](const BatchCase& a, const BatchCase& b) { return a.name < b.name; });
  return cases;
}

bool is_name_of_batch(std::string_view name) {
  constexpr std::array tables = {"batch.csv", "batch.json", "batch.html", "cost.csv", "sensitivities.csv"};
  constexpr std::array records = {cases_file, keys_file, journal_file, shard_file, io::manifest_name};
  constexpr std::array endings = {".partial", ".failed", ".former", ".bough-new"};  // of what lies beside a case
  const auto is_name = [&](const char* text) { return name == text; };
  return std::any_of(tables.begin(), tables.end(), is_name) || std::any_of(records.begin(), records.end(), is_name) ||
         std::any_of(endings.begin(), endings.end(), [&](const char* text) { return name.ends_with(text); }) ||
         (name.starts_with("store_") && name.ends_with(".pack")) ||
         (name.starts_with("shard_") && name.find("_of_") != std::string_view::npos);
}

namespace {

CaseResult not_started(const BatchCase& which, const std::string& why) {
  CaseResult result;
  result.which = which;
  result.cause = "no process could be started for it: " + why;
  return result;
}

/// A batch in progress.
class Batch {
 public:
  Batch(CaseTable table, const BatchOptions& options, const RunCase& run_case, const CaseDone& done)
      : options_(options), run_case_(run_case), done_(done), table_(std::move(table)) {
    const std::size_t count = options.order.empty() ? table_.size() : options.order.size();
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t which = options.order.empty() ? k : options.order[k];
      if (!table_.has(which)) order_.push_back(which);
    }
  }

  CaseTable run(const std::function<bool()>& stop) {
    while (next_ < order_.size() || !busy_.empty()) {
      if (!stopping_ && stop()) {
        stopping_ = true;
        for (Worker& w : workers_)
          if (w.is_busy()) w.ask_to_stop();
      }
      if (stopping_ && busy_.empty()) break;
      while (!stopping_ && next_ < order_.size() && hand_out()) {
      }
      if (!collect()) wait();
    }
    return std::move(table_);
  }

 private:
  /// Number of threads of a case: as many as it asks for, but never more than there are.
  int threads_of(const BatchCase& which) const { return std::clamp(which.threads, 1, options_.threads); }

  /// Gives the next case to a worker. False if all threads are busy, or if fewer are free than the case asks for. Later
  /// cases do not overtake it, since it might then wait forever.
  bool hand_out() {
    if (num_busy_threads_ >= options_.threads) return false;
    const std::size_t which = order_[next_];
    if (!head_) head_ = table_.cases().at(which);
    if (num_busy_threads_ + threads_of(*head_) > options_.threads) return false;
    auto idle = std::find_if(workers_.begin(), workers_.end(), [](const Worker& w) { return !w.is_busy(); });
    if (idle == workers_.end()) {
      if (workers_.size() >= static_cast<std::size_t>(options_.threads)) return false;
      try {
        workers_.emplace_back(table_.cases(), run_case_, workers_);
      } catch (const std::system_error& error) {
        if (!workers_.empty()) return false;  // the batch continues with fewer workers
        finish(which, not_started(take_head(), error.code().message()));
        return true;
      }
      idle = workers_.end() - 1;
    }
    if (!idle->give(which)) {
      workers_.erase(idle);
      return true;  // the case goes to another worker
    }
    num_busy_threads_ += threads_of(*head_);
    busy_.emplace(which, take_head());
    return true;
  }

  BatchCase take_head() {
    ++next_;
    return *std::exchange(head_, std::nullopt);
  }

  /// The rows that the present case of a worker has written, for a folder of its own. Only the first 1000 cases that
  /// die get one: they suffice to find the cause, and the output folder stays small.
  std::string_view rows_to_keep(const Worker& w) {
    constexpr std::size_t most = 1000;
    return w.rows().empty() || num_kept_++ >= most ? std::string_view() : w.rows();
  }

  void finish(std::size_t which, const CaseResult& result) {
    table_.set(which, result);
    done_(result, which, table_);
  }

  /// True if a case has ended.
  bool collect() {
    bool any_ended = false;
    for (std::size_t k = 0; k < workers_.size();) {
      Worker& w = workers_[k];
      const bool is_busy = w.is_busy();
      const std::size_t which = is_busy ? w.which() : 0;
      const double seconds = is_busy ? w.seconds() : 0.0;
      const bool is_late = w.was_asked_to_stop() && !stopping_;
      const std::optional<WorkerAnswer> answer = w.answer();
      const bool has_ended = w.has_ended();
      if (answer || (is_busy && has_ended)) {
        const BatchCase one = std::move(busy_.extract(which).mapped());
        num_busy_threads_ -= threads_of(one);
        any_ended = true;
        finish(which, answer
                          ? result_of(one, *answer, seconds, is_late)
                          : result_of_ended(one, w.reap(), seconds, is_late, w.killed_for_memory(), rows_to_keep(w)));
      }
      // A worker that was told to stop would stop its next case as well.
      if (has_ended || (w.was_asked_to_stop() && !w.is_busy())) {
        workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(k));
        continue;
      }
      keep_to_limits(w);
      ++k;
    }
    return any_ended;
  }

  /// Asks a case beyond its time limit to stop, and kills its worker if it does not end in time.
  void keep_to_limits(Worker& w) const {
    const double limit = options_.time_limit;
    if (w.is_busy() && options_.resident_limit > 0.0) w.kill_above(options_.resident_limit);
    if (!w.is_busy() || limit <= 0.0 || w.seconds() <= limit) return;
    if (!w.was_asked_to_stop()) w.ask_to_stop();
    if (!w.was_killed() && w.seconds() > limit + std::max(least_grace, part_of_limit * limit)) w.kill();
  }

  /// Waits until a worker reports, at most until limits are checked again.
  void wait() const {
    std::vector<pollfd> pipes;
    for (const Worker& w : workers_) pipes.push_back({w.pipe(), POLLIN, 0});
    (void)::poll(pipes.data(), pipes.size(), poll_milliseconds);
  }

  const BatchOptions& options_;
  const RunCase& run_case_;
  const CaseDone& done_;
  CaseTable table_;
  std::vector<std::size_t> order_;
  std::vector<Worker> workers_;
  std::optional<BatchCase> head_;          ///< the next case, order_[next_], once it was made
  std::map<std::size_t, BatchCase> busy_;  ///< those that workers run
  std::size_t next_ = 0, num_kept_ = 0;
  int num_busy_threads_ = 0;
  bool stopping_ = false;
};

}  // namespace

CaseTable run_batch(CaseTable table, const BatchOptions& options, const RunCase& run_case, const CaseDone& done,
                    const std::function<bool()>& stop) {
  return Batch(std::move(table), options, run_case, done).run(stop);
}

}  // namespace bough::study
