#include "bough/study/batch.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "bough/io/history.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/io/summary.hpp"

namespace bough::study {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t max_cause = 4000;  // [bytes], less than a pipe holds, so that a child never waits for its reader
constexpr std::chrono::milliseconds poll_interval{20};
constexpr double least_grace = 2.0, part_of_limit = 0.1;  // wall time to end by itself past the time limit [s], [-]

struct Child {
  std::size_t index = 0;
  pid_t process = -1;
  int pipe = -1;
  Clock::time_point started;
  bool timed_out = false, killed = false;
};

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "; ");
  return text;
}

/// The child must not outlive its parent, which may have ended before this was asked for.
void end_with_parent(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
}

/// The pipe carries the directory of the results, a zero byte, and the cause.
[[noreturn]] void run_in_child(const BatchCase& which, const RunCase& run_case, int pipe) {
  CaseReport report;
  int code = 1;
  try {
    code = run_case(which, report);
  } catch (const std::exception& error) {
    report.cause = error.what();
  } catch (...) {
    report.cause = "unknown failure";
  }
  std::string text = report.directory.string() + '\0' + report.cause;
  if (text.size() > max_cause) text.resize(max_cause);
  [[maybe_unused]] const ssize_t written = ::write(pipe, text.data(), text.size());
  ::_exit(code);  // nothing of the parent's is flushed or destroyed twice
}

/// Nothing where no process can be started; errno says why.
std::optional<Child> start(const BatchCase& which, std::size_t index, const RunCase& run_case) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
  const pid_t parent = ::getpid(), process = ::fork();
  if (process < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    errno = error;
    return std::nullopt;
  }
  if (process == 0) {
    end_with_parent(parent);
    ::close(ends[0]);
    run_in_child(which, run_case, ends[1]);
  }
  ::close(ends[1]);
  return Child{index, process, ends[0], Clock::now()};
}

std::string read_all(int pipe) {
  std::string text;
  char buffer[4096];
  while (true) {
    const ssize_t count = ::read(pipe, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(count));
  }
}

CaseStatus status_of(const Child& child, int wait_status) {
  if (child.timed_out) return CaseStatus::timed_out;
  if (WIFSIGNALED(wait_status)) return CaseStatus::crashed;
  switch (WEXITSTATUS(wait_status)) {
    case 0:
      return CaseStatus::ok;
    case 2:
      return CaseStatus::bad_input;
    default:
      return CaseStatus::failed;
  }
}

/// The first expected figures that do not hold.
std::string failing_figures(const io::SummaryFile& summary) {
  constexpr int shown = 3;
  std::string text;
  int count = 0;
  for (const results::ExpectedResult& figure : summary.expected) {
    if (!figure.reached || figure.holds || ++count > shown) continue;
    const std::string value = figure.has_value ? io::rounded_text(figure.value, 6) : "not there";
    text += (text.empty() ? "" : ", ") + figure.name + " is " + value + " instead of " +
            io::rounded_text(figure.reference, 6) + " +- " + io::rounded_text(figure.tolerance, 3);
  }
  if (count > shown) text += " and " + std::to_string(count - shown) + " more";
  return text;
}

void read_summary_into(CaseResult& result, const fs::path& directory) {
  const fs::path path = directory / "summary.json";
  if (!fs::exists(path)) return;
  const io::SummaryFile summary = io::read_summary(path);
  result.accepted = summary.accepted;
  result.rejected = summary.rejected;
  result.newton_iterations = summary.newton_iterations;
  for (const results::ExpectedResult& figure : summary.expected)
    if (figure.reached) ++(figure.holds ? result.expected_holds : result.expected_fails);
  if (result.status == CaseStatus::ok && result.expected_fails > 0) {
    result.status = CaseStatus::figures_fail;
    result.cause = failing_figures(summary);
  }
  if (summary.status == "interrupted" && result.status == CaseStatus::failed) result.status = CaseStatus::interrupted;
  if (result.cause.empty()) result.cause = one_line(summary.cause);
}

/// What is kept of a case that was killed, in words.
std::string kept_rows(const BatchCase& which) {
  try {
    const std::optional<fs::path> kept = io::RunDirectory::keep_rows_of_killed(which.directory);
    return kept ? "its rows to the last flush are in " + kept->string() : "there are no rows of it";
  } catch (const std::exception& error) {
    return std::string("its rows are lost: ") + error.what();
  }
}

CaseResult result_of(const Child& child, const BatchCase& which, int wait_status) {
  CaseResult result;
  result.which = which;
  result.status = status_of(child, wait_status);
  const std::string told = read_all(child.pipe);
  ::close(child.pipe);
  const std::size_t zero = std::min(told.find('\0'), told.size());
  const fs::path directory = told.substr(0, zero);  // empty: it left no results, and what stands there is older
  result.cause = one_line(told.substr(std::min(zero + 1, told.size())));
  if (result.status == CaseStatus::timed_out && (child.killed || WIFSIGNALED(wait_status)))
    result.cause = "killed at the time limit, since it did not stop by itself; " + kept_rows(which);
  if (result.status == CaseStatus::crashed)
    result.cause = "ended by signal " + std::to_string(WTERMSIG(wait_status)) + "; " + kept_rows(which);
  try {
    if (!directory.empty()) read_summary_into(result, directory);
  } catch (const std::exception& error) {
    result.status = CaseStatus::failed;
    result.cause = error.what();
  }
  if (!directory.empty() && directory != which.directory)
    result.cause += " (the former results were good and are kept; see " + directory.string() + ")";
  return result;
}

}  // namespace

std::string_view text_of(CaseStatus status) {
  switch (status) {
    case CaseStatus::ok:
      return "ok";
    case CaseStatus::figures_fail:
      return "figures_fail";
    case CaseStatus::failed:
      return "failed";
    case CaseStatus::interrupted:
      return "interrupted";
    case CaseStatus::bad_input:
      return "bad_input";
    case CaseStatus::crashed:
      return "crashed";
    case CaseStatus::timed_out:
      return "timed_out";
  }
  return "failed";
}

std::vector<BatchCase> cases_in(const BatchOptions& options) {
  std::error_code error;
  std::vector<BatchCase> cases;
  for (fs::directory_iterator it(options.folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() != ".json" || it->is_directory()) continue;
    const std::string name = io::name_of_file(it->path());
    cases.push_back({name, it->path(), options.out / name});
  }
  if (error) throw std::runtime_error("cannot read the folder " + options.folder.string() + ": " + error.message());
  if (cases.empty()) throw std::runtime_error("no scene (*.json) in " + options.folder.string());
  std::sort(cases.begin(), cases.end(), [](const BatchCase& a, const BatchCase& b) { return a.name < b.name; });
  return cases;
}

namespace {

/// A case past its limit is asked to stop, and killed when it has had time to.
void keep_to_limit(Child& child, double limit) {
  const std::chrono::duration<double> age = Clock::now() - child.started;
  if (limit <= 0.0 || age.count() <= limit) return;
  if (!child.timed_out) ::kill(child.process, SIGTERM);
  child.timed_out = true;
  if (child.killed || age.count() <= limit + std::max(least_grace, part_of_limit * limit)) return;
  child.killed = true;
  ::kill(child.process, SIGKILL);
}

CaseResult not_started(const BatchCase& which, int error) {
  CaseResult result;
  result.which = which;
  result.cause = "no process could be started for it: " + std::generic_category().message(error);
  return result;
}

}  // namespace

std::vector<CaseResult> run_batch(const BatchOptions& options, const RunCase& run_case, const CaseDone& done,
                                  const std::function<bool()>& stop) {
  const std::vector<BatchCase> cases = cases_in(options);
  std::vector<CaseResult> results(cases.size());
  std::vector<Child> running;
  std::size_t next = 0, num_done = 0;
  bool stopping = false;
  while (next < cases.size() || !running.empty()) {
    if (!stopping && stop()) {
      stopping = true;
      for (const Child& child : running) ::kill(child.process, SIGTERM);
    }
    while (!stopping && next < cases.size() && running.size() < static_cast<std::size_t>(options.threads)) {
      if (const std::optional<Child> child = start(cases[next], next, run_case)) {
        running.push_back(*child);
      } else {
        results[next] = not_started(cases[next], errno);
        done(results[next], ++num_done, cases.size());
      }
      ++next;
    }
    bool any_ended = false;
    for (std::size_t k = 0; k < running.size();) {
      Child& child = running[k];
      int wait_status = 0;
      if (::waitpid(child.process, &wait_status, WNOHANG) == child.process) {
        results[child.index] = result_of(child, cases[child.index], wait_status);
        done(results[child.index], ++num_done, cases.size());
        running.erase(running.begin() + static_cast<std::ptrdiff_t>(k));
        any_ended = true;
        continue;
      }
      keep_to_limit(child, options.time_limit);
      ++k;
    }
    if (stopping && running.empty()) break;
    if (!any_ended) std::this_thread::sleep_for(poll_interval);
  }
  for (; next < cases.size(); ++next) {
    results[next].which = cases[next];
    results[next].status = CaseStatus::interrupted;
    results[next].cause = "not started";
  }
  return results;
}

std::string batch_csv(const std::vector<CaseResult>& results) {
  std::string text =
      "case,status,cause,steps_accepted,steps_rejected,newton_iterations,expected_holds,expected_fails\n";
  for (const CaseResult& result : results) {
    text += io::csv_field(result.which.name) + ',' + std::string(text_of(result.status)) + ',' +
            io::csv_field(result.cause) + ',' + std::to_string(result.accepted) + ',' +
            std::to_string(result.rejected) + ',' + std::to_string(result.newton_iterations) + ',' +
            std::to_string(result.expected_holds) + ',' + std::to_string(result.expected_fails) + '\n';
  }
  return text;
}

}  // namespace bough::study
