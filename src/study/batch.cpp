#include "bough/study/batch.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "bough/io/history.hpp"
#include "bough/io/summary.hpp"

namespace bough::study {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t max_cause = 4000;  // [bytes], less than a pipe holds, so that a child never waits for its reader
constexpr std::chrono::milliseconds poll_interval{20};

struct Child {
  std::size_t index = 0;
  pid_t process = -1;
  int pipe = -1;
  Clock::time_point started;
  bool timed_out = false;
};

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "; ");
  return text;
}

[[noreturn]] void run_in_child(const BatchCase& which, const RunCase& run_case, int pipe) {
  std::string cause;
  int code = 1;
  try {
    code = run_case(which, cause);
  } catch (const std::exception& error) {
    cause = error.what();
  } catch (...) {
    cause = "unknown failure";
  }
  if (cause.size() > max_cause) cause.resize(max_cause);
  [[maybe_unused]] const ssize_t written = ::write(pipe, cause.data(), cause.size());
  ::_exit(code);  // nothing of the parent's is flushed or destroyed twice
}

Child start(const BatchCase& which, std::size_t index, const RunCase& run_case) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("cannot start a case: " + std::system_category().message(errno));
  const pid_t process = ::fork();
  if (process < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    throw std::runtime_error("cannot start a case: " + std::system_category().message(error));
  }
  if (process == 0) {
    ::close(ends[0]);
    run_in_child(which, run_case, ends[1]);
  }
  ::close(ends[1]);
  return {index, process, ends[0], Clock::now()};
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

void read_summary_into(CaseResult& result) {
  const fs::path path = result.which.directory / "summary.json";
  if (!fs::exists(path)) return;
  const io::SummaryFile summary = io::read_summary(path);
  result.accepted = summary.accepted;
  result.rejected = summary.rejected;
  result.newton_iterations = summary.newton_iterations;
  for (const results::ExpectedResult& figure : summary.expected)
    if (figure.reached) ++(figure.holds ? result.expected_holds : result.expected_fails);
  if (summary.status == "interrupted") result.status = CaseStatus::interrupted;
  if (result.cause.empty()) result.cause = one_line(summary.cause);
}

CaseResult result_of(const Child& child, const BatchCase& which, int wait_status) {
  CaseResult result;
  result.which = which;
  result.status = status_of(child, wait_status);
  result.cause = one_line(read_all(child.pipe));
  ::close(child.pipe);
  if (result.status == CaseStatus::timed_out) result.cause = "stopped at the time limit";
  if (result.status == CaseStatus::crashed) result.cause = "ended by signal " + std::to_string(WTERMSIG(wait_status));
  const bool wrote_results = result.status == CaseStatus::ok || result.status == CaseStatus::failed;
  try {
    if (wrote_results) read_summary_into(result);
  } catch (const std::exception& error) {
    result.status = CaseStatus::failed;
    result.cause = error.what();
  }
  return result;
}

}  // namespace

std::string_view text_of(CaseStatus status) {
  switch (status) {
    case CaseStatus::ok:
      return "ok";
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
    const std::string name = it->path().stem().string();
    cases.push_back({name, it->path(), options.out / name});
  }
  if (error) throw std::runtime_error("cannot read the folder " + options.folder.string() + ": " + error.message());
  if (cases.empty()) throw std::runtime_error("no scene (*.json) in " + options.folder.string());
  std::sort(cases.begin(), cases.end(), [](const BatchCase& a, const BatchCase& b) { return a.name < b.name; });
  return cases;
}

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
      for (const Child& child : running) ::kill(child.process, SIGINT);
    }
    while (!stopping && next < cases.size() && running.size() < static_cast<std::size_t>(options.threads)) {
      running.push_back(start(cases[next], next, run_case));
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
      const std::chrono::duration<double> age = Clock::now() - child.started;
      if (options.time_limit > 0.0 && age.count() > options.time_limit && !child.timed_out) {
        child.timed_out = true;
        ::kill(child.process, SIGKILL);
      }
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
